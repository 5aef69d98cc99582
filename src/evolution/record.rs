//! What is reported of a generation.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::individual::Origin;

/// One scored trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialRecord {
    /// Time steps; the limit if nothing was delivered.
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
    /// How it came into this generation.
    pub origin: Origin,
    /// Its hierarchy as text.
    pub tree: String,
    /// Composite subtasks in it, the root counted.
    pub composites: usize,
    /// Distinct primitive subtasks in it.
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
    /// Number from 1, the initial population.
    pub generation: u64,
    /// All individuals from best to worst.
    pub individuals: Vec<RankedRecord>,
    /// Mean structural difference of the better half, without the best, to the best
    /// (Thesis Figure 4.7).
    pub mean_difference: f64,
    /// For each state type the probability with which each primitive subtask is
    /// selected, averaged over sampled states and the better half (Thesis 4.5.4);
    /// `null` for a type of which the arena has no state.
    pub selection_probabilities: Vec<Option<BTreeMap<String, f64>>>,
    /// Whether the better half has one structure: evolution is over.
    pub converged: bool,
    /// Control steps of the run up to the end of this generation, the training of the
    /// primitive subtasks included.
    pub control_steps: u64,
}

impl GenerationRecord {
    /// Whether every probability is a number; otherwise learning has diverged.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let by_type = self.selection_probabilities.iter().flatten();
        by_type.flat_map(BTreeMap::values).all(|p| p.is_finite())
    }

    /// Mean time steps of a scored trial of the individual at a rank from 1.
    #[must_use]
    pub fn mean_trial_steps(&self, rank: usize) -> Option<f64> {
        let individual = self.individuals.get(rank.checked_sub(1)?)?;
        Some(individual.fitness_steps as f64 / individual.trials.len() as f64)
    }
}
