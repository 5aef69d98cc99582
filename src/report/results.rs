//! The result files of a run: `summary.json`, written when evolution ends, and
//! `evaluation.json`, written when its winner has been evaluated.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::arm::ArmError;
use super::study::{RunId, Study};
use crate::files::{FileError, parse_json, read_text};
use crate::lab::{Evaluation, FolderError, Manifest, Outcome, RunError, RunFolder, SetupError};
use crate::learning::Stopped;
use crate::scenario::Scenario;

/// The file with the result of a run.
pub(super) const SUMMARY: &str = "summary.json";
/// The file with the evaluation of the winner of a run.
pub(super) const EVALUATION: &str = "evaluation.json";

/// Version of the format of `evaluation.json`.
pub(super) const EVALUATION_FORMAT: u32 = 1;

/// Largest `evaluation.json` or `summary.json` that is read, in bytes.
const MAX_RESULT_BYTES: u64 = 1 << 24;

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
    #[error("{path}: holds another run; allowed: that of this study's plan, {expected}")]
    Another {
        /// The file.
        path: String,
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

/// Reads the result of the run in a folder; `None` before evolution has ended.
///
/// # Errors
/// When the file does not hold a result.
pub(super) fn summary(folder: &Path) -> Result<Option<Outcome>, StudyRunError> {
    read(folder.join(SUMMARY))
}

/// Reads the evaluation of the winner of the run in a folder; `None` before it is done.
///
/// # Errors
/// When the file does not hold an evaluation of this version.
pub(super) fn evaluation(folder: &Path) -> Result<Option<WinnerEvaluation>, StudyRunError> {
    let path = folder.join(EVALUATION);
    let found: Option<WinnerEvaluation> = read(path.clone())?;
    match &found {
        Some(WinnerEvaluation { format, .. }) if *format != EVALUATION_FORMAT => {
            let message = format!("format: found {format}; allowed: {EVALUATION_FORMAT}");
            Err(FileError::new(path, message).into())
        }
        _ => Ok(found),
    }
}

fn read<T: for<'t> Deserialize<'t>>(path: PathBuf) -> Result<Option<T>, StudyRunError> {
    // In an unfinished study, a missing file is not an error.
    if !fs::exists(&path).unwrap_or(true) {
        return Ok(None);
    }
    let value = parse_json(&read_text(&path, MAX_RESULT_BYTES)?);
    Ok(Some(value.map_err(|error| FileError::new(path, error))?))
}

/// Returns the seed of the evaluation of a run's winner.
pub(super) fn evaluation_seed(run: &RunId) -> u64 {
    run.seed.wrapping_add(EVALUATION_SEED_OFFSET)
}

/// Reads the `run.json` of a run and checks that it is the run of the plan. If the arm has a
/// matched budget, the generation limit may differ.
///
/// # Errors
/// When it cannot be read, or is that of another run.
pub(super) fn check_origin(
    study: &Study,
    run: &RunId,
    expected: &Scenario,
) -> Result<Manifest, StudyRunError> {
    let folder = study.run_folder(run);
    let manifest = RunFolder::read_manifest(&folder)?;
    let mut found = manifest.scenario.clone();
    if study.arm(run).base.is_matched() {
        found.evolution.generation_limit = expected.evolution.generation_limit;
    }
    if found != *expected || manifest.seed != run.seed {
        return Err(StudyRunError::Another {
            path: folder.join("run.json").display().to_string(),
            expected: study.name(run),
        });
    }
    Ok(manifest)
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
