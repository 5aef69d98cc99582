//! What can go wrong with a run.

use thiserror::Error;

use super::folder_error::FolderError;
use crate::evolution::ExperimentError;
use crate::files::FileError;
use crate::rules::Problem;

/// Why a scenario cannot be made ready.
#[derive(Debug, Error)]
pub enum SetupError {
    /// Its world cannot be built.
    #[error("{0}")]
    World(Problem),
    /// A hierarchy of its initial population cannot be used.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
}

/// Why a run cannot start, or ended early.
#[derive(Debug, Error)]
pub enum RunError {
    /// The scenario cannot be made ready.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The run folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A file of the run cannot be read or written, or is not what it should be.
    #[error(transparent)]
    File(#[from] FileError),
    /// The new generation limit of a resumed run is below the generations that it has.
    #[error("--generations: found {found}; allowed: {lived} (the generations so far) to 100000")]
    Generations {
        /// The new limit.
        found: u64,
        /// Generations that the run has.
        lived: u64,
    },
    /// The state that a run was to be resumed from is not kept.
    #[error(
        "--at: found {found}; allowed: a generation whose state is kept in generations/ ({kept})"
    )]
    At {
        /// The generation asked for.
        found: u64,
        /// The kept generations, in words.
        kept: String,
    },
    /// The operating system refuses to start a thread.
    #[error("cannot start threads: {0}")]
    Threads(String),
    /// A thread panicked, which is a defect of this program.
    #[error("a thread of the run panicked; this is a defect of maxq-lab, please report it")]
    Panicked,
}
