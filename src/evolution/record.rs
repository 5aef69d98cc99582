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
    /// The scored trials in the order in which they were run.
    pub trials: Vec<TrialRecord>,
    /// Structural difference to the best individual (Thesis 4.5.2), 0 or negative.
    pub difference_to_best: i64,
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
        Some(individual.fitness_steps as f64 / individual.trials.len() as f64)
    }
}
