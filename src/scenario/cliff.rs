//! The cliff walk (Thesis Figure 2.2) as a scenario describes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::defaults as d;

/// A way along a cliff: the start is in the lower left corner of a grid, the goal in the
/// lower right one, and between the two is the cliff.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CliffModel {
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

impl Default for CliffModel {
    fn default() -> Self {
        Self {
            width: d::CLIFF_WIDTH,
            height: d::CLIFF_HEIGHT,
            step_reward: d::CLIFF_STEP_REWARD,
            fall_reward: d::CLIFF_FALL_REWARD,
            begin: CliffBegin::default(),
            rbf_width_cells: d::CLIFF_RBF_WIDTH_CELLS,
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
