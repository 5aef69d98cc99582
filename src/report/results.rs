//! The result files of a run: `summary.json`, written when evolution ends, and
//! `evaluation.json`, written when its winner has been evaluated.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::json;
use thiserror::Error;

use super::arm::ArmError;
use super::study::{RunId, Study};
use crate::files::{FileError, Limits, read_json};
use crate::lab::{
    Difference, EVALUATION, Evaluation, FolderError, MANIFEST, Manifest, Outcome, RunError,
    RunFolder, SetupError, check_log, differences_in, told,
};
use crate::learning::Stopped;
use crate::scenario::Scenario;

/// Version of the format of `evaluation.json`.
pub(super) const EVALUATION_FORMAT: u32 = 1;

/// Limits of `evaluation.json`.
const LIMITS: Limits = Limits {
    bytes: 1 << 24,
    depth: 8,
    values: 1 << 22,
};

/// Difference between the seed of a run and the seed of its winner's evaluation. It is far larger
/// than the seeds that people choose, so an evaluation shares neither primitive subtasks nor
/// trials with any run.
const EVALUATION_SEED_OFFSET: u64 = 1 << 40;

/// `evaluation.json`: the evaluation of the winner of a run on fresh trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WinnerEvaluation {
    /// Version of this format.
    pub format: u32,
    /// Seed of the evaluation.
    pub seed: u64,
    /// Trials of each repeat that came before the scored ones.
    pub warmup: usize,
    /// The evaluation.
    pub evaluation: Evaluation,
}

/// Why a run of a study cannot be done, or its results cannot be used.
#[derive(Debug, Error)]
pub enum StudyRunError {
    /// The run was stopped before it was done. It can be resumed.
    #[error("stopped")]
    Stopped(#[from] Stopped),
    /// The arm does not fit the scenario.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// The experiment of the scenario cannot be built.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The run folder cannot be used.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The run cannot start, or has failed.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The folder holds another run than that of the plan.
    #[error(
        "{path}: holds another run: {}; allowed: that of this study's plan, {expected}",
        told(.differences)
    )]
    Another {
        /// The file.
        path: String,
        /// How it differs from the run of the plan.
        differences: Vec<Difference>,
        /// Name of the run of the plan.
        expected: String,
    },
    /// A file of the run cannot be read or written, or its content is not allowed.
    #[error(transparent)]
    File(#[from] FileError),
    /// The operating system refuses to start threads.
    #[error("cannot start threads: {0}")]
    Threads(String),
}

/// Reads the evaluation of the winner of the run in a folder; `None` before it is done.
///
/// # Errors
/// When the file does not hold an evaluation of this version.
pub(super) fn evaluation(folder: &Path) -> Result<Option<WinnerEvaluation>, StudyRunError> {
    let path = folder.join(EVALUATION);
    // In an unfinished study, a missing file is not an error.
    let Some(found) = read_json::<WinnerEvaluation>(&path, LIMITS)? else {
        return Ok(None);
    };
    if found.format != EVALUATION_FORMAT {
        let message = format!(
            "format: found {}; allowed: {EVALUATION_FORMAT}",
            found.format
        );
        return Err(FileError::new(path, message).into());
    }
    Ok(Some(found))
}

/// Returns the seed of the evaluation of a run's winner.
pub(super) fn evaluation_seed(run: &RunId) -> u64 {
    run.seed.wrapping_add(EVALUATION_SEED_OFFSET)
}

/// A run as the plan of its study wants it.
#[derive(Clone, Debug)]
pub(super) struct PlannedRun {
    /// The scenario with the settings of the arm.
    pub(super) scenario: Scenario,
    run: RunId,
    name: String,
    /// The run folder.
    pub(super) folder: PathBuf,
    /// Whether the generation limit is that of another run.
    is_matched: bool,
}

impl PlannedRun {
    /// Returns the run of the plan.
    ///
    /// # Errors
    /// When the arm does not fit the scenario.
    pub(super) fn of(study: &Study, run: &RunId) -> Result<Self, ArmError> {
        let arm = study.arm(run);
        Ok(Self {
            scenario: arm.apply(study.scenario(run))?,
            run: *run,
            name: study.name(run),
            folder: study.run_folder(run),
            is_matched: arm.base.is_matched(),
        })
    }

    /// Reads the `run.json` of the run and checks that it is the run of the plan.
    ///
    /// # Errors
    /// When it cannot be read, or is that of another run.
    pub(super) fn manifest(&self) -> Result<Manifest, StudyRunError> {
        let manifest = RunFolder::read_manifest(&self.folder)?;
        self.check(&manifest)?;
        Ok(manifest)
    }

    /// Checks that `manifest` is that of the run of the plan.
    ///
    /// # Errors
    /// When it is that of another run.
    pub(super) fn check(&self, manifest: &Manifest) -> Result<(), StudyRunError> {
        let mut expected = self.scenario.clone();
        if self.is_matched {
            expected.evolution.generation_limit = manifest.scenario.evolution.generation_limit;
        }
        if manifest.scenario != expected || manifest.seed != self.run.seed {
            return Err(StudyRunError::Another {
                path: self.folder.join(MANIFEST).display().to_string(),
                differences: differences_in(
                    &json!({ "scenario": manifest.scenario, "seed": manifest.seed }),
                    &json!({ "scenario": expected, "seed": self.run.seed }),
                ),
                expected: self.name.clone(),
            });
        }
        Ok(())
    }

    /// Reads the result of the run; `None` before evolution has ended. A result counts only if the
    /// folder holds the run of the plan with its whole log.
    ///
    /// # Errors
    /// When the folder holds another run, or a file is damaged.
    pub(super) fn outcome(&self) -> Result<Option<Outcome>, StudyRunError> {
        let Some(outcome) = Outcome::read(&self.folder)? else {
            return Ok(None);
        };
        check_log(&self.folder, &self.manifest()?)?;
        Ok(Some(outcome))
    }
}

/// Checks that an evaluation is the one that the plan asks for, of the winner of the run.
///
/// # Errors
/// When it is not. The plan was changed, or the run was resumed, after the evaluation.
pub(super) fn check_evaluation(
    study: &Study,
    run: &RunId,
    outcome: &Outcome,
    found: &WinnerEvaluation,
) -> Result<(), StudyRunError> {
    let plan = study.plan.reevaluation;
    let repeats = &found.evaluation.repeats;
    let trials = repeats.iter().map(|repeat| repeat.steps.len()).max();
    let sets = repeats.iter().map(|repeat| repeat.primitive_set + 1).max();
    let planned_sets = plan.primitive_sets.min(plan.repeats);
    let numbers = [
        ("warmup", found.warmup as u64, plan.warmup as u64),
        ("repeats", repeats.len() as u64, plan.repeats as u64),
        ("trials", trials.unwrap_or(0) as u64, plan.trials as u64),
        ("banks", sets.unwrap_or(0) as u64, planned_sets as u64),
        ("seed", found.seed, evaluation_seed(run)),
    ];
    let winner = outcome.best.as_ref().map(|best| &best.tree);
    let message = match numbers.iter().find(|(_, found, allowed)| found != allowed) {
        Some((name, found, allowed)) => format!("{name}: found {found}; allowed: {allowed}"),
        None if winner != Some(&found.evaluation.tree) => {
            String::from("tree: found another than that of the winner in summary.json")
        }
        None => return Ok(()),
    };
    let message = format!("{message}; remove the file to repeat the evaluation");
    Err(FileError::new(study.run_folder(run).join(EVALUATION), message).into())
}
