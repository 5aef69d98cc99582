//! What a view is to the dashboard.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::dashboard::desk::Desk;
use crate::dashboard::input::Effect;
use crate::dashboard::keys::Action;
use crate::dashboard::mouse::Clicked;

/// What a view does. Everything that several views share is on the [`Desk`]; a view
/// keeps what is its own: a column to sort by, a cache of what is dear to compute.
pub(in crate::dashboard) trait View: Send {
    /// What the panel is about, after its title: whose, when, in which unit.
    fn caption(&self, _desk: &Desk) -> String {
        String::new()
    }

    /// Draws into the area, which may be of any size.
    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer);

    /// The actions that the hint bar names, most useful first.
    fn hints(&self) -> &'static [Action];

    /// Whether one of these actions can do something as things are; only asked for what the
    /// dashboard has nothing against.
    fn can(&self, _desk: &Desk, _action: Action) -> bool {
        true
    }

    /// Does what a key asks for; `None` where that is not this view's business.
    fn act(&mut self, _desk: &mut Desk, _action: Action) -> Option<Vec<Effect>> {
        None
    }

    /// Selects what is at a place of the area that it was drawn into.
    fn click(&mut self, _desk: &mut Desk, _area: Rect, _at: Position) -> Clicked {
        Clicked::Nothing
    }

    /// Computes what drawing needs, after every input while the view is on the screen.
    fn prepare(&mut self, _desk: &Desk) {}

    /// What is shown as a table, comma-separated values with a line of names.
    fn csv(&self, _desk: &Desk) -> Option<String> {
        None
    }

    /// The hierarchy that is shown, as a Graphviz graph.
    fn dot(&self, _desk: &Desk) -> Option<String> {
        None
    }

    /// What there is to see and how to read it, in the terms of the method: the head of
    /// the help overlay.
    fn lesson(&self) -> &'static str;
}
