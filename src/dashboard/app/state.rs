//! The state of the dashboard, and its two functions: update and draw.

use std::time::Duration;

use ratatui::Frame;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::export::{FrameFormat, render};
use super::steering::{Steered, steer};
use crate::dashboard::chrome::header;
use crate::dashboard::chrome::hints::useful;
use crate::dashboard::chrome::overlay::{self, Overlay};
use crate::dashboard::context::{Chosen, Effect, Export, Input, ViewContext};
use crate::dashboard::keys::{Action, Key, Scope};
use crate::dashboard::look::Paint;
use crate::dashboard::panel::{SMALLEST, body, panel, too_small};
use crate::dashboard::view_id::ViewId;
use crate::dashboard::views::{self, View, panels};
use crate::lab::Event;
use crate::lab::inspection::Start;

/// The dashboard of one run.
pub struct App {
    pub(super) context: ViewContext,
    pub(super) views: Vec<(ViewId, Box<dyn View>)>,
    pub(super) view: ViewId,
    pub(super) overlay: Option<Overlay>,
    dirty: bool,
}

impl App {
    /// Creates a dashboard over a context; it opens with the overview.
    #[must_use]
    pub fn new(context: ViewContext) -> Self {
        Self {
            context,
            views: views::all(),
            view: ViewId::Overview,
            overlay: None,
            dirty: true,
        }
    }

    /// Returns the context that the views read.
    #[must_use]
    pub fn context(&self) -> &ViewContext {
        &self.context
    }

    /// Returns the view on the screen.
    #[must_use]
    pub fn view(&self) -> ViewId {
        self.view
    }

    /// Opens a view; returns the effects that the caller must run.
    pub fn open(&mut self, view: ViewId) -> Vec<Effect> {
        self.view = view;
        self.dirty = true;
        self.prepare()
    }

    /// Sets whether the dashboard was opened from a list of runs to which the user can return.
    #[must_use]
    pub fn with_back(mut self, has_back: bool) -> Self {
        self.context.has_back = has_back;
        self
    }

    /// Lets the trials of rollouts start at `start`.
    #[must_use]
    pub fn starting_at(mut self, start: Option<Start>) -> Self {
        if let Some(start) = start {
            self.context.player.start_at(start);
        }
        self
    }

    /// Shows the generation with this number, or the nearest one; returns the effects that the
    /// caller must run.
    pub fn travel_to(&mut self, generation: u64) -> Vec<Effect> {
        self.context.travel_to(generation);
        self.dirty = true;
        self.prepare()
    }

    /// Returns whether a redraw is needed and clears the flag; a caller that gets `true` must
    /// draw.
    pub fn take_dirty(&mut self) -> bool {
        std::mem::take(&mut self.dirty)
    }

    /// Updates the state; returns the effects that the caller must run.
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
                self.context.size = (columns, rows);
            }
            // Hundreds of events may arrive at once, so their consequences wait for the next
            // tick.
            Input::Event(event) => {
                self.event(*event);
                return effects;
            }
            Input::Closed => {
                self.dirty = true;
                self.context.closed = true;
            }
            Input::LastSign(sign) => {
                self.dirty = true;
                self.context.show_message(sign.to_string());
                self.context.last_sign = Some(sign);
            }
            Input::Tick(elapsed) => self.tick(elapsed),
            Input::Population { generation, state } => {
                self.dirty = true;
                if let Ok(state) = &state {
                    self.context.note_stand_in(generation, state.generation);
                }
                self.context.player.receive(generation, state);
            }
            Input::FolderBytes(bytes) => {
                self.dirty |= self.context.folder_bytes.replace(bytes) != Some(bytes);
            }
            Input::Message(text) => {
                self.dirty = true;
                self.context.show_message(text);
            }
        }
        effects.extend(self.prepare());
        effects
    }

    fn event(&mut self, event: Event) {
        let context = &mut self.context;
        match &event {
            Event::Progress { control_steps, .. } => {
                // A watched run may be resumed by another process.
                context.closed = false;
                context.last_sign = None;
                context.pace.steps(*control_steps);
            }
            Event::Generation(record) => context.pace.generation(record.generation),
            Event::Paused => context.stepping = false,
            _ => {}
        }
        context.live_history_mut().apply(event);
        self.dirty = true;
    }

    fn tick(&mut self, elapsed: Duration) {
        let said = self.context.message().is_some();
        self.dirty |= self.context.tick(elapsed);
        if self.shows_rollout() {
            self.dirty |= self.context.player.tick(elapsed);
        }
        self.dirty |= said != self.context.message().is_some();
    }

    /// Loads the inspected individual into the player, and lets the views on the screen
    /// precompute what they draw.
    fn prepare(&mut self) -> Vec<Effect> {
        let on_screen = self.on_screen();
        let mut effects = Vec::new();
        if self.shows_rollout() {
            let (wanted, by_choice) = (self.context.wanted(), !self.context.follows());
            let load = self.context.player.switch_to(wanted, by_choice);
            effects.extend(load.map(|generation| Effect::Load { generation }));
        }
        for (id, view) in &mut self.views {
            if on_screen.contains(id) {
                view.prepare(&self.context);
            }
        }
        effects
    }

    fn shows_rollout(&self) -> bool {
        let on_screen = self.on_screen();
        let mut views = on_screen.iter().filter_map(|id| self.view_of(*id));
        views.any(View::needs_rollout)
    }

    /// Returns the view that the open key leads to from here.
    fn opens(&self) -> Option<ViewId> {
        self.view_of(self.view)?.opens()
    }

    fn on_screen(&self) -> Vec<ViewId> {
        match self.view {
            ViewId::Overview => {
                let placed = panels(self.body(), &self.context);
                placed.into_iter().map(|(id, _)| id).collect()
            }
            view => vec![view],
        }
    }

    fn body(&self) -> Rect {
        let (width, height) = self.context.size;
        body(Rect::new(0, 0, width, height))
    }

    /// Returns the view that keys act on: the focused panel in the overview, else the view on
    /// the screen.
    fn active(&self) -> ViewId {
        match self.view {
            ViewId::Overview => self.context.focus,
            view => view,
        }
    }

    fn key(&mut self, key: Key) -> Vec<Effect> {
        if let Some(open) = self.overlay.take() {
            return self.key_in_overlay(open, key);
        }
        let keys = &self.context.keys;
        let in_view = keys.in_view(key, self.active());
        let Some(action) = in_view.or_else(|| keys.in_view(key, self.view)) else {
            return Vec::new();
        };
        self.perform(action)
    }

    /// Performs an action. The active view is asked first, then the view on the screen, then
    /// the dashboard itself.
    pub(super) fn perform(&mut self, action: Action) -> Vec<Effect> {
        let active = self.active();
        for id in [active, self.view] {
            let Some((_, view)) = self.views.iter_mut().find(|(known, _)| *known == id) else {
                continue;
            };
            if let Some(effects) = view.act(&mut self.context, action) {
                return effects;
            }
        }
        self.act(action)
    }

    fn key_in_overlay(&mut self, open: Overlay, key: Key) -> Vec<Effect> {
        let keys = &self.context.keys;
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
                Some(Action::Yes) => question.yes(&mut self.context),
                Some(Action::Detach) if question == overlay::Question::Quit => vec![Effect::Detach],
                _ => Vec::new(),
            },
        }
    }

    /// Scrolls the help; an action that does not scroll closes it.
    pub(super) fn scroll_help(&mut self, scroll: u16, action: Option<Action>) {
        let most = overlay::help_lines(&self.context, self.view, &self.help_texts()).len();
        let scroll = overlay::scrolled(scroll, action, self.context.size.1, most);
        self.overlay = scroll.map(|scroll| Overlay::Help { scroll });
    }

    /// Performs an action that no view handles.
    fn act(&mut self, action: Action) -> Vec<Effect> {
        if let Some(view) = action.view() {
            self.view = view;
            return Vec::new();
        }
        match steer(&mut self.context, action) {
            Steered::Nothing => {}
            Steered::Ask(question) => {
                self.overlay = Some(Overlay::Question(question));
                return Vec::new();
            }
            Steered::Done(effect) => return effect.into_iter().collect(),
        }
        let context = &mut self.context;
        match action {
            Action::Help => self.overlay = Some(Overlay::Help { scroll: 0 }),
            Action::Export => self.overlay = Some(Overlay::Export),
            Action::Suspend => return vec![Effect::Suspend],
            Action::Redraw => return vec![Effect::Redraw],
            Action::Back if self.view == ViewId::Overview => return vec![Effect::Back],
            Action::Back => self.view = ViewId::Overview,
            Action::Open if self.view == ViewId::Overview => self.view = context.focus,
            Action::Open => self.view = self.opens().unwrap_or(self.view),
            Action::NextPanel => self.context.focus = self.neighbour(1),
            Action::PreviousPanel => self.context.focus = self.neighbour(-1),
            Action::Freeze => context.toggle_freeze(),
            Action::Best => context.chosen = Chosen::Best,
            Action::Earlier => context.travel_by(-1),
            Action::Later => context.travel_by(1),
            Action::MuchEarlier => context.travel_by(-10),
            Action::MuchLater => context.travel_by(10),
            Action::First => context.travel_to(0),
            Action::Follow => context.travel_to(u64::MAX),
            Action::Play => context.toggle_play(),
            Action::Halt => context.player.toggle_halt(),
            Action::StepRollout => context.player.step(),
            Action::Faster => context.player.change_speed(true),
            Action::Slower => context.player.change_speed(false),
            Action::Restart => context.player.restart(),
            Action::NextTrial => {
                context.player.next_trial();
                if let Some(rollout) = context.player.rollout() {
                    let text =
                        format!("trial {} starts with the next step", rollout.status().trial);
                    context.show_message(text);
                }
            }
            Action::Mark => context.mark(),
            Action::Theme => {
                context.look.next_theme();
                let theme = context.look.theme().to_owned();
                context.show_message(format!("theme: {theme}"));
            }
            _ => {}
        }
        Vec::new()
    }

    /// Returns the panel `by` places after the focused one.
    fn neighbour(&self, by: isize) -> ViewId {
        let placed = panels(self.body(), &self.context);
        let here = placed.iter().position(|(id, _)| *id == self.context.focus);
        let count = placed.len().max(1) as isize;
        let next = here.map_or(0, |here| (here as isize + by).rem_euclid(count));
        placed
            .get(next as usize)
            .map_or(self.context.focus, |(id, _)| *id)
    }

    fn view_of(&self, id: ViewId) -> Option<&dyn View> {
        let found = self.views.iter().find(|(known, _)| *known == id);
        found.map(|(_, view)| view.as_ref())
    }

    fn export(&mut self, action: Action) -> Vec<Effect> {
        let active = self.active();
        let view = self.view_of(active);
        let (extension, contents) = match action {
            Action::ExportDot => ("dot", view.and_then(|view| view.dot(&self.context))),
            Action::ExportCsv => ("csv", view.and_then(|view| view.csv(&self.context))),
            Action::ExportText => ("txt", Some(self.rendered(FrameFormat::Text))),
            Action::ExportAnsi => ("ansi", Some(self.rendered(FrameFormat::Ansi))),
            Action::ExportSvg => ("svg", Some(self.rendered(FrameFormat::Svg))),
            Action::ExportRemove => return vec![Effect::RemoveExport],
            _ => return Vec::new(),
        };
        let of = match action {
            Action::ExportDot | Action::ExportCsv => active,
            _ => self.view,
        };
        let Some(contents) = contents else {
            let text = format!("{} has no {extension} export", of.title());
            self.context.show_message(text);
            return Vec::new();
        };
        let generation = self.context.shown().map_or(0, |record| record.generation);
        let name = format!("{}-generation{generation}.{extension}", of.name());
        vec![Effect::Export(Export { name, contents })]
    }

    /// Returns a frame of the current terminal size.
    #[must_use]
    pub fn frame(&self) -> Buffer {
        let (width, height) = self.context.size;
        let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
        self.draw_on(&mut buffer);
        buffer
    }

    fn rendered(&self, format: FrameFormat) -> String {
        render(&self.frame(), format)
    }

    /// Draws a frame.
    pub fn draw(&self, frame: &mut Frame<'_>) {
        self.draw_on(frame.buffer_mut());
    }

    /// Draws a frame into a buffer of any size.
    pub fn draw_on(&self, buffer: &mut Buffer) {
        let (context, area) = (&self.context, buffer.area);
        buffer.set_style(area, context.look.style(Paint::Text));
        if area.width < SMALLEST.0 || area.height < SMALLEST.1 {
            return too_small(&context.look, area, buffer);
        }
        header::draw(context, self.view, area, buffer);
        match self.view {
            ViewId::Overview => {
                for (id, place) in panels(body(area), context) {
                    self.draw_panel(id, place, id == context.focus, buffer);
                }
            }
            view => self.draw_panel(view, body(area), false, buffer),
        }
        let hints = self.view_of(self.active());
        let hints = hints.map_or(Vec::new(), |active| useful(context, self.view, active));
        header::hint_bar(context, &hints, area, buffer);
        if let Some(open) = &self.overlay {
            overlay::draw(open, context, self.view, &self.help_texts(), area, buffer);
        }
    }

    /// Returns title and help text of the view on the screen and of the active view.
    fn help_texts(&self) -> Vec<(&'static str, &'static str)> {
        let mut texts = Vec::new();
        for id in [self.view, self.active()] {
            let text = self.view_of(id).map_or("", |view| view.help_text());
            if !texts.contains(&(id.title(), text)) {
                texts.push((id.title(), text));
            }
        }
        texts
    }

    fn draw_panel(&self, id: ViewId, area: Rect, focused: bool, buffer: &mut Buffer) {
        let Some(view) = self.view_of(id) else { return };
        let caption = view.caption(&self.context);
        let inside = panel(
            &self.context.look,
            area,
            focused,
            (id.title(), &caption),
            buffer,
        );
        view.draw(&self.context, inside, buffer);
    }
}
