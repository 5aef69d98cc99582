//! A dashboard without a terminal, for single frames and for tests.

use super::state::App;
use crate::dashboard::context::{Effect, Input};
use crate::dashboard::view_id::ViewId;
use crate::lab::inspection::Archive;

/// A dashboard without a terminal, over a recorded run.
///
/// It loads the populations that the dashboard requests at once, and returns all other effects
/// to its caller.
pub struct OffscreenDashboard {
    app: App,
    archive: Archive,
}

impl OffscreenDashboard {
    /// Creates a dashboard that loads populations from `archive`.
    #[must_use]
    pub fn new(app: App, archive: Archive) -> Self {
        Self { app, archive }
    }

    /// Returns the dashboard.
    #[must_use]
    pub fn app(&self) -> &App {
        &self.app
    }

    /// Updates the dashboard; returns the effects that are left to the caller.
    pub fn update(&mut self, input: Input) -> Vec<Effect> {
        let effects = self.app.update(input);
        self.run_effects(effects)
    }

    /// Opens a view.
    pub fn open(&mut self, view: ViewId) {
        let effects = self.app.open(view);
        self.run_effects(effects);
    }

    /// Shows the generation with this number, or the nearest one.
    pub fn travel_to(&mut self, generation: u64) {
        let effects = self.app.travel_to(generation);
        self.run_effects(effects);
    }

    /// Returns whether a redraw is needed and clears the flag; see [`App::take_dirty`].
    pub fn take_dirty(&mut self) -> bool {
        self.app.take_dirty()
    }

    fn run_effects(&mut self, effects: Vec<Effect>) -> Vec<Effect> {
        let mut left = Vec::new();
        for effect in effects {
            match effect {
                Effect::Load { generation } => {
                    let state = self.archive.nearest(generation);
                    let state = state.map_err(|error| error.to_string());
                    left.extend(self.update(Input::Population { generation, state }));
                }
                other => left.push(other),
            }
        }
        left
    }
}
