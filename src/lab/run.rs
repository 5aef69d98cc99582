//! A run: the evolution thread, from start or from a checkpoint to its end.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Instant;

use crossbeam_channel::{Receiver, Sender, bounded};

use super::checkpoint::{Checkpoint, MAX_CHECKPOINT_BYTES};
use super::controls::Controls;
use super::event::{EVENT_FORMAT, Ending, Event};
use super::folder::{FolderError, Keep, RunFolder};
use super::log::{Log, read_events};
use super::manifest::{Invocation, MANIFEST_FORMAT, Manifest};
use super::outcome::{BestIndividual, Outcome};
use super::pulse::Pulse;
use super::recorder::{Message, QUEUE_CAPACITY, Recorder};
use super::run_error::RunError;
use super::worlds::{WorldTask, with_world};
use crate::evolution::{Evolution, Experiment, State, Workers};
use crate::files::{read_text, write_atomically};
use crate::learning::Stopped;
use crate::scenario::{PrimitiveLearning, Scenario};
use crate::worlds::World;

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
    let checkpoint = read_checkpoint(&folder.checkpoint())?;
    if let Some(checkpoint) = &checkpoint {
        checkpoint
            .check_origin(&manifest.scenario, manifest.seed)
            .map_err(|message| {
                let path = folder.manifest().display().to_string();
                FolderError::Manifest { path, message }
            })?;
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
    folder.write_manifest(&manifest)?;
    begin(Preparation {
        scenario,
        seed: manifest.seed,
        place: Place::Open(folder),
        workers,
        keep: options.keep,
        checkpoint,
    })
}

fn workers(scenario: &Scenario, options: &RunOptions) -> Result<Workers, RunError> {
    let threads = match scenario.learning.primitive_learning {
        PrimitiveLearning::Frozen => options.threads,
        // All individuals teach one copy, in turn.
        PrimitiveLearning::Shared => 1,
    };
    Workers::new(threads).map_err(|error| RunError::Threads(error.to_string()))
}

fn read_checkpoint(path: &Path) -> Result<Option<Checkpoint>, RunError> {
    if !path.exists() {
        return Ok(None);
    }
    let file = path.display().to_string();
    let text = read_text(path, MAX_CHECKPOINT_BYTES).map_err(|source| RunError::Read {
        file: file.clone(),
        source,
    })?;
    let checkpoint = Checkpoint::from_text(&text);
    checkpoint
        .map(Some)
        .map_err(|source| RunError::Checkpoint { file, source })
}

/// Where a run is kept.
enum Place {
    /// In a folder that is made when the scenario has proved usable.
    New {
        path: PathBuf,
        manifest: Box<Manifest>,
        force: bool,
    },
    /// In an existing run folder.
    Open(RunFolder),
}

impl Place {
    fn folder(self) -> Result<RunFolder, FolderError> {
        match self {
            Self::New {
                path,
                manifest,
                force,
            } => RunFolder::create(&path, &manifest, force),
            Self::Open(folder) => Ok(folder),
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

fn begin(preparation: Preparation) -> Result<Run, RunError> {
    with_world(preparation.scenario.clone(), preparation)?
}

impl WorldTask for Preparation {
    type Output = Result<Run, RunError>;

    /// Reads everything that can be wrong, then starts the evolution thread.
    fn carry_out<W: World + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        let (controls, events) = Controls::new();
        let folder = self.place.folder()?;
        let path = folder.path().to_owned();
        let in_file = |name: &str| path.join(name).display().to_string();
        let state = self
            .checkpoint
            .as_ref()
            .map(|checkpoint| checkpoint.state(&experiment));
        let state = state.transpose().map_err(|source| RunError::Checkpoint {
            file: in_file("checkpoint.json"),
            source,
        })?;
        let in_log = |source| RunError::Log {
            file: in_file("events.jsonl"),
            source,
        };
        let file = folder.events();
        let (log, past) = match &self.checkpoint {
            Some(checkpoint) => {
                let log = Log::reopen(&file, checkpoint.events).map_err(in_log)?;
                (log, read_events(&file).map_err(in_log)?)
            }
            None => (
                Log::create(&file).map_err(|error| in_log(error.into()))?,
                Vec::new(),
            ),
        };
        let (scenario, seed) = (self.scenario, self.seed);
        let work = Work {
            experiment,
            seed,
            folder,
            workers: self.workers,
            keep: self.keep,
            controls: controls.clone(),
            state,
        };
        let thread = thread::Builder::new()
            .name(String::from("evolution"))
            .spawn(move || work.run(log, past))
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
}

/// What the evolution thread owns.
struct Work<W: World> {
    experiment: Experiment<W>,
    seed: u64,
    folder: RunFolder,
    workers: Workers,
    keep: Keep,
    controls: Controls,
    state: Option<State>,
}

/// How far evolution came.
struct Progress {
    generations: u64,
    converged: bool,
    control_steps: u64,
    best: Option<BestIndividual>,
    over: bool,
}

/// Closes the stream of events however the thread ends.
struct Closing<'c>(&'c Controls);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.close();
    }
}

impl<W: World> Work<W> {
    fn run(self, log: Log, past: Vec<Event>) -> Result<Outcome, RunError> {
        let started = Instant::now();
        let _closing = Closing(&self.controls);
        let _pulse = Pulse::start(self.folder.path(), &self.controls);
        let (sender, messages) = bounded(QUEUE_CAPACITY);
        let requests = self.controls.requests();
        let recorder = Recorder {
            experiment: &self.experiment,
            seed: self.seed,
            folder: &self.folder,
            keep: self.keep,
            log,
            controls: &self.controls,
        };
        let (progress, recorded) = thread::scope(|scope| {
            let recording = scope.spawn(move || recorder.run(&messages, &requests));
            let progress = self.evolve(past, sender);
            (progress, recording.join())
        });
        let folder = self.folder.path().display().to_string();
        recorded
            .map_err(|_| RunError::Panicked)?
            .map_err(|source| RunError::Record {
                folder: folder.clone(),
                source,
            })?;
        let outcome = Outcome {
            scenario: self.experiment.scenario.name.clone(),
            seed: self.seed,
            generations: progress.generations,
            converged: progress.converged,
            stopped: !progress.over,
            best: progress.best,
            control_steps: progress.control_steps,
            wall_seconds: started.elapsed().as_secs_f64(),
            run_dir: folder.clone(),
        };
        if progress.over {
            let written = serde_json::to_vec_pretty(&outcome)
                .map_err(std::io::Error::from)
                .and_then(|bytes| write_atomically(&self.folder.summary(), &bytes));
            written.map_err(|error| RunError::Record {
                folder,
                source: error.into(),
            })?;
        }
        Ok(outcome)
    }

    /// The loop of Algorithm 3.1. Ends early when the run is stopped or the recorder
    /// has failed and gone.
    fn evolve(&self, past: Vec<Event>, recorder: Sender<Message>) -> Progress {
        let mut progress = Progress {
            generations: 0,
            converged: false,
            control_steps: 0,
            best: None,
            over: false,
        };
        for event in past {
            if let Event::Generation(record) = &event {
                progress.best = BestIndividual::of(record);
            }
            self.controls.tell(event);
        }
        // An error means that the run was stopped; the progress so far says how far it came.
        let _stopped = self.evolve_on(&mut progress, &recorder);
        progress
    }

    fn evolve_on(
        &self,
        progress: &mut Progress,
        recorder: &Sender<Message>,
    ) -> Result<(), Stopped> {
        let (seed, workers) = (self.seed, &self.workers);
        let scenario = &self.experiment.scenario;
        let controls = &self.controls;
        let population = scenario.evolution.population_size;
        let show = |generation, lived| {
            controls.tell(Event::Progress {
                generation,
                lived,
                population,
                control_steps: controls.control_steps(),
            });
        };
        let mut evolution = match self.state.clone() {
            Some(state) => {
                Evolution::resume(&self.experiment, workers, seed, state, controls.gate())?
            }
            None => {
                let started = Event::Started {
                    format: EVENT_FORMAT,
                    scenario: scenario.name.clone(),
                    seed,
                };
                self.fact(started, recorder)?;
                show(0, 0);
                Evolution::begin(&self.experiment, workers, seed, controls.gate())?
            }
        };
        // A resumed run too: its limit may be new, and the process before may have died
        // between saving this state and keeping it.
        self.keep(&evolution, recorder)?;
        progress.note(evolution.state());
        while !evolution.is_over() {
            controls.gate().pass(0)?;
            let generation = evolution.state().generation + 1;
            show(generation, 0);
            let record = evolution.step(controls.gate(), |lived| show(generation, lived))?;
            progress.best = BestIndividual::of(&record);
            progress.note(evolution.state());
            self.fact(Event::Generation(Box::new(record)), recorder)?;
            self.keep(&evolution, recorder)?;
            controls.generation_over();
        }
        let ending = match progress.converged {
            true => Ending::Converged,
            false => Ending::GenerationLimit,
        };
        let generations = progress.generations;
        self.fact(
            Event::Ended {
                generations,
                ending,
            },
            recorder,
        )?;
        progress.over = true;
        Ok(())
    }

    /// Records an event and tells it.
    fn fact(&self, event: Event, recorder: &Sender<Message>) -> Result<(), Stopped> {
        let message = Message::Event(Box::new(event.clone()));
        recorder.send(message).map_err(|_| Stopped)?;
        self.controls.tell(event);
        Ok(())
    }

    fn keep(
        &self,
        evolution: &Evolution<'_, W>,
        recorder: &Sender<Message>,
    ) -> Result<(), Stopped> {
        let state = Message::State(Arc::clone(evolution.state()));
        recorder.send(state).map_err(|_| Stopped)
    }
}

impl Progress {
    fn note(&mut self, state: &State) {
        self.generations = state.generation;
        self.converged = state.converged;
        self.control_steps = state.control_steps;
    }
}
