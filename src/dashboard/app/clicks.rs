//! The response of the dashboard to clicks and the mouse wheel.

use ratatui::layout::{Position, Rect};

use super::state::App;
use crate::dashboard::chrome::overlay::Overlay;
use crate::dashboard::context::{Clicked, Effect, Mouse};
use crate::dashboard::keys::Action;
use crate::dashboard::panel::{body, inside};
use crate::dashboard::view_id::ViewId;
use crate::dashboard::views::panels;

impl App {
    /// Responds to a mouse gesture.
    pub(super) fn mouse(&mut self, mouse: Mouse) -> Vec<Effect> {
        // A click closes any open window. A question is closed without an answer.
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
        let had_focus = self.view != ViewId::Overview || self.context.focus == id;
        if self.view == ViewId::Overview {
            self.context.focus = id;
        }
        if let Some(action) = mouse.what.scrolls() {
            return self.perform(action);
        }
        let view = self.views.iter_mut().find(|(known, _)| *known == id);
        let clicked = view.map_or(Clicked::Nothing, |(_, view)| {
            view.click(&mut self.context, inside(area), mouse.at)
        });
        let opens = match (self.view, clicked) {
            (ViewId::Overview, clicked) => had_focus && clicked != Clicked::Selected,
            (_, clicked) => clicked == Clicked::Again,
        };
        if opens {
            self.perform(Action::Open)
        } else {
            Vec::new()
        }
    }

    /// Returns the view at a position of the screen, and its area including the border.
    fn place_at(&self, at: Position) -> Option<(ViewId, Rect)> {
        let (width, height) = self.context.size;
        let body = body(Rect::new(0, 0, width, height));
        let placed = match self.view {
            ViewId::Overview => panels(body, &self.context),
            view => vec![(view, body)],
        };
        placed.into_iter().find(|(_, area)| area.contains(at))
    }
}
