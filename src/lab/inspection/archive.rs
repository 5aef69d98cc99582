//! The populations of a run, of any generation that was kept.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

use crate::evolution::EvolutionState;
use crate::files::FileError;
use crate::lab::checkpoint::Checkpoint;
use crate::lab::controls::Controls;
use crate::lab::experiment::AnyExperiment;

/// Populations that are held ready.
const CAPACITY: usize = 8;

/// Why a population cannot be shown.
#[derive(Debug, Error)]
pub enum ArchiveError {
    /// The generation was not kept.
    #[error(
        "generation {generation}: its individuals were not kept; allowed: {allowed} (a run keeps \
         what --keep says, and its latest generation)"
    )]
    NotKept {
        /// The generation asked for.
        generation: u64,
        /// Those that were.
        allowed: String,
    },
    /// There is no population yet.
    #[error("{folder}: no generation has been saved yet")]
    Nothing {
        /// The run folder.
        folder: String,
    },
    /// A file is not a checkpoint of this run.
    #[error(transparent)]
    File(#[from] FileError),
}

/// The populations of one run, read when they are asked for.
pub struct Archive {
    experiment: &'static dyn AnyExperiment,
    folder: PathBuf,
    live: Option<Controls>,
    /// The latest used first.
    cache: VecDeque<Arc<EvolutionState>>,
}

impl Archive {
    /// The archive of the run in `folder`; of a run in this process if its controls are
    /// given.
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

    /// The latest population.
    ///
    /// # Errors
    /// When there is none, or it cannot be read.
    pub fn latest(&self) -> Result<Arc<EvolutionState>, ArchiveError> {
        if let Some(state) = self.live_state() {
            return Ok(state);
        }
        let state = self.read(&self.folder.join("checkpoint.json"))?;
        state.map(Arc::new).ok_or_else(|| ArchiveError::Nothing {
            folder: self.folder.display().to_string(),
        })
    }

    /// The population after a generation.
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

    fn cached(&mut self, generation: u64) -> Option<Arc<EvolutionState>> {
        let mut states = self.cache.iter();
        let place = states.position(|state| state.generation == generation)?;
        self.cache.remove(place)
    }

    fn live_state(&self) -> Option<Arc<EvolutionState>> {
        self.live.as_ref().and_then(Controls::latest)
    }

    fn kept(&self, generation: u64) -> Result<EvolutionState, ArchiveError> {
        let generations = self.folder.join("generations");
        let kept = self.read(&generations.join(format!("{generation:06}.json")))?;
        if let Some(state) = kept {
            return Ok(state);
        }
        // The latest generation is in the checkpoint, kept or not.
        let latest = self.read(&self.folder.join("checkpoint.json"))?;
        let fits = latest.filter(|state| state.generation == generation);
        fits.ok_or_else(|| ArchiveError::NotKept {
            generation,
            allowed: allowed(&generations),
        })
    }

    /// The population in a file, if there is a file.
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

/// The generations in a folder in words.
fn allowed(folder: &Path) -> String {
    let names = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut kept: Vec<u64> = names
        .filter_map(|entry| {
            let name = entry.file_name();
            name.to_str()?.strip_suffix(".json")?.parse().ok()
        })
        .collect();
    kept.sort_unstable();
    match kept[..] {
        [] => String::from("the latest"),
        [only] => only.to_string(),
        [first, .., last] if last - first + 1 == kept.len() as u64 => format!("{first} to {last}"),
        [first, second, .., last] => format!("{first}, {second}, ... {last}"),
        [first, second] => format!("{first}, {second}"),
    }
}
