//! The settings of the cliff walk and their defaults.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thesis Figure 2.3.
const WIDTH: usize = 12;
/// Thesis Figure 2.3.
const HEIGHT: usize = 4;
/// Thesis 2.1.3.
const STEP_REWARD: f64 = -1.0;
/// Thesis 2.1.3.
const FALL_REWARD: f64 = -100.0;
/// Thesis Figure 2.4 has sigma 10 at a spacing of 30. Wide Gaussians cannot follow the edge of
/// the cliff.
const RBF_WIDTH_CELLS: f64 = 1.0 / 3.0;

/// A grid with the start in its lower left corner, the goal in the lower right one, and a cliff
/// between them.
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
    /// Where trials start.
    pub begin: CliffBegin,
    /// Width sigma of the Gaussians of Q-learning with RBF features, in cells. Their centres are
    /// the cells.
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

/// Where trials start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CliffBegin {
    /// At the start.
    Start,
    /// In any cell but the goal. The values of all cells can be learned only if trials visit all
    /// cells, which no good policy does from the start.
    #[default]
    Anywhere,
}
