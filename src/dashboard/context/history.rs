//! The fold over the events of a run.

use std::sync::Arc;

use crate::evolution::GenerationRecord;
use crate::lab::{Ending, Event};

/// How far the generation under way is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The generation; 0 while primitive subtasks are trained.
    pub generation: u64,
    /// Individuals that have lived.
    pub lived: usize,
    /// Individuals in the population.
    pub population: usize,
    /// Control steps computed by the running process.
    pub control_steps: u64,
}

/// All that the events of a run have told so far.
///
/// Generations are shared, so that a model is cheaply kept as it was.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunHistory {
    generations: Vec<Arc<GenerationRecord>>,
    progress: Option<Progress>,
    paused: bool,
    checkpoint: Option<u64>,
    ending: Option<Ending>,
}

impl RunHistory {
    /// Takes in a fact.
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
                // A run that goes on is not over, whatever its past said.
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

    /// Adds a generation in its place; one told again replaces the one before.
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

    /// The generations so far, in order.
    #[must_use]
    pub fn generations(&self) -> &[Arc<GenerationRecord>] {
        &self.generations
    }

    /// A generation by its number.
    #[must_use]
    pub fn generation(&self, number: u64) -> Option<&Arc<GenerationRecord>> {
        self.search(number).ok().map(|at| &self.generations[at])
    }

    /// The last generation that has lived.
    #[must_use]
    pub fn latest(&self) -> Option<&Arc<GenerationRecord>> {
        self.generations.last()
    }

    /// How far the generation under way is; `None` before the first word of it, and
    /// after the end.
    #[must_use]
    pub fn progress(&self) -> Option<Progress> {
        self.progress
    }

    /// Whether evolution waits.
    #[must_use]
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// The generation after which the last checkpoint was taken.
    #[must_use]
    pub fn checkpoint(&self) -> Option<u64> {
        self.checkpoint
    }

    /// Why evolution is over; `None` while it is not.
    #[must_use]
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }
}
