//! Dietterich's taxi (Dietterich 2000, Thesis 2.2.2) as a scenario describes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::defaults as d;

/// A taxi fetches a passenger at one stand and brings him to another (Thesis Figure 2.6).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TaxiModel {
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

impl Default for TaxiModel {
    fn default() -> Self {
        Self {
            map: d::TAXI_MAP.map(String::from).into(),
            slip: 0.0,
            change_of_mind: 0.0,
            step_reward: d::TAXI_STEP_REWARD,
            delivery_reward: d::TAXI_DELIVERY_REWARD,
            illegal_reward: d::TAXI_ILLEGAL_REWARD,
            state_abstraction: true,
        }
    }
}
