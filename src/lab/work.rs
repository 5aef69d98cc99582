//! The evolution thread of a run: the loop of Thesis Algorithm 3.1 with its events and commands.

use std::sync::Arc;
use std::thread;
use std::time::Instant;

use crossbeam_channel::{Sender, bounded};

use super::controls::Controls;
use super::event::{EVENT_FORMAT, Ending, Event};
use super::folder::RunFolder;
use super::keep::Keep;
use super::last_sign::ErrorPlace;
use super::later::LaterLearning;
use super::log::Log;
use super::outcome::{BestIndividual, Outcome};
use super::pulse::Pulse;
use super::recorder::{Message, QUEUE_CAPACITY, RecordError, Recorder};
use super::run_error::RunError;
use crate::evolution::{Evolution, EvolutionState, Experiment, Workers};
use crate::files::{FileError, write_atomically};
use crate::learning::Stopped;
use crate::scenario::Then;
use crate::worlds::World;

/// What the evolution thread needs besides the experiment.
#[derive(Debug)]
pub struct Work {
    pub(super) folder: RunFolder,
    pub(super) workers: Workers,
    pub(super) keep: Keep,
    pub(super) controls: Controls,
    pub(super) log: Log,
    /// The state and the events of a resumed run.
    pub(super) state: Option<EvolutionState>,
    pub(super) past: Vec<Event>,
}

/// A run in a world whose type is known.
struct WorldRun<'w, W: World> {
    experiment: &'w Experiment<W>,
    seed: u64,
    folder: &'w RunFolder,
    workers: &'w Workers,
    controls: &'w Controls,
    state: Option<EvolutionState>,
}

/// How far evolution got.
struct Progress {
    generations: u64,
    converged: bool,
    control_steps: u64,
    best: Option<BestIndividual>,
    learning: Option<LaterLearning>,
    over: bool,
}

/// Closes the feed when it is dropped, even if the thread panics.
struct Closing<'c>(&'c Controls);

impl Drop for Closing<'_> {
    fn drop(&mut self) {
        self.0.feed().close();
    }
}

impl Work {
    /// Does the work. An error is left in the run folder too.
    pub(super) fn run<W: World>(
        mut self,
        experiment: &Experiment<W>,
        seed: u64,
    ) -> Result<Outcome, RunError> {
        let controls = self.controls.clone();
        let _closing = Closing(&controls);
        let _pulse = Pulse::start(self.folder.path(), &controls);
        let mut place = ErrorPlace::reserve(self.folder.path());
        let done = self.record(experiment, seed);
        if let Err(error) = &done {
            place.write(error);
        }
        done
    }

    /// Evolves and records.
    fn record<W: World>(
        &mut self,
        experiment: &Experiment<W>,
        seed: u64,
    ) -> Result<Outcome, RunError> {
        let started = Instant::now();
        let controls = &self.controls;
        let (sender, messages) = bounded(QUEUE_CAPACITY);
        let requests = controls.checkpoint_requests();
        let recorder = Recorder {
            scenario: &experiment.scenario,
            catalogue: experiment.catalogue(),
            seed,
            folder: &self.folder,
            keep: self.keep,
            log: &mut self.log,
            controls,
        };
        let run = WorldRun {
            experiment,
            seed,
            folder: &self.folder,
            workers: &self.workers,
            controls,
            state: self.state.take(),
        };
        let past = std::mem::take(&mut self.past);
        let (progress, recorded) = thread::scope(|scope| {
            let recording = scope.spawn(move || recorder.run(&messages, &requests));
            let progress = run.evolve(past, sender);
            (progress, recording.join())
        });
        let folder = self.folder.path().display().to_string();
        recorded
            .map_err(|_| RunError::Panicked)?
            .map_err(|error| FileError::new(&folder, error))?;
        let outcome = Outcome {
            scenario: experiment.scenario.name.clone(),
            seed,
            generations: progress.generations,
            converged: progress.converged,
            stopped: !progress.over,
            best: progress.best,
            later: progress.learning.as_ref().map(LaterLearning::summary),
            control_steps: progress.control_steps,
            wall_seconds: started.elapsed().as_secs_f64(),
            run_dir: folder.clone(),
        };
        if let Some(learning) = &progress.learning {
            learning.write(self.folder.path())?;
        }
        // Resuming a run that was over keeps the wall-clock time in its summary.
        if progress.over && !has_summary(&self.folder, &outcome) {
            let written = serde_json::to_vec_pretty(&outcome)
                .map_err(std::io::Error::from)
                .and_then(|bytes| write_atomically(&self.folder.summary(), &bytes));
            written.map_err(|error| FileError::new(&folder, RecordError::Io(error)))?;
        }
        Ok(outcome)
    }
}

impl<W: World> WorldRun<'_, W> {
    /// Evolves to the end, or until the run is stopped or the recorder has failed.
    fn evolve(&self, past: Vec<Event>, recorder: Sender<Message>) -> Progress {
        let mut progress = Progress {
            generations: 0,
            converged: false,
            control_steps: 0,
            best: None,
            learning: None,
            over: false,
        };
        for event in past {
            if let Event::Generation(record) = &event {
                progress.best = BestIndividual::of(record);
            }
            self.controls.feed().send(event);
        }
        // After an early end, `progress` says how far evolution got.
        let _stopped = self.advance(&mut progress, &recorder);
        progress
    }

    fn advance(&self, progress: &mut Progress, recorder: &Sender<Message>) -> Result<(), Stopped> {
        let (seed, workers) = (self.seed, self.workers);
        let scenario = &self.experiment.scenario;
        let controls = self.controls;
        let population = scenario.evolution.population_size;
        let show = |generation, lived| {
            controls.feed().send(Event::Progress {
                generation,
                lived,
                population,
                control_steps: controls.control_steps(),
            });
        };
        if !self
            .state
            .as_ref()
            .is_some_and(|state| state.is_over(&scenario.evolution))
        {
            self.forget_summary();
        }
        let mut evolution = match self.state.clone() {
            Some(state) => {
                Evolution::resume(self.experiment, workers, seed, state, controls.gate())?
            }
            None => {
                let started = Event::Started {
                    format: EVENT_FORMAT,
                    scenario: scenario.name.clone(),
                    seed,
                };
                self.send_recorded(started, recorder)?;
                show(0, 0);
                Evolution::begin(self.experiment, workers, seed, controls.gate())?
            }
        };
        // A resumed run saves its state too: the limit may be new, and the process before may
        // have died before it kept the checkpoint of this generation.
        self.save(&evolution, recorder)?;
        progress.note(evolution.state());
        while !evolution.is_over() {
            controls.gate().pass(0)?;
            let generation = evolution.state().generation + 1;
            show(generation, 0);
            let record = evolution.step(controls.gate(), |lived| show(generation, lived))?;
            progress.best = BestIndividual::of(&record);
            progress.note(evolution.state());
            let (record, state) = (Box::new(record), Arc::clone(evolution.state()));
            let message = Message::Generation(record.clone(), state);
            recorder.send(message).map_err(|_| Stopped)?;
            // Before the event, so that its receiver finds the individuals of the generation.
            controls.feed().set_latest(evolution.state());
            controls.feed().send(Event::Generation(record));
            controls.generation_over();
        }
        let ending = match scenario.evolution.generation_limit {
            _ if progress.converged => Ending::Converged,
            limit if progress.generations >= limit => Ending::GenerationLimit,
            _ => Ending::ControlStepLimit,
        };
        let generations = progress.generations;
        self.send_recorded(
            Event::Ended {
                generations,
                ending,
            },
            recorder,
        )?;
        if let Some(Then::Learn(trials)) = scenario.evolution.then {
            let state = evolution.state();
            let gate = controls.gate();
            progress.learning = LaterLearning::of(self.experiment, seed, state, trials, gate)?;
        }
        progress.over = true;
        Ok(())
    }

    /// Removes the summary of a run that was over and is resumed with a higher limit: it must not
    /// count as the result, even if this process dies. A failure is ignored, since the summary is
    /// written again at the end.
    fn forget_summary(&self) {
        let _ignored = std::fs::remove_file(self.folder.summary());
    }

    /// Sends a recorded event to the recorder, then to the reader.
    fn send_recorded(&self, event: Event, recorder: &Sender<Message>) -> Result<(), Stopped> {
        let message = Message::Event(Box::new(event.clone()));
        recorder.send(message).map_err(|_| Stopped)?;
        self.controls.feed().send(event);
        Ok(())
    }

    fn save(
        &self,
        evolution: &Evolution<'_, W>,
        recorder: &Sender<Message>,
    ) -> Result<(), Stopped> {
        self.controls.feed().set_latest(evolution.state());
        let state = Message::State(Arc::clone(evolution.state()));
        recorder.send(state).map_err(|_| Stopped)
    }
}

/// Returns whether `summary.json` holds this result; wall-clock time and path may differ.
fn has_summary(folder: &RunFolder, outcome: &Outcome) -> bool {
    let written = Outcome::read(folder.path()).ok().flatten();
    written.is_some_and(|written| {
        let now = Outcome {
            wall_seconds: written.wall_seconds,
            run_dir: written.run_dir.clone(),
            ..outcome.clone()
        };
        now == written
    })
}

impl Progress {
    fn note(&mut self, state: &EvolutionState) {
        self.generations = state.generation;
        self.converged = state.converged;
        self.control_steps = state.control_steps;
    }
}
