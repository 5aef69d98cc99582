//! Writes a run to its folder, on a thread of its own.
//!
//! Every recorded event is appended as it comes, every kept generation is written.
//! `checkpoint.json` is brought up to date and synced whenever nothing else waits, so
//! a run that is faster than the disk is slowed by neither. Checkpoints follow their
//! events: what a checkpoint counts is on disk before it is.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use crossbeam_channel::{Receiver, select};
use thiserror::Error;

use super::checkpoint::{Checkpoint, LogPosition};
use super::checkpoint_error::CheckpointError;
use super::controls::Controls;
use super::event::Event;
use super::folder::{Keep, RunFolder};
use super::log::Log;
use crate::evolution::{Experiment, State};
use crate::files::write_atomically;
use crate::worlds::World;

/// Messages that wait for the recorder before evolution waits too: a disk that is too
/// slow slows a run down rather than losing some of it.
pub(super) const QUEUE_CAPACITY: usize = 8;

/// What the recorder is told.
#[derive(Debug)]
pub(super) enum Message {
    /// A recorded event.
    Event(Box<Event>),
    /// The state after the events so far.
    State(Arc<State>),
}

/// Why a run cannot be recorded.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The operating system refused.
    #[error("cannot be written: {0}")]
    Io(#[from] io::Error),
    /// The state cannot be a checkpoint.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// The recorder of one run.
pub(super) struct Recorder<'r, W: World> {
    pub(super) experiment: &'r Experiment<W>,
    pub(super) seed: u64,
    pub(super) folder: &'r RunFolder,
    pub(super) keep: Keep,
    pub(super) log: Log,
    pub(super) controls: &'r Controls,
}

/// A state that is not in `checkpoint.json` yet.
struct Pending {
    state: Arc<State>,
    position: LogPosition,
}

impl<W: World> Recorder<'_, W> {
    /// Records until the senders are gone; then everything is on disk. A request asks
    /// for the latest checkpoint now.
    pub(super) fn run(
        mut self,
        messages: &Receiver<Message>,
        requests: &Receiver<()>,
    ) -> Result<(), RecordError> {
        let mut pending: Option<Pending> = None;
        loop {
            let saved_now = select! {
                recv(messages) -> message => match message {
                    Ok(Message::Event(event)) => {
                        self.log.append(&event)?;
                        messages.is_empty()
                    }
                    Ok(Message::State(state)) => {
                        self.archive(pending.take())?;
                        let position = self.log.position();
                        pending = Some(Pending { state, position });
                        messages.is_empty()
                    }
                    Err(_) => {
                        self.save(pending.take())?;
                        self.log.sync()?;
                        return Ok(());
                    }
                },
                recv(requests) -> request => request.is_ok(),
            };
            if saved_now {
                self.save(pending.take())?;
            }
        }
    }

    /// Keeps a state that has been overtaken, if its generation is to be kept.
    fn archive(&self, pending: Option<Pending>) -> Result<(), RecordError> {
        let kept = pending.filter(|pending| self.keeps(&pending.state));
        let Some(Pending { state, position }) = kept else {
            return Ok(());
        };
        let bytes = self.bytes(&state, position)?;
        let path = self.folder.generation(state.generation);
        let mut file = tempfile::NamedTempFile::new_in(self.folder.generations())?;
        file.write_all(&bytes)?;
        file.persist(&path).map_err(|error| error.error)?;
        Ok(())
    }

    /// Makes a state the checkpoint, and keeps it.
    fn save(&self, pending: Option<Pending>) -> Result<(), RecordError> {
        let Some(Pending { state, position }) = pending else {
            return Ok(());
        };
        let bytes = self.bytes(&state, position)?;
        self.log.sync()?;
        let checkpoint = self.folder.checkpoint();
        write_atomically(&checkpoint, &bytes)?;
        if self.keeps(&state) {
            link_or_copy(&checkpoint, &self.folder.generation(state.generation))?;
        }
        self.controls.tell(Event::CheckpointSaved {
            generation: state.generation,
        });
        Ok(())
    }

    fn keeps(&self, state: &State) -> bool {
        state.generation > 0 && self.keep.keeps(state.generation)
    }

    fn bytes(&self, state: &State, position: LogPosition) -> Result<Vec<u8>, RecordError> {
        let checkpoint = Checkpoint::of(self.experiment, self.seed, state, position)?;
        Ok(checkpoint.to_bytes().map_err(io::Error::from)?)
    }
}

/// Gives a file a second name; where the file system has no links, copies it. The
/// next checkpoint replaces the first name and leaves the second alone.
fn link_or_copy(from: &Path, to: &Path) -> io::Result<()> {
    match fs::remove_file(to) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    fs::hard_link(from, to).or_else(|_| fs::copy(from, to).map(|_| ()))
}
