//! A run folder as it is at one moment.

use super::event::Event;
use super::manifest::Manifest;
use super::news::Liveness;

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
