//! Writes a run to its folder, on a thread of its own.
//!
//! Each recorded event is appended and each kept generation written in one step, so a process
//! that is killed leaves nothing half-written. Only `checkpoint.json` is synced to the disk, at most once a
//! second: a crash of the machine loses what came later. The events before a checkpoint are
//! synced before the checkpoint.

use std::fs;
use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, after, at, never, select};
use thiserror::Error;

use super::checkpoint::{Checkpoint, LogPosition, check_finite};
use super::checkpoint_error::CheckpointError;
use super::controls::Controls;
use super::event::Event;
use super::folder::RunFolder;
use super::keep::Keep;
use super::kept::kept_generations;
use super::last_sign::forget_error;
use super::log::Log;
use crate::evolution::{EvolutionState, GenerationRecord};
use crate::files::{FileProblem, link_atomically, write_atomically, write_in_one_step};
use crate::scenario::Scenario;
use crate::worlds::Catalogue;

/// Messages that wait for the recorder before evolution waits too: a slow disk slows the run down,
/// and nothing is lost.
pub(super) const QUEUE_CAPACITY: usize = 8;

/// Shortest time between two writes of `checkpoint.json`.
const SAVE_INTERVAL: Duration = Duration::from_secs(1);

/// A message to the recorder.
#[derive(Debug)]
pub(super) enum Message {
    /// A recorded event.
    Event(Box<Event>),
    /// The state after all events so far.
    State(Arc<EvolutionState>),
    /// A generation that is done, and the state after it.
    Generation(Box<GenerationRecord>, Arc<EvolutionState>),
}

/// Why a run cannot be recorded.
#[derive(Debug, Error)]
pub(super) enum RecordError {
    /// The operating system refuses.
    #[error("cannot be written: {0}")]
    Io(#[from] io::Error),
    /// The state cannot be saved as a checkpoint.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

impl From<RecordError> for FileProblem {
    fn from(error: RecordError) -> Self {
        Self::Wrong(error.to_string())
    }
}

/// The recorder of one run.
pub(super) struct Recorder<'r> {
    pub(super) scenario: &'r Scenario,
    pub(super) catalogue: &'r Catalogue,
    pub(super) seed: u64,
    pub(super) folder: &'r RunFolder,
    pub(super) keep: Keep,
    pub(super) log: &'r mut Log,
    pub(super) controls: &'r Controls,
}

/// A state that `checkpoint.json` does not hold yet.
struct Pending {
    state: Arc<EvolutionState>,
    position: LogPosition,
}

impl Recorder<'_> {
    /// Records until the senders are gone, and returns when everything is on the disk. A request
    /// saves the latest state at once.
    pub(super) fn run(
        mut self,
        messages: &Receiver<Message>,
        requests: &Receiver<()>,
    ) -> Result<(), RecordError> {
        let mut pending: Option<Pending> = None;
        let mut saved: Option<Instant> = None;
        loop {
            let due = match (&pending, saved) {
                (None, _) => never(),
                (Some(_), None) => after(Duration::ZERO),
                (Some(_), Some(saved)) => at(saved + SAVE_INTERVAL),
            };
            select! {
                recv(messages) -> message => match message {
                    Ok(message) => pending = self.record(message)?.or(pending),
                    Err(_) => {
                        self.save(pending.take())?;
                        self.log.sync()?;
                        return Ok(());
                    }
                },
                recv(requests) -> _ => {
                    self.save(pending.take())?;
                    saved = Some(Instant::now());
                },
                recv(due) -> _ => {
                    self.save(pending.take())?;
                    saved = Some(Instant::now());
                },
            }
        }
    }

    /// Records a message and returns the state that `checkpoint.json` should hold.
    ///
    /// A generation in which learning diverged is not recorded: JSON cannot express its numbers.
    fn record(&mut self, message: Message) -> Result<Option<Pending>, RecordError> {
        self.folder.check_ours()?;
        let state = match message {
            Message::Event(event) => {
                self.log.append(&event)?;
                return Ok(None);
            }
            Message::State(state) => {
                self.thin(state.generation);
                state
            }
            Message::Generation(record, state) => {
                check_finite(&state)?;
                if !record.is_finite() {
                    let place = format!("generation {}", record.generation);
                    return Err(CheckpointError::Diverged { place }.into());
                }
                self.log.append(&Event::Generation(record))?;
                state
            }
        };
        let position = self.log.position();
        let pending = Pending { state, position };
        if self.keeps(&pending.state) {
            let generation = pending.state.generation;
            let path = self.folder.generation(generation);
            write_in_one_step(&path, &self.bytes(&pending)?)?;
            for dropped in self.keep.dropped_at(generation) {
                self.forget(dropped);
            }
        }
        Ok(Some(pending))
    }

    /// Writes a state to `checkpoint.json`.
    fn save(&self, pending: Option<Pending>) -> Result<(), RecordError> {
        let Some(pending) = pending else {
            return Ok(());
        };
        self.log.sync()?;
        let (generation, checkpoint) = (pending.state.generation, self.folder.checkpoint());
        if self.keeps(&pending.state) {
            link_atomically(&self.folder.generation(generation), &checkpoint)?;
        } else {
            write_atomically(&checkpoint, &self.bytes(&pending)?)?;
        }
        // The run goes on from here, so the error of the process before is no longer true.
        forget_error(self.folder.path());
        self.controls
            .feed()
            .send(Event::CheckpointSaved { generation });
        Ok(())
    }

    fn keeps(&self, state: &EvolutionState) -> bool {
        let generation = state.generation;
        generation > 0 && self.keep.keeps(generation, generation)
    }

    /// Removes the kept states of a resumed run that thinning no longer keeps.
    fn thin(&self, latest: u64) {
        if self.keep != Keep::Thinned {
            return;
        }
        let kept = kept_generations(self.folder.path()).into_iter();
        for dropped in kept.filter(|&kept| !self.keep.keeps(kept, latest)) {
            self.forget(dropped);
        }
    }

    /// Removes a kept state. One that cannot be removed stays.
    fn forget(&self, generation: u64) {
        let _stays = fs::remove_file(self.folder.generation(generation));
    }

    fn bytes(&self, pending: &Pending) -> Result<Vec<u8>, RecordError> {
        let Pending { state, position } = pending;
        let checkpoint =
            Checkpoint::of(self.scenario, self.catalogue, self.seed, state, *position)?;
        Ok(checkpoint.to_bytes().map_err(io::Error::from)?)
    }
}
