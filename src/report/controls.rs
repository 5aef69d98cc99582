//! Stopping the runs of a study, whichever thread does them.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use crate::lab::{Controls, Outcome, Run, RunError};
use crate::learning::Gate;

/// Stops the runs of a study that this process does.
#[derive(Debug, Default)]
pub struct StudyControls {
    gate: Gate,
    /// The runs under way, by their folders.
    running: Mutex<Vec<(PathBuf, Controls)>>,
}

impl StudyControls {
    /// Stops all runs for good; each saves what it has, and is gone on with next time.
    pub fn stop(&self) {
        self.gate.stop();
        let running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        running.iter().for_each(|(_, controls)| controls.stop());
    }

    /// Whether the runs were stopped.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.gate.is_stopped()
    }

    /// What computes outside of runs passes this gate.
    pub(super) fn gate(&self) -> &Gate {
        &self.gate
    }

    /// Waits for the end of a run, which is stopped with the study.
    pub(super) fn follow(&self, run: Run) -> Result<Outcome, RunError> {
        let running = || self.running.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = run.folder.clone();
        running().push((folder.clone(), run.controls.clone()));
        // The study may have been stopped before the run was in the list.
        if self.is_stopped() {
            run.controls.stop();
        }
        let outcome = run.join();
        running().retain(|(other, _)| *other != folder);
        outcome
    }
}
