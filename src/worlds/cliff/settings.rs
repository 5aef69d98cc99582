//! The cliff walk (Thesis Figure 2.2) as a scenario describes it: settings, defaults, rules.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Columns of the cliff walk, Thesis Figure 2.3.
const WIDTH: usize = 12;
/// Rows of the cliff walk, Thesis Figure 2.3.
const HEIGHT: usize = 4;
/// Reward of a step that does not lead into the cliff, Thesis 2.1.3.
const STEP_REWARD: f64 = -1.0;
/// Reward of a step into the cliff, Thesis 2.1.3.
const FALL_REWARD: f64 = -100.0;
/// Sigma of the cliff walk's Gaussians over their spacing: that of Thesis Figure 2.4,
/// sigma 10 at a spacing of 30. Wide Gaussians cannot follow the edge of the cliff.
const RBF_WIDTH_CELLS: f64 = 1.0 / 3.0;

/// A way along a cliff: the start is in the lower left corner of a grid, the goal in the
/// lower right one, and between the two is the cliff.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CliffSettings {
    /// Columns of the grid.
    pub width: usize,
    /// Rows of the grid.
    pub height: usize,
    /// Reward of every step that does not lead into the cliff.
    pub step_reward: f64,
    /// Reward of a step into the cliff, which leads back to the start.
    pub fall_reward: f64,
    /// Where trials begin.
    pub begin: CliffBegin,
    /// Width of the Gaussians of Q-learning with RBF features, whose centres are the
    /// cells: sigma in units of their spacing.
    pub rbf_width_cells: f64,
}

impl Default for CliffSettings {
    fn default() -> Self {
        Self {
            width: WIDTH,
            height: HEIGHT,
            step_reward: STEP_REWARD,
            fall_reward: FALL_REWARD,
            begin: CliffBegin::default(),
            rbf_width_cells: RBF_WIDTH_CELLS,
        }
    }
}

/// Where trials on the cliff begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CliffBegin {
    /// At the start.
    Start,
    /// In any cell but the goal: whoever is to know the value of every cell has to come
    /// to every cell, and no good way from the start does.
    #[default]
    Anywhere,
}
