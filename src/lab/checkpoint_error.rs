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
    /// It is not the JSON of a checkpoint.
    #[error(transparent)]
    Syntax(#[from] JsonError),
    /// It was written by another version of the program.
    #[error("format: found {found}; allowed: {CHECKPOINT_FORMAT}")]
    Format {
        /// The format found.
        found: u32,
    },
    /// Something was changed after it was written.
    #[error(
        "crc32: the state has {actual}, the file says {stated}: the file was changed or damaged"
    )]
    Checksum {
        /// Of the state as it is.
        actual: String,
        /// As the file states it.
        stated: String,
    },
    /// Its scenario is not valid.
    #[error("state.scenario: {0}")]
    Scenario(#[from] ScenarioError),
    /// A part of it does not fit its scenario.
    #[error("{place}: {message}")]
    Misfit {
        /// Where in the file.
        place: String,
        /// What was found and what is allowed.
        message: String,
    },
    /// A learned value is not a number; such a state is not written.
    #[error(
        "{place}: learning has diverged, a learned value is not finite; allowed: settings \
         with a smaller learning rate or smaller initial values"
    )]
    Diverged {
        /// What has learned it.
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
    /// A part of a checkpoint that does not fit: its place, what was found, what is allowed.
    pub(super) fn misfit(place: &str, message: String) -> Self {
        Self::Misfit {
            place: place.to_owned(),
            message,
        }
    }
}
