//! One run: the evolution thread, its events and commands, the run folder,
//! checkpoint and resume; the evaluation of single structures; taking individuals apart.

mod checkpoint;
mod checkpoint_error;
mod controls;
mod difference;
mod evaluate;
mod event;
mod folder;
mod folder_error;
mod follower;
mod learn;
mod learner;
mod log;
mod manifest;
mod mean;
mod outcome;
mod population_file;
mod pulse;
mod recorder;
mod run;
mod run_error;
pub mod specimen;
mod value_grid;
mod watch;
mod work;
mod worlds;

pub use checkpoint::{Checkpoint, LogPosition};
pub use checkpoint_error::CheckpointError;
pub use controls::{Activity, Controls};
pub use difference::{Difference, departures, differences, in_words, with_changes};
pub use evaluate::{Evaluation, Protocol, Repeat, Scored, evaluate};
pub use event::{Ending, Event};
pub use folder::{Keep, RunFolder};
pub use folder_error::{FolderError, Occupied};
pub use follower::Follower;
pub use learn::{
    Algorithm, Course, GivenPolicy, LearnCheck, LearnError, LearnProtocol, Learned, learn,
};
pub use log::{LogError, read_events};
pub use manifest::{Invocation, Manifest, shell_word};
pub use mean::{Mean, mean};
pub use outcome::{BestIndividual, Outcome};
pub use run::{Run, RunOptions, resume, start};
pub use run_error::RunError;
pub use value_grid::{ValueGrid, value_grids};
pub use watch::{Life, News, Recording, Watch};
pub use worlds::{SetupError, WorldTask, with_world};
