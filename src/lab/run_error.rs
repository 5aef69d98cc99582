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
    /// Its first hierarchies cannot be used.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
}

/// Why a run cannot begin, or had to end.
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
    /// The limit of a resumed run is not above what it has lived.
    #[error("--generations: found {found}; allowed: {lived} (the generations lived) to 100000")]
    Generations {
        /// The limit asked for.
        found: u64,
        /// Generations lived.
        lived: u64,
    },
    /// The operating system gives no threads.
    #[error("cannot start threads: {0}")]
    Threads(String),
    /// A thread panicked: a defect of this program.
    #[error("a thread of the run panicked; this is a defect of maxq-lab, please report it")]
    Panicked,
}
