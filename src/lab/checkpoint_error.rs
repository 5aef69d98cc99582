//! Why a checkpoint cannot be used.

use thiserror::Error;

use crate::files::{FileProblem, JsonError};
use crate::scenario::ScenarioError;

/// Version of the checkpoint format.
pub const CHECKPOINT_FORMAT: u32 = 1;

/// Why a checkpoint cannot be used.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// Its file cannot be read.
    #[error(transparent)]
    Read(#[from] FileProblem),
    /// It is not JSON with the fields of a checkpoint.
    #[error(transparent)]
    Syntax(#[from] JsonError),
    /// It has another format.
    #[error("format: found {found}; allowed: {CHECKPOINT_FORMAT}")]
    Format {
        /// The format found.
        found: u32,
    },
    /// It was changed after it was written.
    #[error(
        "crc32: the state has {actual}, the file says {stated}: the file was changed or damaged"
    )]
    Checksum {
        /// The checksum of the state.
        actual: String,
        /// The checksum in the file.
        stated: String,
    },
    /// Its scenario is not valid.
    #[error("state.scenario: {0}")]
    Scenario(#[from] ScenarioError),
    /// A part does not fit the scenario.
    #[error("{place}: {message}")]
    Misfit {
        /// Where in the file.
        place: String,
        /// What was found and what is allowed.
        message: String,
    },
    /// A learned value is not finite; such a state is not written.
    #[error(
        "{place}: learning has diverged, a learned value is not finite; allowed: settings \
         with a smaller learning rate or smaller initial values"
    )]
    Diverged {
        /// The learner.
        place: String,
    },
}

impl From<CheckpointError> for FileProblem {
    fn from(error: CheckpointError) -> Self {
        match error {
            CheckpointError::Read(problem) => problem,
            error => Self::Wrong(error.to_string()),
        }
    }
}

impl CheckpointError {
    /// Returns the error for the part at `place`; `message` says what was found or is allowed.
    pub(super) fn misfit(place: &str, message: String) -> Self {
        Self::Misfit {
            place: place.to_owned(),
            message,
        }
    }
}
