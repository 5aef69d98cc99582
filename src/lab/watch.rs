//! Following a run that another process computes, and reading one that nobody does.
//!
//! A follower only reads: it takes no lock and leaves no trace, so that it may follow a run
//! of another machine in a shared folder. It polls, because that is what works over
//! every kind of share.

use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use super::event::Event;
use super::follower::Follower;
use super::manifest::Manifest;
use super::run_error::RunError;

/// News that wait for the reader before the follower waits too.
const CHANNEL_CAPACITY: usize = 256;

/// What a follower tells of a run folder.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// A run is here. It is told first, and again when another run took its place or some
    /// of it is computed anew; what was told before is void then.
    Run(Box<Manifest>),
    /// A fact about the run.
    Event(Event),
    /// Whether the run is being computed has changed.
    Life(Life),
    /// Something in the folder cannot be read. It is tried again.
    Trouble(String),
}

/// Whether a run is being computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    /// There is no run here yet, or no longer.
    Absent,
    /// A process works on it.
    Computing,
    /// A process worked on it and gives no sign of life: it died or froze, or the folder is
    /// out of reach.
    Silent,
    /// Nobody works on it, and it is not over: it can be resumed.
    Stopped,
    /// It is over.
    Over,
}

/// A run folder that is being followed, until this is dropped.
#[derive(Debug)]
pub struct Watch {
    /// What is told, from the very first event of the run on.
    pub news: Receiver<News>,
    _stop: Sender<()>,
}

impl Watch {
    /// Follows the run in a folder, which need not be there yet, and looks every `interval`.
    ///
    /// # Errors
    /// When there can be no thread.
    pub fn start(folder: &Path, interval: Duration) -> Result<Self, RunError> {
        let (sender, news) = bounded(CHANNEL_CAPACITY);
        let (stop, stopped) = bounded::<()>(0);
        let folder: PathBuf = folder.to_owned();
        thread::Builder::new()
            .name(String::from("follower"))
            .spawn(move || {
                let mut follower = Follower::of(&folder);
                loop {
                    for news in follower.look(Instant::now()) {
                        if sender.send(news).is_err() {
                            return;
                        }
                    }
                    if stopped.recv_timeout(interval) != Err(RecvTimeoutError::Timeout) {
                        return;
                    }
                }
            })
            .map_err(|error| RunError::Threads(error.to_string()))?;
        Ok(Self { news, _stop: stop })
    }
}

/// A run folder as it is at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What was run.
    pub manifest: Manifest,
    /// The events so far, and that a checkpoint is there.
    pub events: Vec<Event>,
    /// Whether it is being computed, as far as one look can tell.
    pub life: Life,
}

impl Recording {
    /// Reads the run in a folder. A last event without its end is dropped.
    ///
    /// # Errors
    /// When the folder holds no run, or its log cannot be read.
    pub fn read(folder: &Path) -> Result<Self, RunError> {
        Follower::of(folder).read()
    }

    /// Generations lived so far.
    #[must_use]
    pub fn generations(&self) -> u64 {
        let last = self.events.iter().rev().find_map(|event| match event {
            Event::Generation(record) => Some(record.generation),
            _ => None,
        });
        last.unwrap_or(0)
    }
}
