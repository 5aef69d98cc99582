//! What is told of a run folder that somebody looks at.

use super::event::Event;
use super::manifest::Manifest;

/// What a follower tells of a run folder.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// A run is here. It is told first, and again when another run took its place or some
    /// of it is computed anew; what was told before is void then.
    Run(Box<Manifest>),
    /// A fact about the run.
    Event(Event),
    /// Whether the run is being computed has changed.
    Liveness(Liveness),
    /// Something in the folder cannot be read. It is tried again.
    Trouble(String),
}

/// Whether a run is being computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Liveness {
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

/// A run folder as it is at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What was run.
    pub manifest: Manifest,
    /// The events so far, and that a checkpoint is there.
    pub events: Vec<Event>,
    /// Whether it is being computed, as far as one look can tell.
    pub liveness: Liveness,
}

impl Recording {
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
