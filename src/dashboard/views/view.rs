//! What a view is to the dashboard.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use crate::dashboard::context::Clicked;
use crate::dashboard::context::Effect;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::view_id::ViewId;

/// What a view does. Everything that several views share is on the [`ViewContext`]; a view
/// keeps what is its own: a column to sort by, a cache of what is dear to compute.
pub(in crate::dashboard) trait View: Send {
    /// The name on the command line.
    fn name(&self) -> &'static str;

    /// The title on the screen.
    fn title(&self) -> &'static str;

    /// Whether the view shows what the individual of the rollout does or has learned.
    fn needs_rollout(&self) -> bool {
        false
    }

    /// The view that the key to open goes to from here.
    fn opens(&self) -> Option<ViewId> {
        None
    }

    /// What the panel is about, after its title: whose, when, in which unit.
    fn caption(&self, _desk: &ViewContext) -> String {
        String::new()
    }

    /// Draws into the area, which may be of any size.
    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer);

    /// The actions that the hint bar names, most useful first.
    fn hints(&self) -> &'static [Action];

    /// Whether one of these actions can do something as things are; only asked for what the
    /// dashboard has nothing against.
    fn can(&self, _desk: &ViewContext, _action: Action) -> bool {
        true
    }

    /// Does what a key asks for; `None` where that is not this view's business.
    fn act(&mut self, _desk: &mut ViewContext, _action: Action) -> Option<Vec<Effect>> {
        None
    }

    /// Selects what is at a place of the area that it was drawn into.
    fn click(&mut self, _desk: &mut ViewContext, _area: Rect, _at: Position) -> Clicked {
        Clicked::Nothing
    }

    /// Computes what drawing needs, after every input while the view is on the screen.
    fn prepare(&mut self, _desk: &ViewContext) {}

    /// What is shown as a table, comma-separated values with a line of names.
    fn csv(&self, _desk: &ViewContext) -> Option<String> {
        None
    }

    /// The hierarchy that is shown, as a Graphviz graph.
    fn dot(&self, _desk: &ViewContext) -> Option<String> {
        None
    }

    /// What there is to see and how to read it, in the terms of the method: the head of
    /// the help overlay.
    fn help_text(&self) -> &'static str;
}
