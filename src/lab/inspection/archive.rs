//! The populations of a run.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

use crate::evolution::EvolutionState;
use crate::files::{FileError, folder_bytes};
use crate::lab::checkpoint::Checkpoint;
use crate::lab::controls::Controls;
use crate::lab::experiment::AnyExperiment;
use crate::lab::folder::{CHECKPOINT, kept_path};
use crate::lab::kept::{kept_generations, ranges};

/// Populations that are cached.
const CAPACITY: usize = 8;

/// Why a population cannot be read.
#[derive(Debug, Error)]
pub enum ArchiveError {
    /// The checkpoint of the generation was not kept.
    #[error(
        "generation {generation}: its individuals were not kept; allowed: {allowed} (a run keeps \
         what --keep says, and its latest generation)"
    )]
    NotKept {
        /// The requested generation.
        generation: u64,
        /// The generations that were kept, in words.
        allowed: String,
    },
    /// The run has no population yet.
    #[error("{folder}: no generation has been saved yet")]
    Nothing {
        /// The run folder.
        folder: String,
    },
    /// A file is not a checkpoint of this run.
    #[error(transparent)]
    File(#[from] FileError),
}

/// The populations of one run, read on demand.
pub struct Archive {
    experiment: &'static dyn AnyExperiment,
    folder: PathBuf,
    live: Option<Controls>,
    /// The most recently used first.
    cache: VecDeque<Arc<EvolutionState>>,
}

impl Archive {
    /// Returns the archive of the run in `folder`. A run of this process passes its controls as
    /// `live`, so that its latest population is taken from memory.
    #[must_use]
    pub fn new(
        experiment: &'static dyn AnyExperiment,
        folder: &Path,
        live: Option<Controls>,
    ) -> Self {
        Self {
            experiment,
            folder: folder.to_owned(),
            live,
            cache: VecDeque::new(),
        }
    }

    /// Returns the latest population.
    ///
    /// # Errors
    /// When there is none, or it cannot be read.
    pub fn latest(&self) -> Result<Arc<EvolutionState>, ArchiveError> {
        if let Some(state) = self.live_state() {
            return Ok(state);
        }
        let state = self.read(&self.folder.join(CHECKPOINT))?;
        state.map(Arc::new).ok_or_else(|| ArchiveError::Nothing {
            folder: self.folder.display().to_string(),
        })
    }

    /// Returns the population after a generation.
    ///
    /// # Errors
    /// When it was not kept, or cannot be read.
    pub fn generation(&mut self, generation: u64) -> Result<Arc<EvolutionState>, ArchiveError> {
        let state = match self.cached(generation).or_else(|| self.live_state()) {
            Some(state) if state.generation == generation => state,
            _ => Arc::new(self.kept(generation)?),
        };
        self.cache.push_front(Arc::clone(&state));
        self.cache.truncate(CAPACITY);
        Ok(state)
    }

    /// Returns the population after a generation, or that of the nearest generation that was kept.
    ///
    /// # Errors
    /// When none was kept, or it cannot be read.
    pub fn nearest(&mut self, generation: u64) -> Result<Arc<EvolutionState>, ArchiveError> {
        let exact = self.generation(generation);
        let Err(ArchiveError::NotKept { .. }) = exact else {
            return exact;
        };
        let mut kept = kept_generations(&self.folder);
        kept.extend(self.latest().ok().map(|state| state.generation));
        // The run may thin out a state before it is read.
        kept.sort_by_key(|kept| kept.abs_diff(generation));
        kept.dedup();
        for near in kept {
            match self.generation(near) {
                Err(ArchiveError::NotKept { .. }) => {}
                found => return found,
            }
        }
        exact
    }

    /// Returns the size of the run folder in bytes.
    #[must_use]
    pub fn folder_bytes(&self) -> u64 {
        folder_bytes(&self.folder)
    }

    fn cached(&mut self, generation: u64) -> Option<Arc<EvolutionState>> {
        let mut states = self.cache.iter();
        let place = states.position(|state| state.generation == generation)?;
        self.cache.remove(place)
    }

    fn live_state(&self) -> Option<Arc<EvolutionState>> {
        self.live.as_ref().and_then(Controls::latest)
    }

    fn kept(&self, generation: u64) -> Result<EvolutionState, ArchiveError> {
        let kept = self.read(&kept_path(&self.folder, generation))?;
        if let Some(state) = kept {
            return Ok(state);
        }
        // checkpoint.json holds the latest generation even if it was not kept.
        let latest = self.read(&self.folder.join(CHECKPOINT))?;
        let fits = latest.filter(|state| state.generation == generation);
        fits.ok_or_else(|| ArchiveError::NotKept {
            generation,
            allowed: match kept_generations(&self.folder).as_slice() {
                [] => String::from("the latest"),
                kept => ranges(kept),
            },
        })
    }

    /// Reads the population in a file; returns `None` if there is no file.
    fn read(&self, path: &Path) -> Result<Option<EvolutionState>, ArchiveError> {
        let wrong = |error| FileError::new(path, error);
        let Some(checkpoint) = Checkpoint::read(path).map_err(wrong)? else {
            return Ok(None);
        };
        checkpoint
            .check_origin(self.experiment.scenario(), self.experiment.seed())
            .map_err(|message| FileError::new(path, message))?;
        Ok(Some(
            self.experiment.population(&checkpoint).map_err(wrong)?,
        ))
    }
}
