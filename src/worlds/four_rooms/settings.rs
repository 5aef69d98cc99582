//! Four rooms as a scenario describes them: settings, defaults, rules.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Probability of a slip, Sutton, Precup and Singh 1999, section 3.
const SLIP: f64 = 1.0 / 3.0;
/// A cell of the south-eastern room that is no subtask's goal but the last one's.
const GOAL_CELL: [usize; 2] = [8, 8];
/// Reward of every step: see the module's description.
const STEP_REWARD: f64 = -1.0;

/// A house of four rooms with hallways between them, and a goal somewhere in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FourRoomsSettings {
    /// Column and row of the goal, from 0 at the upper left, within the outer walls.
    pub goal_cell: [usize; 2],
    /// Probability with which a move goes into one of the three other directions, a third
    /// of it into each.
    pub slip: f64,
    /// Reward of every step that does not reach the goal.
    pub step_reward: f64,
    /// Reward of the step that does.
    pub goal_reward: f64,
}

impl Default for FourRoomsSettings {
    fn default() -> Self {
        Self {
            goal_cell: GOAL_CELL,
            slip: SLIP,
            step_reward: STEP_REWARD,
            goal_reward: STEP_REWARD,
        }
    }
}
