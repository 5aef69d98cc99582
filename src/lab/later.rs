//! What the best hierarchy learns after evolution: `learning.json`.
//!
//! Evolution settles a structure. Whether its policy improves after that is a claim of its own
//! (S. Elfwing et al. 2007, *Evolutionary development of hierarchical learning structures*).

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::folder::LEARNING;
use super::statistics::mean_of;
use crate::evolution::{EvolutionState, Experiment, TrialRecord};
use crate::files::{FileError, Limits, read_json, write_atomically};
use crate::learning::{Gate, Stopped};
use crate::random::{Purpose, stream};
use crate::worlds::World;

/// Version of the format of `learning.json`.
const FORMAT: u32 = 1;

/// Limits of `learning.json`: a trial takes up to 40 bytes, and a scenario allows a million.
const LIMITS: Limits = Limits {
    bytes: 1 << 26,
    depth: 4,
    values: 1 << 22,
};

/// The trials that the best hierarchy lived after evolution, learning as before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LaterLearning {
    /// Version of this format.
    pub format: u32,
    /// The generation after which it began.
    pub generation: u64,
    /// Id of the individual: the best of that generation.
    pub individual: u64,
    /// The trials in order.
    pub trials: Vec<TrialRecord>,
}

/// The sum of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LaterSummary {
    /// Number of trials.
    pub trials: usize,
    /// Number of trials at the beginning and at the end that the means are taken over: a tenth.
    pub part: usize,
    /// Mean time steps of a trial at the beginning.
    pub first: f64,
    /// Mean time steps of a trial at the end.
    pub last: f64,
}

impl LaterLearning {
    /// Lets the best individual of a state live this many more trials.
    ///
    /// The result depends on the state, the seed and the number only, so a process that was
    /// interrupted computes it again.
    pub(super) fn of<W: World>(
        experiment: &Experiment<W>,
        seed: u64,
        state: &EvolutionState,
        trials: u32,
        gate: &Gate,
    ) -> Result<Option<Self>, Stopped> {
        let Some(best) = state.individuals.first() else {
            return Ok(None);
        };
        let primitives = best.primitives.as_ref().unwrap_or(&state.primitives);
        let mut agent = experiment.agent(best.hierarchy.clone(), primitives.clone());
        let mut rng = stream(seed, state.generation, best.id, Purpose::LaterLearning);
        let limit = experiment.scenario.evolution.trial_step_limit;
        let trials = (0..trials).map(|_| {
            let start = experiment.world.draw_start(&mut rng);
            let trial = agent.run_trial(&start, limit, &mut rng, gate)?;
            Ok(TrialRecord {
                steps: trial.steps,
                delivered: trial.done,
            })
        });
        Ok(Some(Self {
            format: FORMAT,
            generation: state.generation,
            individual: best.id,
            trials: trials.collect::<Result<_, Stopped>>()?,
        }))
    }

    /// Reads it from a run folder; returns `None` if there is none.
    ///
    /// # Errors
    /// When the file is damaged.
    pub fn read(folder: &Path) -> Result<Option<Self>, FileError> {
        read_json(&folder.join(LEARNING), LIMITS)
    }

    /// Writes it to a run folder.
    pub(super) fn write(&self, folder: &Path) -> Result<(), FileError> {
        let path = folder.join(LEARNING);
        let written = serde_json::to_vec(self)
            .map_err(std::io::Error::from)
            .and_then(|bytes| write_atomically(&path, &[bytes.as_slice(), b"\n"].concat()));
        written.map_err(|error| FileError::new(path, error))
    }

    /// Returns the sum of it.
    #[must_use]
    pub fn summary(&self) -> LaterSummary {
        let trials = self.trials.len();
        let part = (trials / 10).max(1).min(trials);
        let mean =
            |trials: &[TrialRecord]| mean_of(trials.iter().map(|trial| f64::from(trial.steps)));
        LaterSummary {
            trials,
            part,
            first: mean(&self.trials[..part]),
            last: mean(&self.trials[trials - part..]),
        }
    }
}
