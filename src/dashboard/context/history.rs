//! The history of a run, accumulated from its events.

use std::sync::Arc;

use crate::evolution::GenerationRecord;
use crate::lab::{Ending, Event};

/// The progress of the current generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Number of the generation; 0 while primitive subtasks are trained.
    pub generation: u64,
    /// Individuals that have been evaluated.
    pub lived: usize,
    /// Individuals in the population.
    pub population: usize,
    /// Control steps computed by the running process.
    pub control_steps: u64,
}

/// Everything known about a run from its events so far.
///
/// Generations are shared, so that a clone is cheap; a frozen display keeps one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunHistory {
    generations: Vec<Arc<GenerationRecord>>,
    progress: Option<Progress>,
    paused: bool,
    checkpoint: Option<u64>,
    ending: Option<Ending>,
}

impl RunHistory {
    /// Applies an event.
    pub fn apply(&mut self, event: Event) {
        match event {
            Event::Started { .. } => {}
            Event::Generation(record) => self.add(*record),
            Event::Ended { ending, .. } => {
                self.ending = Some(ending);
                self.progress = None;
            }
            Event::Progress {
                generation,
                lived,
                population,
                control_steps,
            } => {
                // Progress means that the run was resumed, even if it had ended before.
                self.ending = None;
                self.progress = Some(Progress {
                    generation,
                    lived,
                    population,
                    control_steps,
                });
            }
            Event::Paused => self.paused = true,
            Event::Resumed => self.paused = false,
            Event::CheckpointSaved { generation } => self.checkpoint = Some(generation),
        }
    }

    /// Adds a generation in its place; a repeated one replaces the former record.
    fn add(&mut self, record: GenerationRecord) {
        let number = record.generation;
        let record = Arc::new(record);
        match self.search(number) {
            Ok(at) => self.generations[at] = record,
            Err(at) => self.generations.insert(at, record),
        }
    }

    fn search(&self, number: u64) -> Result<usize, usize> {
        self.generations
            .binary_search_by_key(&number, |record| record.generation)
    }

    /// Returns the generations so far, in order.
    #[must_use]
    pub fn generations(&self) -> &[Arc<GenerationRecord>] {
        &self.generations
    }

    /// Returns the generation with this number.
    #[must_use]
    pub fn generation(&self, number: u64) -> Option<&Arc<GenerationRecord>> {
        self.search(number).ok().map(|at| &self.generations[at])
    }

    /// Returns the latest complete generation.
    #[must_use]
    pub fn latest(&self) -> Option<&Arc<GenerationRecord>> {
        self.generations.last()
    }

    /// Returns the progress of the current generation.
    ///
    /// `None` before the first progress event, and after the end of the run.
    #[must_use]
    pub fn progress(&self) -> Option<Progress> {
        self.progress
    }

    /// Returns whether evolution is paused.
    #[must_use]
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// Returns the generation of the last checkpoint.
    #[must_use]
    pub fn checkpoint(&self) -> Option<u64> {
        self.checkpoint
    }

    /// Returns why evolution has ended, or `None` if it has not.
    #[must_use]
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }
}
