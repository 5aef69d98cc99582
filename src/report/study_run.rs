//! Does one run of a study, from its present state to its end: evolution, then the evaluation of
//! its winner. A run writes to its own folder only.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::arm::{Arm, Base};
use super::results::{
    EVALUATION_FORMAT, PlannedRun, StudyRunError, WinnerEvaluation, check_evaluation, evaluation,
    evaluation_seed,
};
use super::study::{RunId, Study};
use crate::evolution::Workers;
use crate::files::{FileError, write_atomically};
use crate::lab::{
    Controls, EVALUATION, FolderError, Keep, MANIFEST, Outcome, Protocol, Run, RunError, RunFolder,
    RunOptions, SUMMARY, experiment, resume, start,
};
use crate::learning::{Gate, Stopped};
use crate::scenario::Scenario;

/// Stops the runs of a study that this process does.
#[derive(Debug, Default)]
pub struct StudyControls {
    gate: Gate,
    /// The runs in progress, by their folders.
    running: Mutex<Vec<(PathBuf, Controls)>>,
}

impl StudyControls {
    /// Stops all runs for good. Each of them saves its progress and can be resumed.
    pub fn stop(&self) {
        self.gate.stop();
        self.running()
            .iter()
            .for_each(|(_, controls)| controls.stop());
    }

    /// Returns whether the runs were stopped.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.gate.is_stopped()
    }

    fn running(&self) -> MutexGuard<'_, Vec<(PathBuf, Controls)>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for the end of a run, and stops it if the study is stopped.
    fn follow(&self, run: Run) -> Result<Outcome, RunError> {
        let folder = run.folder.clone();
        self.running().push((folder.clone(), run.controls.clone()));
        // The study may have been stopped before the run was in the list.
        if self.is_stopped() {
            run.controls.stop();
        }
        let outcome = run.join();
        self.running().retain(|(other, _)| *other != folder);
        outcome
    }
}

/// A run of a study, and how it is done.
#[derive(Debug)]
pub struct StudyRun<'s> {
    /// The study.
    pub study: &'s Study,
    /// The run.
    pub run: RunId,
    /// The generations whose checkpoints are kept.
    pub keep: Keep,
    /// Stops the run.
    pub controls: &'s StudyControls,
}

impl StudyRun<'_> {
    /// Does what is left of the run, and returns the evaluation of its winner.
    ///
    /// # Errors
    /// When the run is stopped or fails, or its folder holds something else.
    pub fn finish(&self) -> Result<WinnerEvaluation, StudyRunError> {
        let folder = self.study.run_folder(&self.run);
        let planned = PlannedRun::of(self.study, &self.run)?;
        let outcome = planned.outcome()?;
        if let (Some(outcome), Some(found)) = (&outcome, evaluation(&folder)?) {
            check_evaluation(self.study, &self.run, outcome, &found)?;
            return Ok(found);
        }
        if outcome.is_none() {
            self.evolve(&folder, &planned)?;
        }
        self.evaluate(&folder, planned.scenario)
    }

    /// Returns whether `error` means that another process does the run: it holds the lock, or has
    /// just created the folder.
    #[must_use]
    pub fn is_elsewhere(&self, error: &StudyRunError) -> bool {
        match error {
            StudyRunError::Folder(error) | StudyRunError::Run(RunError::Folder(error)) => {
                match error {
                    FolderError::InUse { .. } => true,
                    FolderError::Exists { .. } => {
                        self.study.run_folder(&self.run).join(MANIFEST).is_file()
                    }
                    _ => false,
                }
            }
            _ => false,
        }
    }

    fn evolve(&self, folder: &Path, planned: &PlannedRun) -> Result<(), StudyRunError> {
        let options = RunOptions {
            threads: 1,
            keep: Some(self.keep),
            force: false,
        };
        let run = if folder.join(MANIFEST).is_file() {
            planned.manifest()?;
            resume(folder, None, &options)?
        } else {
            start(
                self.with_budget(&planned.scenario)?,
                self.run.seed,
                folder,
                &options,
            )?
        };
        if self.controls.follow(run)?.stopped {
            return Err(Stopped.into());
        }
        Ok(())
    }

    /// Returns the scenario with the budget of its arm.
    fn with_budget(&self, scenario: &Scenario) -> Result<Scenario, StudyRunError> {
        let mut scenario = scenario.clone();
        let evolution = &scenario.evolution;
        if self.study.arm(&self.run).base.is_matched() && evolution.control_step_limit.is_none() {
            scenario.evolution.generation_limit = self.evolved_generations()?;
        }
        Ok(scenario)
    }

    /// Returns the number of generations of the evolved run with the same scenario, settings and
    /// seed.
    ///
    /// If that run is not done in this folder, the number is computed. The result is the same, so
    /// the order of runs does not matter.
    fn evolved_generations(&self) -> Result<u64, StudyRunError> {
        let own = self.study.arm(&self.run);
        let is_pair = |arm: &Arm| arm.base == Base::Evolved && arm.settings == own.settings;
        if let Some(arm) = self.study.plan.arms.iter().position(is_pair) {
            let folder = self.study.run_folder(&RunId { arm, ..self.run });
            if let Some(outcome) = Outcome::read(&folder)? {
                return Ok(outcome.generations);
            }
        }
        let evolved = Arm {
            base: Base::Evolved,
            ..own.clone()
        };
        let scenario = evolved.apply(self.study.scenario(&self.run))?;
        let experiment = experiment(scenario, self.run.seed)?;
        let state = experiment.evolve(&one_worker()?, &self.controls.gate)?;
        Ok(state.generation)
    }

    fn evaluate(
        &self,
        folder: &Path,
        scenario: Scenario,
    ) -> Result<WinnerEvaluation, StudyRunError> {
        let own = RunFolder::open(folder)?;
        let evaluated = self.evaluate_in(folder, scenario);
        match &evaluated {
            Err(StudyRunError::Stopped(_)) => {}
            Err(error) => own.leave_error(Some(&error.to_string())),
            Ok(_) => own.leave_error(None),
        }
        evaluated
    }

    /// Evaluates the winner of the run in a locked folder.
    fn evaluate_in(
        &self,
        folder: &Path,
        scenario: Scenario,
    ) -> Result<WinnerEvaluation, StudyRunError> {
        let path = folder.join(EVALUATION);
        // Another process may have finished before the lock was free.
        if let Some(found) = evaluation(folder)? {
            return Ok(found);
        }
        let wrong = |message: String| FileError::new(folder.join(SUMMARY), message);
        let best = Outcome::read(folder)?.and_then(|outcome| outcome.best);
        let best = best.ok_or_else(|| wrong(String::from("names no best individual")))?;
        let plan = self.study.plan.reevaluation;
        let protocol = Protocol {
            warmup: plan.warmup,
            trials: plan.trials,
            repeats: plan.repeats,
            primitive_sets: plan.primitive_sets,
        };
        let seed = evaluation_seed(&self.run);
        let experiment = experiment(scenario, seed)?;
        let tree = experiment.read_tree(&best.tree);
        let tree = tree.map_err(|error| wrong(format!("best.tree: {error}")))?;
        let (workers, gate) = (one_worker()?, &self.controls.gate);
        let scored = experiment.evaluate(&tree, &protocol, &workers, gate, &|_| {})?;
        let found = WinnerEvaluation {
            format: EVALUATION_FORMAT,
            seed,
            warmup: protocol.warmup,
            evaluation: scored.evaluation,
        };
        let written = serde_json::to_vec(&found)
            .map_err(std::io::Error::from)
            .and_then(|bytes| write_atomically(&path, &[bytes.as_slice(), b"\n"].concat()));
        written.map_err(|error| FileError::new(&path, error))?;
        Ok(found)
    }
}

/// Each run of a study uses one thread; parallel runs use the other processors.
fn one_worker() -> Result<Workers, StudyRunError> {
    Workers::new(1).map_err(|error| StudyRunError::Threads(error.to_string()))
}
