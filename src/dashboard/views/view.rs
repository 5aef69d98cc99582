//! The trait of all views.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::dashboard::context::{Clicked, Effect, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::view_id::ViewId;

/// A view of the dashboard.
///
/// What views share is in the [`ViewContext`]. A view keeps only its own state, such as a column
/// to sort by or a cache of expensive results.
pub(in crate::dashboard) trait View: Send {
    /// Returns the name on the command line.
    fn name(&self) -> &'static str;

    /// Returns the title on the screen.
    fn title(&self) -> &'static str;

    /// Returns whether the view shows what the individual of the rollout does or has learned.
    fn needs_rollout(&self) -> bool {
        false
    }

    /// Returns the view that the `open` key leads to.
    fn opens(&self) -> Option<ViewId> {
        None
    }

    /// Returns the caption that follows the title: which individual, when, in which unit.
    fn caption(&self, _context: &ViewContext) -> String {
        String::new()
    }

    /// Draws into an area of any size.
    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer);

    /// Returns the actions for the hint bar, the most useful first.
    fn hints(&self) -> &'static [Action];

    /// Returns whether an action would have an effect now.
    ///
    /// Called only for actions that the dashboard itself allows.
    fn can(&self, _context: &ViewContext, _action: Action) -> bool {
        true
    }

    /// Performs an action; returns `None` if this view does not handle it.
    fn act(&mut self, _context: &mut ViewContext, _action: Action) -> Option<Vec<Effect>> {
        None
    }

    /// Selects what is drawn at a position of the view's area.
    fn click(&mut self, _context: &mut ViewContext, _area: Rect, _at: Position) -> Clicked {
        Clicked::Nothing
    }

    /// Computes what drawing needs. Called after every input while the view is visible.
    fn prepare(&mut self, _context: &ViewContext) {}

    /// Returns the data shown, as CSV with a line of names.
    fn csv(&self, _context: &ViewContext) -> Option<String> {
        None
    }

    /// Returns the hierarchy shown, as a Graphviz graph.
    fn dot(&self, _context: &ViewContext) -> Option<String> {
        None
    }

    /// Returns the text at the head of the help overlay: what the view shows and how to read it,
    /// in the terms of the method.
    fn help_text(&self) -> &'static str;
}
