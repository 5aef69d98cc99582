//! The folder of a study, and the runs that it has.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::arm::Arm;
use super::plan::{PLAN_FILE, Plan};
use super::plan_error::PlanError;
use crate::files::{FileError, read_text, write_atomically};
use crate::scenario::Scenario;

/// A study: a plan and the folder of its runs.
///
/// ```text
/// DIR/
///   study.json                            the plan, scenarios and arms written out
///   SCENARIO/ARM/seed-N/                  a run folder
///   SCENARIO/ARM/seed-N/evaluation.json   its winner, evaluated anew
///   report/                               what 'study report' writes
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// The plan.
    pub plan: Plan,
    /// The folder.
    pub folder: PathBuf,
}

/// One run of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RunId {
    /// Its number in the study, from 1.
    pub number: usize,
    /// Index of its scenario in the plan.
    pub scenario: usize,
    /// Index of its arm in the plan.
    pub arm: usize,
    /// Its seed.
    pub seed: u64,
}

/// Why a study cannot be used.
#[derive(Debug, Error)]
pub enum StudyError {
    /// Its plan cannot be used.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The folder has no `study.json`.
    #[error("{path}: holds no study.json; allowed: the folder of a study")]
    NotAStudy {
        /// The folder.
        path: String,
    },
    /// The folder holds another study.
    #[error(
        "{path}: holds the study of another plan; allowed: another folder, or the plan that \
         {path}/study.json says"
    )]
    Another {
        /// The folder.
        path: String,
    },
    /// The study has no such run.
    #[error("--only: found {found:?}; allowed: {allowed}")]
    NoSuchRun {
        /// What was asked for.
        found: String,
        /// What there is.
        allowed: String,
    },
    /// The operating system refused.
    #[error(transparent)]
    File(#[from] FileError),
}

impl Study {
    /// The study of a plan in a folder, which is made if it is not there.
    ///
    /// # Errors
    /// When the folder holds the study of another plan, or the operating system refuses.
    pub fn create(plan: Plan, folder: &Path) -> Result<Self, StudyError> {
        let file = folder.join(PLAN_FILE);
        let refused = |error: io::Error| FileError::new(&file, error);
        if file.exists() {
            let study = Self::open(folder)?;
            return match study.plan == plan {
                true => Ok(study),
                false => Err(StudyError::Another {
                    path: folder.display().to_string(),
                }),
            };
        }
        fs::create_dir_all(folder).map_err(refused)?;
        let text = plan.to_file().map_err(|error| refused(error.into()))?;
        write_atomically(&file, &text).map_err(refused)?;
        Ok(Self {
            plan,
            folder: folder.to_owned(),
        })
    }

    /// Whether a folder is that of a study.
    #[must_use]
    pub fn is_in(folder: &Path) -> bool {
        folder.join(PLAN_FILE).is_file()
    }

    /// The study in a folder.
    ///
    /// # Errors
    /// When the folder holds none, or its `study.json` is not a plan.
    pub fn open(folder: &Path) -> Result<Self, StudyError> {
        let file = folder.join(PLAN_FILE);
        if !Self::is_in(folder) {
            return Err(StudyError::NotAStudy {
                path: folder.display().to_string(),
            });
        }
        let name = file.display().to_string();
        let text = read_text(&file, super::plan::MAX_PLAN_BYTES)?;
        Ok(Self {
            plan: Plan::parse(&text, &name, folder)?,
            folder: folder.to_owned(),
        })
    }

    /// All runs in the order in which they are done: seed by seed, so that a study that is
    /// broken off has about as many of every kind; arm by arm, so that the arms which
    /// need the length of an evolved run find it if that arm comes first.
    #[must_use]
    pub fn runs(&self) -> Vec<RunId> {
        let plan = &self.plan;
        let mut runs = Vec::new();
        for seed in plan.seeds.iter() {
            for arm in 0..plan.arms.len() {
                for scenario in 0..plan.scenarios.len() {
                    runs.push(RunId {
                        number: runs.len() + 1,
                        scenario,
                        arm,
                        seed,
                    });
                }
            }
        }
        runs
    }

    /// The runs named: by number, by range of numbers, or by `SCENARIO/ARM/seed-N`.
    ///
    /// # Errors
    /// When there is no such run.
    pub fn find(&self, name: &str) -> Result<Vec<RunId>, StudyError> {
        let runs = self.runs();
        let last = runs.len();
        let numbers: Option<super::numbers::Numbers> = name.parse().ok();
        let found: Vec<_> = match &numbers {
            Some(numbers) => {
                let beyond = numbers.iter().find(|&n| n == 0 || n > last as u64);
                let within = runs
                    .into_iter()
                    .filter(|run| numbers.contains(run.number as u64));
                if beyond.is_some() {
                    Vec::new()
                } else {
                    within.collect()
                }
            }
            None => runs
                .into_iter()
                .filter(|run| self.name(run) == name)
                .collect(),
        };
        match found.is_empty() {
            false => Ok(found),
            true => Err(StudyError::NoSuchRun {
                found: name.to_owned(),
                allowed: format!(
                    "1 to {last}, or SCENARIO/ARM/seed-N as 'study commands' lists them"
                ),
            }),
        }
    }

    /// The name of a run: its folder in the study's.
    #[must_use]
    pub fn name(&self, run: &RunId) -> String {
        let (scenario, arm) = (&self.scenario(run).name, &self.arm(run).name);
        format!("{scenario}/{arm}/seed-{}", run.seed)
    }

    /// The folder of a run.
    #[must_use]
    pub fn run_folder(&self, run: &RunId) -> PathBuf {
        self.folder.join(self.name(run))
    }

    /// The scenario of a run, before its arm is applied.
    #[must_use]
    pub fn scenario(&self, run: &RunId) -> &Scenario {
        &self.plan.scenarios[run.scenario]
    }

    /// The arm of a run.
    #[must_use]
    pub fn arm(&self, run: &RunId) -> &Arm {
        &self.plan.arms[run.arm]
    }
}
