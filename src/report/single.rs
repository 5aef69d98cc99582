//! One run of a study, from wherever it is to its end: evolution, then the evaluation of
//! its winner. It writes to its own folder alone.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::arm::{Arm, ArmError, Base};
use super::controls::StudyControls;
use super::study::{RunId, Study};
use crate::evolution::Workers;
use crate::files::{FileError, parse_json, read_text, write_atomically};
use crate::lab::{
    Evaluation, FolderError, Keep, Manifest, Outcome, Protocol, RunError, RunFolder, RunOptions,
    SetupError, experiment, resume, start,
};
use crate::learning::Stopped;
use crate::scenario::Scenario;

/// The file with the result of a run.
pub(super) const SUMMARY: &str = "summary.json";
/// The file with the evaluation of its winner.
pub(super) const FRESH: &str = "evaluation.json";

/// Version of the format of `evaluation.json`.
const FRESH_FORMAT: u32 = 1;

/// Largest `evaluation.json` or `summary.json` that is read, in bytes.
const MAX_RESULT_BYTES: u64 = 1 << 24;

/// What is added to a run's seed for the evaluation of its winner: far from the seeds that
/// people give to runs, so that neither primitives nor trials are those of any run.
const FRESH_SEED_OFFSET: u64 = 1 << 40;

/// `evaluation.json`: the winner of a run, evaluated anew.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fresh {
    /// Version of this format.
    pub format: u32,
    /// Seed of the evaluation.
    pub seed: u64,
    /// Trials of each repeat before scoring started.
    pub warmup: usize,
    /// Its result.
    pub evaluation: Evaluation,
}

/// Why a run of a study could not be done.
#[derive(Debug, Error)]
pub enum SingleError {
    /// The run was stopped before it was done; it can be gone on with.
    #[error("stopped")]
    Stopped(#[from] Stopped),
    /// The arm does not fit the scenario.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// The scenario cannot be made ready.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// Its folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The run cannot begin, or had to end.
    #[error(transparent)]
    Run(#[from] RunError),
    /// Its folder holds something else.
    #[error("{path}: holds another run; allowed: that of this study's plan, {expected}")]
    Another {
        /// The file.
        path: String,
        /// What should be there.
        expected: String,
    },
    /// A file of the run cannot be read or written, or is not what it should be.
    #[error(transparent)]
    File(#[from] FileError),
    /// The operating system gives no threads.
    #[error("cannot start threads: {0}")]
    Threads(String),
}

/// A run of a study and how to do it.
#[derive(Debug)]
pub struct Single<'s> {
    /// The study.
    pub study: &'s Study,
    /// The run.
    pub run: RunId,
    /// Which generations' checkpoints are kept.
    pub keep: Keep,
    /// By which it is stopped.
    pub controls: &'s StudyControls,
}

impl Single<'_> {
    /// Brings the run to its end; one that is done stays as it is.
    ///
    /// # Errors
    /// When it is stopped, or cannot be done.
    pub fn carry_out(&self) -> Result<Fresh, SingleError> {
        let folder = self.study.run_folder(&self.run);
        if let (Some(outcome), Some(fresh)) = (summary(&folder)?, fresh(&folder)?) {
            check_evaluation(self.study, &self.run, &outcome, &fresh)?;
            return Ok(fresh);
        }
        let scenario = self
            .study
            .arm(&self.run)
            .apply(self.study.scenario(&self.run))?;
        if summary(&folder)?.is_none() {
            self.evolve(&folder, &scenario)?;
        }
        self.evaluate(&folder, scenario)
    }

    /// Whether the run cannot be done because another process does it: it holds the lock,
    /// or has made the folder since it was looked for.
    #[must_use]
    pub fn is_elsewhere(&self, error: &SingleError) -> bool {
        match error {
            SingleError::Folder(error) | SingleError::Run(RunError::Folder(error)) => match error {
                FolderError::InUse { .. } => true,
                FolderError::Exists { .. } => {
                    self.study.run_folder(&self.run).join("run.json").is_file()
                }
                _ => false,
            },
            _ => false,
        }
    }

    fn evolve(&self, folder: &Path, scenario: &Scenario) -> Result<(), SingleError> {
        let options = RunOptions {
            threads: 1,
            keep: self.keep,
            force: false,
        };
        let run = match folder.join("run.json").is_file() {
            false => start(self.with_budget(scenario)?, self.run.seed, folder, &options)?,
            true => {
                check_origin(self.study, &self.run, scenario)?;
                resume(folder, None, &options)?
            }
        };
        let outcome = self.controls.follow(run)?;
        match outcome.stopped {
            true => Err(Stopped.into()),
            false => Ok(()),
        }
    }

    /// The scenario with the budget of its arm.
    fn with_budget(&self, scenario: &Scenario) -> Result<Scenario, SingleError> {
        let mut scenario = scenario.clone();
        if self.study.arm(&self.run).base.is_matched() {
            scenario.evolution.generation_limit = self.evolved_generations()?;
        }
        Ok(scenario)
    }

    /// How many generations the evolved run of the same scenario, settings and seed has. It
    /// is looked up where that run is done, and computed where it is not: the answer is
    /// the same, so the order of runs does not matter.
    fn evolved_generations(&self) -> Result<u64, SingleError> {
        let own = self.study.arm(&self.run);
        let is_pair = |arm: &Arm| arm.base == Base::Evolved && arm.settings == own.settings;
        let pair = self.study.plan.arms.iter().position(is_pair);
        if let Some(arm) = pair {
            let folder = self.study.run_folder(&RunId { arm, ..self.run });
            if let Some(outcome) = summary(&folder)? {
                return Ok(outcome.generations);
            }
        }
        let evolved = Arm {
            base: Base::Evolved,
            ..own.clone()
        };
        let scenario = evolved.apply(self.study.scenario(&self.run))?;
        let experiment = experiment(scenario, self.run.seed)?;
        let state = experiment.evolve(&one_worker()?, self.controls.gate())?;
        Ok(state.generation)
    }

    fn evaluate(&self, folder: &Path, scenario: Scenario) -> Result<Fresh, SingleError> {
        let path = folder.join(FRESH);
        let _locked = RunFolder::open(folder)?;
        // Another process may have done it before the lock was free.
        if let Some(fresh) = fresh(folder)? {
            return Ok(fresh);
        }
        let misfit = |message: String| FileError::new(folder.join(SUMMARY), message);
        let best = summary(folder)?.and_then(|outcome| outcome.best);
        let tree = best.map(|best| best.tree);
        let tree = tree.ok_or_else(|| misfit(String::from("names no best individual")))?;
        let plan = self.study.plan.reevaluation;
        let protocol = Protocol {
            warmup: plan.warmup,
            trials: plan.trials,
            repeats: plan.repeats,
            banks: plan.primitive_sets,
        };
        let seed = fresh_seed(&self.run);
        let experiment = experiment(scenario, seed)?;
        let tree = experiment
            .read_tree(&tree)
            .map_err(|error| misfit(format!("best.tree: {error}")))?;
        let (workers, gate) = (one_worker()?, self.controls.gate());
        let scored = experiment.evaluate(&tree, &protocol, &workers, gate, &|_| {})?;
        let fresh = Fresh {
            format: FRESH_FORMAT,
            seed,
            warmup: protocol.warmup,
            evaluation: scored.evaluation,
        };
        let written = serde_json::to_vec(&fresh)
            .map_err(std::io::Error::from)
            .and_then(|bytes| write_atomically(&path, &[bytes.as_slice(), b"\n"].concat()));
        written.map_err(|error| FileError::new(&path, error))?;
        Ok(fresh)
    }
}

/// Each run of a study is computed by one thread; runs share the processors.
fn one_worker() -> Result<Workers, SingleError> {
    Workers::new(1).map_err(|error| SingleError::Threads(error.to_string()))
}

/// The `run.json` of a run, which must be that of the plan's; only its budget may be
/// another.
///
/// # Errors
/// When it cannot be read, or is that of another run.
pub(super) fn check_origin(
    study: &Study,
    run: &RunId,
    expected: &Scenario,
) -> Result<Manifest, SingleError> {
    let folder = study.run_folder(run);
    let manifest = RunFolder::read_manifest(&folder)?;
    let mut found = manifest.scenario.clone();
    if study.arm(run).base.is_matched() {
        found.evolution.generation_limit = expected.evolution.generation_limit;
    }
    match found == *expected && manifest.seed == run.seed {
        true => Ok(manifest),
        false => Err(SingleError::Another {
            path: folder.join("run.json").display().to_string(),
            expected: study.name(run),
        }),
    }
}

/// Whether an evaluation is the one that the plan asks for, of the winner of the run.
///
/// # Errors
/// When it is another: the plan was changed, or the run went on, after it was made.
pub(super) fn check_evaluation(
    study: &Study,
    run: &RunId,
    outcome: &Outcome,
    fresh: &Fresh,
) -> Result<(), SingleError> {
    let plan = study.plan.reevaluation;
    let repeats = &fresh.evaluation.repeats;
    let trials = repeats.iter().map(|repeat| repeat.steps.len());
    let banks = repeats.iter().map(|repeat| repeat.bank + 1).max();
    let winner = outcome.best.as_ref().map(|best| &best.tree);
    let numbers = [
        ("warmup", fresh.warmup, plan.warmup),
        ("repeats", repeats.len(), plan.repeats),
        ("trials", trials.max().unwrap_or(0), plan.trials),
        (
            "banks",
            banks.unwrap_or(0),
            plan.primitive_sets.min(plan.repeats),
        ),
    ];
    let other = numbers
        .into_iter()
        .find(|(_, found, allowed)| found != allowed);
    let message = match other {
        Some((name, found, allowed)) => format!("{name}: found {found}; allowed: {allowed}"),
        None if fresh.seed != fresh_seed(run) => {
            format!("seed: found {}; allowed: {}", fresh.seed, fresh_seed(run))
        }
        None if winner != Some(&fresh.evaluation.tree) => {
            String::from("tree: found another than that of the winner in summary.json")
        }
        None => return Ok(()),
    };
    let message = format!("{message}; remove the file to have the evaluation done again");
    Err(FileError::new(study.run_folder(run).join(FRESH), message).into())
}

/// The seed of the evaluation of a run's winner.
fn fresh_seed(run: &RunId) -> u64 {
    run.seed.wrapping_add(FRESH_SEED_OFFSET)
}

/// The result of the run in a folder; none before it is over.
///
/// # Errors
/// When the file is not a result.
pub(super) fn summary(folder: &Path) -> Result<Option<Outcome>, SingleError> {
    read(folder.join(SUMMARY))
}

/// The evaluation of the winner of the run in a folder; none before it is done.
///
/// # Errors
/// When the file is not an evaluation of this version.
pub(super) fn fresh(folder: &Path) -> Result<Option<Fresh>, SingleError> {
    let path = folder.join(FRESH);
    let fresh: Option<Fresh> = read(path.clone())?;
    match &fresh {
        Some(found) if found.format != FRESH_FORMAT => {
            let message = format!("format: found {}; allowed: {FRESH_FORMAT}", found.format);
            Err(FileError::new(path, message).into())
        }
        _ => Ok(fresh),
    }
}

fn read<T: for<'t> Deserialize<'t>>(path: PathBuf) -> Result<Option<T>, SingleError> {
    // A file that is not there is the usual case while a study is under way.
    if !fs::exists(&path).unwrap_or(true) {
        return Ok(None);
    }
    let value = parse_json(&read_text(&path, MAX_RESULT_BYTES)?);
    Ok(Some(value.map_err(|error| FileError::new(path, error))?))
}
