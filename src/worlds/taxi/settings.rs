//! The settings of the taxi problem and their defaults.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The taxi's city, Thesis Figure 2.6 (Dietterich 2000, Figure 1).
pub(super) const MAP: [&str; 5] = [
    "R: | : :G",
    " : | : : ",
    " : : : : ",
    " | : | : ",
    "Y| : |B: ",
];
/// Thesis 2.2.2.
const STEP_REWARD: f64 = -1.0;
/// Thesis 2.2.2: a delivery brings 19 in all, which agrees with the values printed there.
const DELIVERY_REWARD: f64 = 20.0;
/// Thesis 2.2.2: an illegal action brings -11 in all.
const ILLEGAL_REWARD: f64 = -10.0;

/// A taxi fetches a passenger at one stand and brings him to another (Thesis Figure 2.6).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TaxiSettings {
    /// The city, row by row from north to south. A cell is a space or the capital letter of a
    /// stand; between two cells stands `|` for a wall, `:` for none.
    pub map: Vec<String>,
    /// Probability that a move goes to the right or left of its direction, each equally likely;
    /// 0.2 in the fickle taxi.
    pub slip: f64,
    /// Probability that the passenger chooses another destination when the taxi first leaves the
    /// cell where he boarded it; 0.3 in the fickle taxi.
    pub change_of_mind: f64,
    /// Reward of every action.
    pub step_reward: f64,
    /// Added when the passenger is put down at his destination.
    pub delivery_reward: f64,
    /// Added when a pickup or putdown is illegal.
    pub illegal_reward: f64,
    /// Whether each value function depends only on the parts of the state that matter to it
    /// (Dietterich 2000, section 5). Otherwise all depend on the whole state.
    pub state_abstraction: bool,
}

impl Default for TaxiSettings {
    fn default() -> Self {
        Self {
            map: MAP.map(String::from).into(),
            slip: 0.0,
            change_of_mind: 0.0,
            step_reward: STEP_REWARD,
            delivery_reward: DELIVERY_REWARD,
            illegal_reward: ILLEGAL_REWARD,
            state_abstraction: true,
        }
    }
}
