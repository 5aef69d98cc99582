//! The result of a run: `run` prints it and `summary.json` holds it.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::folder::SUMMARY;
use super::later::LaterSummary;
use crate::evolution::{GenerationRecord, RankedRecord};
use crate::files::{FileError, Limits, read_json};

/// The result of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the run.
    pub seed: u64,
    /// Number of generations.
    pub generations: u64,
    /// Whether evolution converged; otherwise it reached its limit or was stopped.
    pub converged: bool,
    /// Whether the run was stopped before evolution was over.
    pub stopped: bool,
    /// The best individual of the last generation; `None` before the first generation is done.
    pub best: Option<BestIndividual>,
    /// What the best hierarchy learned after evolution, if the scenario asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub later: Option<LaterSummary>,
    /// Control steps of the evolution, training of the primitive subtasks included.
    pub control_steps: u64,
    /// Wall-clock time of this process, in seconds.
    pub wall_seconds: f64,
    /// The run folder.
    pub run_dir: String,
}

/// Limits of `summary.json`.
const LIMITS: Limits = Limits {
    bytes: 1 << 20,
    depth: 8,
    values: 10_000,
};

impl Outcome {
    /// Reads the result of the run in a folder; returns `None` before evolution is over.
    ///
    /// # Errors
    /// When the file does not hold a result.
    pub fn read(folder: &Path) -> Result<Option<Self>, FileError> {
        read_json(&folder.join(SUMMARY), LIMITS)
    }
}

/// The best individual of a generation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BestIndividual {
    /// Its id.
    pub id: u64,
    /// Its hierarchy as text.
    pub tree: String,
    /// Mean time steps of a scored trial.
    ///
    /// It is biased by selection, since the best of many was lucky too; `evaluate` measures how
    /// good the structure is.
    pub fitness: f64,
    /// Composite subtasks in it, the root counted.
    pub composites: usize,
    /// Distinct primitive subtasks in it.
    pub primitives: Vec<String>,
    /// For each state type the primitive subtasks that can be selected.
    pub primitives_by_state_type: Vec<Vec<String>>,
}

impl BestIndividual {
    /// Returns the best individual of a generation.
    #[must_use]
    pub fn of(record: &GenerationRecord) -> Option<Self> {
        let best: &RankedRecord = record.individuals.first()?;
        Some(Self {
            id: best.id,
            tree: best.tree.clone(),
            fitness: record.mean_trial_steps(1)?,
            composites: best.composites,
            primitives: best.primitives.clone(),
            primitives_by_state_type: best.primitives_by_state_type.clone(),
        })
    }
}
