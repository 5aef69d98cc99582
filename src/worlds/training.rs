//! How a primitive subtask is trained before evolution starts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::rules::Check;

/// Training of one primitive subtask.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrainingSettings {
    /// Total number of time steps.
    pub steps: u32,
    /// Time steps after which an episode ends and the next one starts elsewhere.
    pub episode_steps: u32,
    /// How actions are chosen.
    pub exploration: Exploration,
    /// The factor on the temperature of `softmax` at the end of each episode.
    pub temperature_decrease: f64,
}

impl TrainingSettings {
    /// Checks every rule.
    pub fn check(&self, check: &mut Check) {
        check.range("steps", self.steps, 0..=10_000_000);
        check.range("episode_steps", self.episode_steps, 1..=1_000_000);
        check.range("temperature_decrease", self.temperature_decrease, 0.0..=1.0);
    }
}

/// How actions are chosen while a primitive subtask is trained.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Exploration {
    /// All actions are equally likely.
    Uniform,
    /// Softmax, with a temperature that decreases from episode to episode.
    Softmax,
}
