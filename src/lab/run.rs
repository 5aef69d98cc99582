//! Starts and resumes runs.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};

use crossbeam_channel::Receiver;

use super::checkpoint::Checkpoint;
use super::controls::Controls;
use super::event::Event;
use super::experiment::AnyExperiment;
use super::folder::RunFolder;
use super::folder_error::FolderError;
use super::keep::Keep;
use super::kept::{go_back, kept_generations, ranges, with_way_out};
use super::log::{Log, LogError, read_events};
use super::manifest::{Invocation, MANIFEST_FORMAT, Manifest};
use super::outcome::Outcome;
use super::run_error::RunError;
use super::work::Work;
use super::world_experiment::experiment;
use crate::evolution::{Workers, processors};
use crate::files::{ByteCount, FileError};
use crate::scenario::{PrimitiveLearning, Scenario};

/// How a run is computed and recorded. No option changes its result.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Computing threads; 0 means one for each processor.
    pub threads: usize,
    /// The generations whose checkpoints are kept; `None` means as when the run was started, and
    /// [`Keep::Thinned`] in a new run.
    pub keep: Option<Keep>,
    /// Whether an existing run in the folder is replaced.
    pub force: bool,
}

/// A run that this process computes.
#[derive(Debug)]
pub struct Run {
    /// Its events, including those before it was resumed.
    pub events: Receiver<Event>,
    /// The commands to it.
    pub controls: Controls,
    /// Its scenario.
    pub scenario: Scenario,
    /// What is odd about the scenario or the folder, each with its place.
    pub warnings: Vec<String>,
    /// What a user should know of how it was started or resumed.
    pub notes: Vec<String>,
    /// Its seed.
    pub seed: u64,
    /// Its folder.
    pub folder: PathBuf,
    thread: JoinHandle<Result<Outcome, RunError>>,
}

impl Run {
    /// Waits for the end and returns the result. Unread events are dropped.
    ///
    /// # Errors
    /// When the run cannot be recorded.
    pub fn join(self) -> Result<Outcome, RunError> {
        drop(self.events);
        self.thread.join().unwrap_or(Err(RunError::Panicked))
    }
}

/// Starts a run in a new folder.
///
/// # Examples
/// ```
/// use maxq_lab::lab::{RunOptions, start};
/// use maxq_lab::scenario::Scenario;
///
/// let settings = ["evolution.trials_per_generation=4", "evolution.generation_limit=2"];
/// let scenario = Scenario::load("cliff")?.with_settings(&settings.map(String::from))?;
/// let parent = tempfile::tempdir()?;
/// let run = start(scenario, 1, &parent.path().join("run"), &RunOptions::default())?;
/// let outcome = run.join()?;
/// assert_eq!(outcome.generations, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the scenario cannot be made ready or the folder cannot be created.
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
        keep: options.keep.filter(|&keep| keep != Keep::default()),
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
        keep: options.keep.unwrap_or_default(),
        from: None,
    })
}

/// Resumes the run in `path` from its checkpoint, or from its start if it has none. `generations`
/// sets another generation limit.
///
/// # Errors
/// When the folder holds no usable run, or another process works on it.
pub fn resume(
    path: &Path,
    generations: Option<u64>,
    options: &RunOptions,
) -> Result<Run, RunError> {
    resume_from(path, None, generations, options)
}

/// Resumes the run in `path` from the kept state after generation `at`: what came later is dropped
/// and computed again. Otherwise as [`resume`].
///
/// # Errors
/// When the state is not kept or is damaged, and as [`resume`].
pub fn resume_at(
    path: &Path,
    at: u64,
    generations: Option<u64>,
    options: &RunOptions,
) -> Result<Run, RunError> {
    resume_from(path, Some(at), generations, options)
}

fn resume_from(
    path: &Path,
    at: Option<u64>,
    generations: Option<u64>,
    options: &RunOptions,
) -> Result<Run, RunError> {
    let folder = RunFolder::open(path)?;
    let mut manifest = RunFolder::read_manifest(path)?;
    let file = at.map_or_else(|| folder.checkpoint(), |at| folder.generation(at));
    let checkpoint = Checkpoint::read(&file)
        .map_err(|error| with_way_out(path, &manifest, FileError::new(&file, error)))?;
    if let (Some(found), None) = (at, &checkpoint) {
        let kept = ranges(&kept_generations(path));
        return Err(RunError::At { found, kept });
    }
    if let Some(checkpoint) = &checkpoint {
        let origin = checkpoint.check_origin(&manifest.scenario, manifest.seed);
        origin.map_err(|message| match at {
            None => FileError::new(folder.manifest(), message),
            Some(_) => FileError::new(&file, format!("is not of this run: {message}")),
        })?;
    }
    // The limit is written to run.json, so that it survives a crash before the next checkpoint.
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
    manifest.keep = options.keep.or(manifest.keep);
    let keep = manifest.keep.unwrap_or_default();
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
        keep,
        from: checkpoint.map(|checkpoint| Saved {
            checkpoint,
            file,
            at,
        }),
    })
}

fn workers(scenario: &Scenario, options: &RunOptions) -> Result<Workers, RunError> {
    let wanted = NonZeroUsize::new(options.threads).unwrap_or_else(processors);
    let threads = match scenario.learning.primitive_learning {
        // More threads than individuals would have nothing to do.
        PrimitiveLearning::Frozen | PrimitiveLearning::Individual => {
            wanted.get().min(scenario.evolution.population_size)
        }
        // All individuals train one shared copy, one after the other.
        PrimitiveLearning::Shared => 1,
    };
    Workers::new(threads).map_err(|error| RunError::Threads(error.to_string()))
}

/// Where a run is recorded.
enum Place {
    /// In a folder that is created after the scenario was found usable.
    New {
        path: PathBuf,
        manifest: Box<Manifest>,
        force: bool,
    },
    /// In an existing run folder, whose manifest is written after everything was found usable.
    Open {
        folder: RunFolder,
        manifest: Box<Manifest>,
    },
}

impl Place {
    /// Returns the folder, and the manifest that has yet to be written.
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

/// What a run starts with.
struct Preparation {
    scenario: Scenario,
    seed: u64,
    place: Place,
    workers: Workers,
    keep: Keep,
    /// What a resumed run starts from.
    from: Option<Saved>,
}

/// A saved state from which a run is resumed.
struct Saved {
    checkpoint: Checkpoint,
    file: PathBuf,
    /// Its generation, if it is a kept one that was asked for.
    at: Option<u64>,
}

/// Checks everything that can be wrong, then starts the evolution thread.
fn begin(preparation: Preparation) -> Result<Run, RunError> {
    let Preparation {
        scenario,
        seed,
        place,
        workers,
        keep,
        from,
    } = preparation;
    let experiment = experiment(scenario.clone(), seed)?;
    let odd = experiment.warnings().into_iter();
    let mut warnings: Vec<_> = odd.map(|odd| format!("{}: {odd}", scenario.name)).collect();
    let cost = (keep == Keep::All).then(|| cost(&*experiment));
    let (controls, events) = Controls::new();
    let (folder, manifest) = place.folder()?;
    let path = folder.path().to_owned();
    let of_folder = folder.warning();
    warnings.extend(of_folder.map(|odd| format!("{}: {odd}", path.display())));
    let way_out = |error: FileError| match &manifest {
        Some(manifest) => with_way_out(&path, manifest, error),
        None => error,
    };
    let (state, dropped) = match &from {
        Some(saved) => {
            let state = experiment.population(&saved.checkpoint);
            let state = state.map_err(|error| way_out(FileError::new(&saved.file, error)))?;
            (Some(state), saved.go_back(&folder).map_err(&way_out)?)
        }
        None => (None, None),
    };
    let (log, past) = open_log(&folder, from.as_ref()).map_err(&way_out)?;
    // Written last, so that a refused resume changes nothing.
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
    let notes = dropped.map(|dropped| format!("{}: {dropped}", path.display()));
    let notes = notes.into_iter().chain(cost);
    Ok(Run {
        events,
        controls,
        scenario,
        warnings,
        notes: notes.collect(),
        seed,
        folder: path,
        thread,
    })
}

/// Tells what keeping all generations costs.
fn cost(experiment: &dyn AnyExperiment) -> String {
    let generations = experiment.scenario().evolution.generation_limit;
    let bytes = experiment.state_bytes();
    format!(
        "keeping all generations takes about {} for {generations} generations, {} each; more if \
         hierarchies grow",
        ByteCount(bytes.saturating_mul(generations)),
        ByteCount(bytes)
    )
}

/// Opens the log of a run for its next event, and returns the events so far.
fn open_log(folder: &RunFolder, from: Option<&Saved>) -> Result<(Log, Vec<Event>), FileError> {
    let file = folder.events();
    let log = match from {
        Some(saved) => Log::reopen(&file, saved.checkpoint.events),
        None => Log::create(&file).map_err(LogError::from),
    };
    let log = log.map_err(|error| FileError::new(&file, error))?;
    let past = match from {
        Some(_) => read_events(&file)?,
        None => Vec::new(),
    };
    Ok((log, past))
}

impl Saved {
    /// Drops what came after a state that was asked for; returns what was dropped, in words.
    fn go_back(&self, folder: &RunFolder) -> Result<Option<String>, FileError> {
        let position = self.checkpoint.events;
        let dropped = self.at.map(|at| go_back(folder, at, position));
        dropped.transpose()
    }
}
