//! The dashboard's state and its two functions.

use std::time::Duration;

use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::desk::{Chosen, Desk};
use super::export;
use super::header;
use super::hints::useful;
use super::input::{Effect, Input};
use super::keys::{Action, Key, Scope};
use super::look::Paint;
use super::overlay::{self, Overlay};
use super::panel::{SMALLEST, body, panel, too_small};
use super::steering::{Steered, steer};
use super::view_id::ViewId;
use super::views::{self, View, panels};
use crate::lab::Event;
use crate::lab::specimen::Start;

/// The dashboard.
pub struct App {
    pub(super) desk: Desk,
    pub(super) views: Vec<(ViewId, Box<dyn View>)>,
    pub(super) view: ViewId,
    pub(super) overlay: Option<Overlay>,
    dirty: bool,
}

impl App {
    /// A dashboard over what lies on a desk.
    #[must_use]
    pub fn new(desk: Desk) -> Self {
        Self {
            desk,
            views: views::all(),
            view: ViewId::Overview,
            overlay: None,
            dirty: true,
        }
    }

    /// What the person has chosen to look at.
    #[must_use]
    pub fn desk(&self) -> &Desk {
        &self.desk
    }

    /// The view on the screen.
    #[must_use]
    pub fn view(&self) -> ViewId {
        self.view
    }

    /// Opens a view.
    pub fn open(&mut self, view: ViewId) -> Vec<Effect> {
        self.view = view;
        self.dirty = true;
        self.prepare()
    }

    /// The same dashboard, opened from somewhere that going back leads to.
    #[must_use]
    pub fn within(mut self, within: bool) -> Self {
        self.desk.within = within;
        self
    }

    /// Lets the trials that are watched begin there.
    #[must_use]
    pub fn beginning_at(mut self, start: Option<Start>) -> Self {
        if let Some(start) = start {
            self.desk.stage.begin_at(start);
        }
        self
    }

    /// Travels to the generation with this number, or the nearest that there is.
    pub fn travel_to(&mut self, generation: u64) -> Vec<Effect> {
        self.desk.travel_to(generation);
        self.dirty = true;
        self.prepare()
    }

    /// Whether the frame drawn last is not what there is to see now. Asking takes the
    /// answer: who is told to draw must do it.
    pub fn take_dirty(&mut self) -> bool {
        std::mem::take(&mut self.dirty)
    }

    /// Takes in what happened; returns what is to be done about it.
    pub fn update(&mut self, input: Input) -> Vec<Effect> {
        let mut effects = Vec::new();
        match input {
            Input::Key(key) => {
                self.dirty = true;
                effects = self.key(key);
            }
            Input::Mouse(mouse) => {
                self.dirty = true;
                effects = self.mouse(mouse);
            }
            Input::Resize(columns, rows) => {
                self.dirty = true;
                self.desk.size = (columns, rows);
            }
            // Events may come in hundreds at once; what follows from them waits for the tick.
            Input::Event(event) => {
                self.event(*event);
                return effects;
            }
            Input::Closed => {
                self.dirty = true;
                self.desk.closed = true;
            }
            Input::Tick(elapsed) => self.tick(elapsed),
            Input::Population { generation, state } => {
                self.dirty = true;
                self.desk.stage.receive(generation, state);
            }
            Input::Message(text) => {
                self.dirty = true;
                self.desk.say(text);
            }
        }
        effects.extend(self.prepare());
        effects
    }

    fn event(&mut self, event: Event) {
        let desk = &mut self.desk;
        match &event {
            Event::Progress { control_steps, .. } => {
                // A run that is watched may be resumed by somebody.
                desk.closed = false;
                desk.pace.steps(*control_steps);
            }
            Event::Generation(record) => desk.pace.generation(record.generation),
            Event::Paused => desk.stepping = false,
            _ => {}
        }
        desk.live_mut().fold(event);
        self.dirty = true;
    }

    fn tick(&mut self, elapsed: Duration) {
        let said = self.desk.message().is_some();
        self.dirty |= self.desk.tick(elapsed);
        if self.on_screen().iter().any(|view| view.needs_stage()) {
            self.dirty |= self.desk.stage.tick(elapsed);
        }
        self.dirty |= said != self.desk.message().is_some();
    }

    /// Puts on the stage what is looked at, and lets the views on the screen compute what
    /// they draw.
    fn prepare(&mut self) -> Vec<Effect> {
        let on_screen = self.on_screen();
        let mut effects = Vec::new();
        if on_screen.iter().any(|view| view.needs_stage()) {
            let (wanted, by_choice) = (self.desk.wanted(), !self.desk.follows());
            let load = self.desk.stage.want(wanted, by_choice);
            effects.extend(load.map(|generation| Effect::Load { generation }));
        }
        for (id, view) in &mut self.views {
            if on_screen.contains(id) {
                view.prepare(&self.desk);
            }
        }
        effects
    }

    fn on_screen(&self) -> Vec<ViewId> {
        match self.view {
            ViewId::Overview => {
                let placed = panels(self.body(), &self.desk);
                placed.into_iter().map(|(id, _)| id).collect()
            }
            view => vec![view],
        }
    }

    /// Between header and hint bar.
    fn body(&self) -> Rect {
        let (width, height) = self.desk.size;
        body(Rect::new(0, 0, width, height))
    }

    /// The view that keys act on: the one on the screen, in the overview the panel that
    /// has the focus.
    fn active(&self) -> ViewId {
        match self.view {
            ViewId::Overview => self.desk.focus,
            view => view,
        }
    }

    fn key(&mut self, key: Key) -> Vec<Effect> {
        if let Some(open) = self.overlay.take() {
            return self.key_in_overlay(open, key);
        }
        let keys = &self.desk.keys;
        let in_view = keys.in_view(key, self.active());
        let Some(action) = in_view.or_else(|| keys.in_view(key, self.view)) else {
            return Vec::new();
        };
        self.perform(action)
    }

    /// Does what is asked for: the view that keys act on first, then the dashboard.
    pub(super) fn perform(&mut self, action: Action) -> Vec<Effect> {
        let active = self.active();
        for id in [active, self.view] {
            let Some((_, view)) = self.views.iter_mut().find(|(known, _)| *known == id) else {
                continue;
            };
            if let Some(effects) = view.act(&mut self.desk, action) {
                return effects;
            }
        }
        self.act(action)
    }

    fn key_in_overlay(&mut self, open: Overlay, key: Key) -> Vec<Effect> {
        let keys = &self.desk.keys;
        match open {
            Overlay::Help { scroll } => {
                let action = keys.in_view(key, self.view);
                self.scroll_help(scroll, action);
                Vec::new()
            }
            Overlay::Export => match keys.in_scope(key, Scope::ExportMenu) {
                Some(action) => self.export(action),
                None => Vec::new(),
            },
            Overlay::Question(question) => match keys.in_scope(key, Scope::Question) {
                Some(Action::Yes) => question.yes(&mut self.desk),
                Some(Action::Detach) if question == overlay::Question::Quit => vec![Effect::Detach],
                _ => Vec::new(),
            },
        }
    }

    /// Scrolls help; what does not scroll closes it.
    pub(super) fn scroll_help(&mut self, scroll: u16, action: Option<Action>) {
        let most = overlay::help_lines(&self.desk, self.view, &self.lessons()).len();
        let scroll = overlay::scrolled(scroll, action, self.desk.size.1, most);
        self.overlay = scroll.map(|scroll| Overlay::Help { scroll });
    }

    /// What no view does itself.
    fn act(&mut self, action: Action) -> Vec<Effect> {
        if let Some(view) = action.view() {
            self.view = view;
            return Vec::new();
        }
        match steer(&mut self.desk, action) {
            Steered::Nothing => {}
            Steered::Ask(question) => {
                self.overlay = Some(Overlay::Question(question));
                return Vec::new();
            }
            Steered::Done(effect) => return effect.into_iter().collect(),
        }
        let desk = &mut self.desk;
        match action {
            Action::Help => self.overlay = Some(Overlay::Help { scroll: 0 }),
            Action::Export => self.overlay = Some(Overlay::Export),
            Action::Suspend => return vec![Effect::Suspend],
            Action::Redraw => return vec![Effect::Redraw],
            Action::Back if self.view == ViewId::Overview => return vec![Effect::Back],
            Action::Back => self.view = ViewId::Overview,
            Action::Open if self.view == ViewId::Overview => self.view = desk.focus,
            Action::Open => self.view = self.view.opens().unwrap_or(self.view),
            Action::NextPanel => self.desk.focus = self.neighbour(1),
            Action::PreviousPanel => self.desk.focus = self.neighbour(-1),
            Action::Freeze => desk.toggle_freeze(),
            Action::Best => desk.chosen = Chosen::Best,
            Action::Earlier => desk.travel_by(-1),
            Action::Later => desk.travel_by(1),
            Action::MuchEarlier => desk.travel_by(-10),
            Action::MuchLater => desk.travel_by(10),
            Action::First => desk.travel_to(0),
            Action::Follow => desk.travel_to(u64::MAX),
            Action::Play => desk.toggle_play(),
            Action::Halt => desk.stage.toggle_halt(),
            Action::StepRollout => desk.stage.step(),
            Action::Faster => desk.stage.change_speed(true),
            Action::Slower => desk.stage.change_speed(false),
            Action::Restart => desk.stage.restart(),
            Action::NextTrial => {
                desk.stage.next_trial();
                if let Some(rollout) = desk.stage.rollout() {
                    let text =
                        format!("trial {} begins with the next step", rollout.status().trial);
                    desk.say(text);
                }
            }
            Action::Mark => desk.mark(),
            Action::Theme => {
                desk.look.next_theme();
                let theme = desk.look.theme().to_owned();
                desk.say(format!("theme: {theme}"));
            }
            _ => {}
        }
        Vec::new()
    }

    /// The panel after, or before, the one that has the focus.
    fn neighbour(&self, by: isize) -> ViewId {
        let placed = panels(self.body(), &self.desk);
        let here = placed.iter().position(|(id, _)| *id == self.desk.focus);
        let count = placed.len().max(1) as isize;
        let next = here.map_or(0, |here| (here as isize + by).rem_euclid(count));
        placed
            .get(next as usize)
            .map_or(self.desk.focus, |(id, _)| *id)
    }

    fn view_of(&self, id: ViewId) -> Option<&dyn View> {
        let found = self.views.iter().find(|(known, _)| *known == id);
        found.map(|(_, view)| view.as_ref())
    }

    fn export(&mut self, action: Action) -> Vec<Effect> {
        let active = self.active();
        let view = self.view_of(active);
        let (extension, contents) = match action {
            Action::ExportDot => ("dot", view.and_then(|view| view.dot(&self.desk))),
            Action::ExportCsv => ("csv", view.and_then(|view| view.csv(&self.desk))),
            Action::ExportText => ("txt", Some(self.rendered(export::FrameFormat::Text))),
            Action::ExportAnsi => ("ansi", Some(self.rendered(export::FrameFormat::Ansi))),
            Action::ExportSvg => ("svg", Some(self.rendered(export::FrameFormat::Svg))),
            _ => return Vec::new(),
        };
        let what = match action {
            Action::ExportDot | Action::ExportCsv => active,
            _ => self.view,
        };
        match contents {
            Some(contents) => {
                let generation = self.desk.shown().map_or(0, |record| record.generation);
                let name = format!("{}-generation{generation}.{extension}", what.name());
                vec![Effect::Export(super::input::Export { name, contents })]
            }
            None => {
                let title = what.title();
                self.desk
                    .say(format!("{title} has no {extension} to export"));
                Vec::new()
            }
        }
    }

    /// The frame as it would be on a terminal of the present size.
    #[must_use]
    pub fn frame(&self) -> Buffer {
        let (width, height) = self.desk.size;
        let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
        self.draw_on(&mut buffer);
        buffer
    }

    fn rendered(&self, format: export::FrameFormat) -> String {
        export::render(&self.frame(), format)
    }

    /// Draws everything.
    pub fn draw(&self, frame: &mut Frame<'_>) {
        self.draw_on(frame.buffer_mut());
    }

    /// Draws everything on a buffer of any size.
    pub fn draw_on(&self, buffer: &mut Buffer) {
        let (desk, area) = (&self.desk, buffer.area);
        buffer.set_style(area, desk.look.style(Paint::Text));
        if area.width < SMALLEST.0 || area.height < SMALLEST.1 {
            return too_small(&desk.look, area, buffer);
        }
        header::draw(desk, self.view, area, buffer);
        match self.view {
            ViewId::Overview => {
                for (id, place) in panels(body(area), desk) {
                    self.draw_panel(id, place, id == desk.focus, buffer);
                }
            }
            view => self.draw_panel(view, body(area), false, buffer),
        }
        let hints = self.view_of(self.active());
        let hints = hints.map_or(Vec::new(), |active| useful(desk, self.view, active));
        header::hint_bar(desk, &hints, area, buffer);
        if let Some(open) = &self.overlay {
            overlay::draw(open, desk, self.view, &self.lessons(), area, buffer);
        }
    }

    /// What there is to see: on the screen, and in the panel that has the focus.
    fn lessons(&self) -> Vec<(&'static str, &'static str)> {
        let mut lessons = Vec::new();
        for id in [self.view, self.active()] {
            let lesson = self.view_of(id).map_or("", |view| view.lesson());
            if !lessons.contains(&(id.title(), lesson)) {
                lessons.push((id.title(), lesson));
            }
        }
        lessons
    }

    fn draw_panel(&self, id: ViewId, area: Rect, focused: bool, buffer: &mut Buffer) {
        let Some(view) = self.view_of(id) else { return };
        let caption = view.caption(&self.desk);
        let inside = panel(
            &self.desk.look,
            area,
            focused,
            (id.title(), &caption),
            buffer,
        );
        view.draw(&self.desk, inside, buffer);
    }
}
