//! Dietterich's taxi (Dietterich 2000, Thesis 2.2.2) as a scenario describes it: settings, defaults, rules.

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
/// Reward of every action of the taxi, Thesis 2.2.2.
const STEP_REWARD: f64 = -1.0;
/// Added where the passenger is put down at his destination, Thesis 2.2.2: that action
/// brings 19, and the values printed there come out.
const DELIVERY_REWARD: f64 = 20.0;
/// Added where a pickup or putdown is illegal, Thesis 2.2.2: that action brings -11.
const ILLEGAL_REWARD: f64 = -10.0;

/// A taxi fetches a passenger at one stand and brings him to another (Thesis Figure 2.6).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TaxiSettings {
    /// The city from north to south, a line a row: every cell is a space or the capital
    /// letter of a stand, and between two cells is `|` for a wall, `:` for none.
    pub map: Vec<String>,
    /// Probability with which a move goes to the right or to the left of where it was
    /// meant to go, half of it to each side; 0.2 in the fickle taxi.
    pub slip: f64,
    /// Probability with which the passenger wants to go to another stand when the taxi
    /// first moves away from where he boarded it; 0.3 in the fickle taxi.
    pub change_of_mind: f64,
    /// Reward of every action.
    pub step_reward: f64,
    /// Added to it when the passenger is put down at his destination.
    pub delivery_reward: f64,
    /// Added to it when he cannot be picked up or put down.
    pub illegal_reward: f64,
    /// Whether value functions look at those parts of the state alone that matter to
    /// them (Dietterich 2000, section 5), or all at the whole state.
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
