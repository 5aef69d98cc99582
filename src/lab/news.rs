//! What a reader of a run folder learns.

use super::event::Event;
use super::last_sign::LastSign;
use super::manifest::Manifest;

/// A change in a run folder.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// The folder holds this run. Sent first, and again when another run replaced it or a resumed
    /// run dropped events; all earlier news are void then.
    Run(Box<Manifest>),
    /// An event of the run.
    Event(Event),
    /// The liveness of the run changed.
    Liveness(Liveness),
    /// The process that computed the run is gone, and this was its last sign.
    LastSign(LastSign),
    /// A file cannot be read; the follower tries again.
    Trouble(String),
}

/// Whether a process computes a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Liveness {
    /// The folder holds no run, or no longer.
    Absent,
    /// A process computes it.
    Computing,
    /// A process computed it, but its pulse stopped: the process died or hangs, or the folder
    /// cannot be reached.
    Silent,
    /// No process computes it and it is not over; it can be resumed.
    Stopped,
    /// It is over.
    Over,
}

/// The content of a run folder at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Its `run.json`.
    pub manifest: Manifest,
    /// The events so far, and one for the checkpoint if there is one.
    pub events: Vec<Event>,
    /// Its liveness, as far as a single read can tell.
    pub liveness: Liveness,
    /// The last sign of the process that computed the run, if it is gone before the end.
    pub last_sign: Option<LastSign>,
}

impl Recording {
    /// Returns the number of generations so far.
    #[must_use]
    pub fn generations(&self) -> u64 {
        let last = self.events.iter().rev().find_map(|event| match event {
            Event::Generation(record) => Some(record.generation),
            _ => None,
        });
        last.unwrap_or(0)
    }
}
