//! What the mouse does, where it is turned on.
//!
//! A click on a panel of the overview gives it the focus, a second one opens it; a click on
//! a line of a list selects it, one on the line that is selected opens it. The wheel is that of
//! the list under the pointer.

use ratatui::crossterm::event::{MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::{Position, Rect};

use super::app::{App, body};
use super::input::Effect;
use super::keys::Action;
use super::overlay::Overlay;
use super::panel::inside;
use super::runs::RunsTable;
use super::views::{ViewId, panels};

/// Something that was done with the mouse, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    /// Column and row of the terminal, from 0.
    pub at: Position,
    /// What was done.
    pub what: Gesture,
}

/// What is done with a mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// The left button was pressed.
    Click,
    /// The wheel was turned towards earlier lines.
    WheelUp,
    /// The wheel was turned towards later lines.
    WheelDown,
}

impl Gesture {
    /// What the wheel asks for.
    fn scrolls(self) -> Option<Action> {
        match self {
            Self::Click => None,
            Self::WheelUp => Some(Action::Up),
            Self::WheelDown => Some(Action::Down),
        }
    }
}

impl Mouse {
    /// What a terminal told of the mouse; `None` where that is of no account.
    #[must_use]
    pub fn of(event: MouseEvent) -> Option<Self> {
        let what = match event.kind {
            MouseEventKind::Down(MouseButton::Left) => Gesture::Click,
            MouseEventKind::ScrollUp => Gesture::WheelUp,
            MouseEventKind::ScrollDown => Gesture::WheelDown,
            _ => return None,
        };
        let at = Position::new(event.column, event.row);
        Some(Self { at, what })
    }
}

/// What a click on a view has done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clicked {
    /// There was nothing to select.
    Nothing,
    /// It has selected something.
    Selected,
    /// It met what was selected before.
    Again,
}

impl Clicked {
    /// A click on one of several things, or on none, when `before` was selected; `select`
    /// selects another.
    pub(super) fn on<T: PartialEq>(thing: Option<T>, before: T, select: impl FnOnce(T)) -> Self {
        match thing {
            None => Self::Nothing,
            Some(thing) if thing == before => Self::Again,
            Some(thing) => {
                select(thing);
                Self::Selected
            }
        }
    }
}

/// Which line of a list is at a place: the list fills an area below a head of so many lines.
pub(super) fn line_at(at: Position, area: Rect, head: u16) -> Option<usize> {
    let below = at.y.checked_sub(area.y.saturating_add(head))?;
    area.contains(at).then_some(usize::from(below))
}

impl App {
    /// Does what the mouse asks for.
    pub(super) fn mouse(&mut self, mouse: Mouse) -> Vec<Effect> {
        // A click closes what is open, a question too: that answers nothing.
        match self.overlay.take() {
            Some(Overlay::Help { scroll }) => {
                self.scroll_help(scroll, mouse.what.scrolls());
                return Vec::new();
            }
            Some(_) => return Vec::new(),
            None => {}
        }
        let Some((id, area)) = self.place_at(mouse.at) else {
            return Vec::new();
        };
        let had_focus = self.view != ViewId::Overview || self.desk.focus == id;
        if self.view == ViewId::Overview {
            self.desk.focus = id;
        }
        if let Some(action) = mouse.what.scrolls() {
            return self.perform(action);
        }
        let view = self.views.iter_mut().find(|(known, _)| *known == id);
        let clicked = view.map_or(Clicked::Nothing, |(_, view)| {
            view.click(&mut self.desk, inside(area), mouse.at)
        });
        let opens = match (self.view, clicked) {
            (ViewId::Overview, clicked) => had_focus && clicked != Clicked::Selected,
            (_, clicked) => clicked == Clicked::Again,
        };
        match opens {
            true => self.perform(Action::Open),
            false => Vec::new(),
        }
    }

    /// The view at a place of the screen, and its area with the border.
    fn place_at(&self, at: Position) -> Option<(ViewId, Rect)> {
        let (width, height) = self.desk.size;
        let body = body(Rect::new(0, 0, width, height));
        let placed = match self.view {
            ViewId::Overview => panels(body, &self.desk),
            view => vec![(view, body)],
        };
        placed.into_iter().find(|(_, area)| area.contains(at))
    }
}

impl RunsTable {
    /// Does what the mouse asks for: a click on the run that is selected opens it.
    pub fn mouse(&mut self, mouse: Mouse) -> Option<super::RunsEffect> {
        match mouse.what.scrolls() {
            Some(action) => self.perform(action),
            None if self.click(mouse.at) => self.perform(Action::Open),
            None => None,
        }
    }
}
