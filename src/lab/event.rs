//! The stream of facts about a run.

use serde::{Deserialize, Serialize};

use crate::evolution::GenerationRecord;

/// Version of the event format.
pub const EVENT_FORMAT: u32 = 1;

/// A fact about a run. Everything that is shown of a run is a fold over its events.
///
/// *Recorded* events follow from scenario and seed alone. They are the lines of `events.jsonl`,
/// the same bytes for any number of threads, with or without pauses and interruptions. The
/// others describe the process that computes the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event {
    /// Recorded: the run started.
    Started {
        /// Version of the event format.
        format: u32,
        /// Name of the scenario.
        scenario: String,
        /// Seed of the run.
        seed: u64,
    },
    /// Recorded: a generation is done.
    Generation(Box<GenerationRecord>),
    /// Recorded: evolution is over.
    Ended {
        /// Number of generations.
        generations: u64,
        /// Why it ended.
        ending: Ending,
    },
    /// How far the present generation is; coalesced when the reader is slow.
    Progress {
        /// The present generation; 0 while primitive subtasks are trained.
        generation: u64,
        /// Individuals finished, as trials finished divided by trials per individual: all
        /// individuals advance in turns and end together.
        lived: usize,
        /// Individuals in the population.
        population: usize,
        /// Control steps that this process has computed.
        control_steps: u64,
    },
    /// The run was paused.
    Paused,
    /// The run was resumed after a pause.
    Resumed,
    /// `checkpoint.json` was written.
    CheckpointSaved {
        /// The generation that the checkpoint was taken after.
        generation: u64,
    },
}

/// Why an evolution ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// All individuals of the better half have the same structure.
    Converged,
    /// The generation limit was reached.
    GenerationLimit,
    /// The limit of control steps was reached.
    ControlStepLimit,
}

impl Event {
    /// Returns whether the event is a line of `events.jsonl`.
    #[must_use]
    pub fn is_recorded(&self) -> bool {
        matches!(
            self,
            Self::Started { .. } | Self::Generation(_) | Self::Ended { .. }
        )
    }

    /// Returns whether the event may be dropped when the reader is slow.
    #[must_use]
    pub fn is_progress(&self) -> bool {
        matches!(self, Self::Progress { .. })
    }
}
