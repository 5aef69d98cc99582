//! A run: from a scenario or a checkpoint to a running evolution thread.

use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};

use crossbeam_channel::Receiver;

use super::checkpoint::Checkpoint;
use super::controls::Controls;
use super::event::Event;
use super::folder::{Keep, RunFolder};
use super::folder_error::FolderError;
use super::log::{Log, read_events};
use super::manifest::{Invocation, MANIFEST_FORMAT, Manifest};
use super::outcome::Outcome;
use super::run_error::RunError;
use super::work::Work;
use super::world_experiment::experiment;
use crate::evolution::Workers;
use crate::files::FileError;
use crate::scenario::{PrimitiveLearning, Scenario};

/// How a run is carried out; nothing here changes its result.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Computing threads; 0 means one for each processor.
    pub threads: usize,
    /// Which generations' checkpoints are kept.
    pub keep: Keep,
    /// Whether an existing run may be replaced.
    pub force: bool,
}

/// A run under way.
#[derive(Debug)]
pub struct Run {
    /// Its events, from its very first on.
    pub events: Receiver<Event>,
    /// Commands to it.
    pub controls: Controls,
    /// Its scenario.
    pub scenario: Scenario,
    /// Its seed.
    pub seed: u64,
    /// Its folder.
    pub folder: PathBuf,
    thread: JoinHandle<Result<Outcome, RunError>>,
}

impl Run {
    /// Waits for the end and returns the result. Events that nobody has taken are
    /// given up.
    ///
    /// # Errors
    /// When the run could not be recorded.
    pub fn join(self) -> Result<Outcome, RunError> {
        drop(self.events);
        self.thread.join().unwrap_or(Err(RunError::Panicked))
    }
}

/// Starts a run in a new folder.
///
/// # Errors
/// When the scenario cannot be made ready or the folder cannot be made.
pub fn start(
    scenario: Scenario,
    seed: u64,
    path: &Path,
    options: &RunOptions,
) -> Result<Run, RunError> {
    let workers = workers(&scenario, options)?;
    let manifest = Manifest {
        format: MANIFEST_FORMAT,
        scenario: scenario.clone(),
        seed,
        started: Invocation::now(workers.threads()),
        resumed: Vec::new(),
    };
    let place = Place::New {
        path: path.to_owned(),
        manifest: Box::new(manifest),
        force: options.force,
    };
    begin(Preparation {
        scenario,
        seed,
        place,
        workers,
        keep: options.keep,
        checkpoint: None,
    })
}

/// Goes on with the run in `path`, from its checkpoint, or from its start where it has
/// none; to another generation limit if one is given.
///
/// # Errors
/// When the folder holds no usable run, or another process works on it.
pub fn resume(
    path: &Path,
    generations: Option<u64>,
    options: &RunOptions,
) -> Result<Run, RunError> {
    let folder = RunFolder::open(path)?;
    let mut manifest = RunFolder::read_manifest(path)?;
    let file = folder.checkpoint();
    let checkpoint = Checkpoint::read(&file).map_err(|error| FileError::new(&file, error))?;
    if let Some(checkpoint) = &checkpoint {
        checkpoint
            .check_origin(&manifest.scenario, manifest.seed)
            .map_err(|message| FolderError::from(FileError::new(folder.manifest(), message)))?;
    }
    // The limit is that of run.json: a run that dies before its first checkpoint with a
    // new limit must not forget it.
    if let Some(limit) = generations {
        let lived = checkpoint
            .as_ref()
            .map_or(1, |checkpoint| checkpoint.generation.max(1));
        if !(lived..=100_000).contains(&limit) {
            return Err(RunError::Generations {
                found: limit,
                lived,
            });
        }
        manifest.scenario.evolution.generation_limit = limit;
    }
    let scenario = manifest.scenario.clone();
    let workers = workers(&scenario, options)?;
    manifest.resumed.push(Invocation::now(workers.threads()));
    begin(Preparation {
        scenario,
        seed: manifest.seed,
        place: Place::Open {
            folder,
            manifest: Box::new(manifest),
        },
        workers,
        keep: options.keep,
        checkpoint,
    })
}

fn workers(scenario: &Scenario, options: &RunOptions) -> Result<Workers, RunError> {
    let threads = match scenario.learning.primitive_learning {
        PrimitiveLearning::Frozen | PrimitiveLearning::Individual => options.threads,
        // All individuals teach one copy, in turn.
        PrimitiveLearning::Shared => 1,
    };
    Workers::new(threads).map_err(|error| RunError::Threads(error.to_string()))
}

/// Where a run is kept.
enum Place {
    /// In a folder that is made when the scenario has proved usable.
    New {
        path: PathBuf,
        manifest: Box<Manifest>,
        force: bool,
    },
    /// In an existing run folder, whose manifest changes when all has proved usable.
    Open {
        folder: RunFolder,
        manifest: Box<Manifest>,
    },
}

impl Place {
    /// The folder, and what is to become of its manifest.
    fn folder(self) -> Result<(RunFolder, Option<Box<Manifest>>), FolderError> {
        match self {
            Self::New {
                path,
                manifest,
                force,
            } => RunFolder::create(&path, &manifest, force).map(|folder| (folder, None)),
            Self::Open { folder, manifest } => Ok((folder, Some(manifest))),
        }
    }
}

/// A run that is ready to begin.
struct Preparation {
    scenario: Scenario,
    seed: u64,
    place: Place,
    workers: Workers,
    keep: Keep,
    checkpoint: Option<Checkpoint>,
}

/// Reads everything that can be wrong, then starts the evolution thread.
fn begin(preparation: Preparation) -> Result<Run, RunError> {
    let Preparation {
        scenario,
        seed,
        place,
        workers,
        keep,
        checkpoint,
    } = preparation;
    let experiment = experiment(scenario.clone(), seed)?;
    let (controls, events) = Controls::new();
    let (folder, manifest) = place.folder()?;
    let path = folder.path().to_owned();
    let state = checkpoint
        .as_ref()
        .map(|checkpoint| experiment.population(checkpoint));
    let state = state
        .transpose()
        .map_err(|error| FileError::new(folder.checkpoint(), error))?;
    let file = folder.events();
    let (log, past) = match &checkpoint {
        Some(checkpoint) => {
            let log = Log::reopen(&file, checkpoint.events);
            let log = log.map_err(|error| FileError::new(&file, error))?;
            (log, read_events(&file)?)
        }
        None => (
            Log::create(&file).map_err(|error| FileError::new(&file, error))?,
            Vec::new(),
        ),
    };
    // Written last: a refused resume leaves no trace.
    if let Some(manifest) = manifest {
        folder.write_manifest(&manifest)?;
    }
    let work = Work {
        folder,
        workers,
        keep,
        controls: controls.clone(),
        state,
        log,
        past,
    };
    let thread = thread::Builder::new()
        .name(String::from("evolution"))
        .spawn(move || experiment.run(work))
        .map_err(|error| RunError::Threads(error.to_string()))?;
    Ok(Run {
        events,
        controls,
        scenario,
        seed,
        folder: path,
        thread,
    })
}
