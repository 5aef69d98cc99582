//! One run: the evolution thread, its events and commands, the run folder,
//! checkpoint and resume; the evaluation of single structures; taking individuals apart.

mod checkpoint;
mod checkpoint_error;
mod controls;
mod evaluate;
mod event;
mod folder;
mod follower;
mod log;
mod manifest;
mod outcome;
mod population_file;
mod pulse;
mod recorder;
mod run;
mod run_error;
pub mod specimen;
mod watch;
mod work;
mod worlds;

pub use checkpoint::{Checkpoint, LogPosition};
pub use checkpoint_error::CheckpointError;
pub use controls::{Activity, Controls};
pub use evaluate::{Evaluation, Protocol, Repeat, evaluate};
pub use event::{Ending, Event};
pub use folder::{FolderError, Keep, RunFolder};
pub use log::{LogError, read_events};
pub use manifest::{Invocation, Manifest};
pub use outcome::{BestIndividual, Outcome};
pub use run::{Run, RunOptions, resume, start};
pub use run_error::RunError;
pub use watch::{Life, News, Recording, Watch};
pub use worlds::{SetupError, WorldTask, with_world};
