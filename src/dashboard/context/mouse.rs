//! What the mouse does, where it is turned on.
//!
//! A click on a panel of the overview gives it the focus, a second one opens it; a click on
//! a line of a list selects it, one on the line that is selected opens it. The wheel is that of
//! the list under the pointer.

use ratatui::crossterm::event::{MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::{Position, Rect};

use crate::dashboard::keys::Action;

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
    pub(in crate::dashboard) fn scrolls(self) -> Option<Action> {
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
pub(in crate::dashboard) enum Clicked {
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

/// Which line of a list is at a place: the list fills an area below a head of so many lines.
pub(in crate::dashboard) fn line_at(at: Position, area: Rect, head: u16) -> Option<usize> {
    let below = at.y.checked_sub(area.y.saturating_add(head))?;
    area.contains(at).then_some(usize::from(below))
}
