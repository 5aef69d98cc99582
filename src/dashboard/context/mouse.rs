//! Mouse gestures, for terminals where the mouse is enabled.
//!
//! A click on a panel of the overview focuses it, a second click opens it. A click on a line of
//! a list selects it, a click on the selected line opens it. The wheel scrolls the list under
//! the pointer.

use ratatui::crossterm::event::{MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::{Position, Rect};

use crate::dashboard::keys::Action;

/// A gesture and its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    /// Column and row of the terminal, from 0.
    pub at: Position,
    /// The gesture.
    pub what: Gesture,
}

/// A mouse gesture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// The left button was pressed.
    Click,
    /// The wheel was turned up.
    WheelUp,
    /// The wheel was turned down.
    WheelDown,
}

impl Gesture {
    /// Returns the action of the wheel, or `None` for a click.
    pub(in crate::dashboard) fn scrolls(self) -> Option<Action> {
        match self {
            Self::Click => None,
            Self::WheelUp => Some(Action::Up),
            Self::WheelDown => Some(Action::Down),
        }
    }
}

impl Mouse {
    /// Returns the gesture of a terminal event, or `None` for events that the dashboard
    /// ignores.
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

/// The effect of a click on a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::dashboard) enum Clicked {
    /// The click met nothing that can be selected.
    Nothing,
    /// The click has selected something else.
    Selected,
    /// The click met what was already selected.
    Again,
}

impl Clicked {
    /// Returns the effect of a click on `thing` while `before` was selected.
    ///
    /// `select` is called if the selection changes.
    pub(in crate::dashboard) fn on<T: PartialEq>(
        thing: Option<T>,
        before: T,
        select: impl FnOnce(T),
    ) -> Self {
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

/// Returns the line of a list at a position; the list fills `area` below `head` lines.
pub(in crate::dashboard) fn line_at(at: Position, area: Rect, head: u16) -> Option<usize> {
    let below = at.y.checked_sub(area.y.saturating_add(head))?;
    area.contains(at).then_some(usize::from(below))
}
