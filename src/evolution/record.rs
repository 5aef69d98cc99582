//! The record of a generation, as it is written to events.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::individual::Origin;

/// One scored trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialRecord {
    /// Time steps; the step limit if the task was not done.
    pub steps: u32,
    /// Whether the task was done.
    pub delivered: bool,
}

/// Most scored trials that a record lists, so that it does not grow with the trials of a
/// generation.
pub const MOST_LISTED: usize = 512;

/// The sum of trials that a record does not list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnlistedTrials {
    /// Number of trials.
    pub trials: usize,
    /// Number of trials in which the task was done.
    pub delivered: usize,
    /// Time steps of all.
    pub steps: u64,
}

/// One individual after its generation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RankedRecord {
    /// Rank from 1, the best.
    pub rank: usize,
    /// Id of the individual.
    pub id: u64,
    /// Its origin in this generation.
    pub origin: Origin,
    /// Its hierarchy as text.
    pub tree: String,
    /// Number of composite subtasks, the root counted.
    pub composites: usize,
    /// The different primitive subtasks.
    pub primitives: Vec<String>,
    /// For each state type the primitive subtasks that can be selected.
    pub primitives_by_state_type: Vec<Vec<String>>,
    /// Fitness: time steps over the scored trials; smaller is better.
    pub fitness_steps: u64,
    /// The scored trials in the order in which they were run, at most [`MOST_LISTED`] of them.
    pub trials: Vec<TrialRecord>,
    /// The scored trials that are not listed; `None` if all are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unlisted: Option<UnlistedTrials>,
    /// Structural difference to the best individual (Thesis 4.5.2), 0 or negative.
    pub difference_to_best: i64,
}

impl RankedRecord {
    /// Returns the number of scored trials.
    #[must_use]
    pub fn scored(&self) -> usize {
        self.trials.len() + self.unlisted.map_or(0, |unlisted| unlisted.trials)
    }

    /// Returns the number of scored trials in which the task was done.
    #[must_use]
    pub fn delivered(&self) -> usize {
        let listed = self.trials.iter().filter(|trial| trial.delivered).count();
        listed + self.unlisted.map_or(0, |unlisted| unlisted.delivered)
    }

    /// Returns the mean time steps of a scored trial.
    #[must_use]
    pub fn mean_steps(&self) -> f64 {
        self.fitness_steps as f64 / self.scored().max(1) as f64
    }
}

/// One generation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GenerationRecord {
    /// Number of the generation; 1 is the initial population.
    pub generation: u64,
    /// All individuals from best to worst.
    pub individuals: Vec<RankedRecord>,
    /// Mean structural difference to the best, over the better half without the best itself
    /// (Thesis Figure 4.7).
    pub mean_difference: f64,
    /// For each state type the probability of selecting each primitive subtask, averaged over
    /// sampled states and the better half (Thesis 4.5.4).
    ///
    /// `null` for a state type of which no state was found.
    pub selection_probabilities: Vec<Option<BTreeMap<String, f64>>>,
    /// Whether the better half has one structure, which ends evolution; never with
    /// `stop_on_convergence: false`.
    pub converged: bool,
    /// Control steps of the run up to the end of this generation, with the training of the
    /// primitive subtasks.
    pub control_steps: u64,
}

impl GenerationRecord {
    /// Returns whether every probability is finite. Otherwise learning has diverged.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let by_type = self.selection_probabilities.iter().flatten();
        by_type.flat_map(BTreeMap::values).all(|p| p.is_finite())
    }

    /// Returns the mean time steps of a scored trial of the individual at `rank`, from 1.
    #[must_use]
    pub fn mean_trial_steps(&self, rank: usize) -> Option<f64> {
        let individual = self.individuals.get(rank.checked_sub(1)?)?;
        Some(individual.mean_steps())
    }
}
