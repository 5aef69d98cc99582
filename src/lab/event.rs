//! The stream of facts about a run.

use serde::{Deserialize, Serialize};

use crate::evolution::GenerationRecord;

/// Version of the event format.
pub const EVENT_FORMAT: u32 = 1;

/// A fact about a run. Everything that a person sees of a run is a fold over these.
///
/// *Recorded* facts follow from scenario and seed alone: they are the lines of
/// `events.jsonl`, the same bytes for any number of threads, paused or not, broken off
/// and resumed or not. The others tell how this process is getting on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum Event {
    /// Recorded: the run began.
    Started {
        /// Version of the event format.
        format: u32,
        /// Name of the scenario.
        scenario: String,
        /// Seed of the run.
        seed: u64,
    },
    /// Recorded: a generation has lived.
    Generation(Box<GenerationRecord>),
    /// Recorded: evolution is over.
    Ended {
        /// Generations lived.
        generations: u64,
        /// Why it is over.
        ending: Ending,
    },
    /// How far the generation under way is; coalesced when the reader is slow.
    Progress {
        /// The generation under way; 0 while primitive subtasks are trained.
        generation: u64,
        /// Lives lived, of all individuals together: they come to their ends at the same
        /// time, so that no thread waits.
        lived: usize,
        /// Individuals in the population.
        population: usize,
        /// Control steps computed by this process so far.
        control_steps: u64,
    },
    /// The run waits.
    Paused,
    /// The run goes on.
    Resumed,
    /// A checkpoint is on disk.
    CheckpointSaved {
        /// The generation it was taken after.
        generation: u64,
    },
}

/// Why an evolution is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The better half of the population has one structure.
    Converged,
    /// The generation limit is reached.
    GenerationLimit,
}

impl Event {
    /// Whether the fact is a line of `events.jsonl`.
    #[must_use]
    pub fn is_recorded(&self) -> bool {
        matches!(
            self,
            Self::Started { .. } | Self::Generation(_) | Self::Ended { .. }
        )
    }

    /// Whether the fact may be left out when the reader is slow.
    #[must_use]
    pub fn is_progress(&self) -> bool {
        matches!(self, Self::Progress { .. })
    }
}
