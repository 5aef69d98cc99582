//! A study: its plan, its folder and its runs.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::addition;
use super::arm::Arm;
use super::numbers::Numbers;
use super::plan::{PLAN_FILE, PLAN_LIMITS, Plan};
use super::plan_error::PlanError;
use crate::files::{FileError, read_text, write_atomically};
use crate::lab::{Difference, told};
use crate::scenario::Scenario;

/// A study: a plan and the folder of its runs.
///
/// ```text
/// DIR/
///   study.json                            the plan, scenarios and arms written out
///   SCENARIO/ARM/seed-N/                  a run folder
///   SCENARIO/ARM/seed-N/evaluation.json   the evaluation of its winner
///   report/                               the output of `study report`
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// The plan.
    pub plan: Plan,
    /// The folder.
    pub folder: PathBuf,
}

/// Identifies a run of a study.
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
    /// The plan cannot be used.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The folder has no `study.json`.
    #[error("{path}: holds no study.json; allowed: the folder of a study")]
    NotAStudy {
        /// The folder.
        path: String,
    },
    /// The folder holds the study of another plan.
    #[error(
        "{path}: holds the study of another plan: {}; allowed: another folder, or the plan that \
         {path}/study.json says{}",
        told(.differences),
        .command.as_ref().map_or_else(String::new, |command| format!("; to add what is new: {command}"))
    )]
    Another {
        /// The folder.
        path: String,
        /// How its plan differs from the one that was wanted.
        differences: Vec<Difference>,
        /// The command that adds to the study what is lacking, if that is all.
        command: Option<String>,
    },
    /// The study has no such run.
    #[error("--only: found {found:?}; allowed: {allowed}")]
    NoSuchRun {
        /// The name that was given.
        found: String,
        /// The names that exist.
        allowed: String,
    },
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl Study {
    /// Opens the study of a plan in a folder. Creates both if the folder holds no study.
    ///
    /// # Errors
    /// When the folder holds the study of another plan, or the operating system refuses.
    pub fn create(plan: Plan, folder: &Path) -> Result<Self, StudyError> {
        let file = folder.join(PLAN_FILE);
        let refused = |error: io::Error| FileError::new(&file, error);
        if file.exists() {
            let study = Self::open(folder)?;
            if study.plan != plan {
                return Err(StudyError::Another {
                    path: folder.display().to_string(),
                    differences: study.plan.differences(&plan),
                    command: addition::command(folder, &study.plan, &plan),
                });
            }
            return Ok(study);
        }
        fs::create_dir_all(folder).map_err(refused)?;
        let study = Self {
            plan,
            folder: folder.to_owned(),
        };
        study.write_plan()?;
        Ok(study)
    }

    /// Gives the study another plan, which must have all the runs of the present one. Runs that exist
    /// stay as they are.
    ///
    /// # Errors
    /// When the operating system refuses.
    pub(super) fn grow(&mut self, plan: Plan) -> Result<(), StudyError> {
        self.plan = plan;
        self.write_plan()
    }

    /// Adds those of these seeds and arms that the study lacks, and returns the number of new runs.
    ///
    /// # Errors
    /// When the plan cannot be carried out with them, or the operating system refuses.
    pub fn add(&mut self, seeds: Option<&Numbers>, arms: Vec<Arm>) -> Result<usize, StudyError> {
        let before = self.runs().len();
        let plan = self.plan.with_more(seeds, arms)?;
        if plan != self.plan {
            self.grow(plan)?;
        }
        Ok(self.runs().len() - before)
    }

    fn write_plan(&self) -> Result<(), StudyError> {
        let file = self.folder.join(PLAN_FILE);
        let refused = |error: io::Error| FileError::new(&file, error);
        let text = self.plan.to_file();
        let text = text.map_err(|error| refused(error.into()))?;
        Ok(write_atomically(&file, &text).map_err(refused)?)
    }

    /// Returns whether a folder holds a study.
    #[must_use]
    pub fn is_in(folder: &Path) -> bool {
        folder.join(PLAN_FILE).is_file()
    }

    /// Opens the study in a folder.
    ///
    /// # Errors
    /// When the folder holds no study, or its `study.json` is not a plan.
    pub fn open(folder: &Path) -> Result<Self, StudyError> {
        let file = folder.join(PLAN_FILE);
        if !Self::is_in(folder) {
            return Err(StudyError::NotAStudy {
                path: folder.display().to_string(),
            });
        }
        let name = file.display().to_string();
        let text = read_text(&file, PLAN_LIMITS.bytes)?;
        Ok(Self {
            plan: Plan::parse(&text, &name, folder)?,
            folder: folder.to_owned(),
        })
    }

    /// Returns all runs in the order in which they are done.
    ///
    /// Seeds vary slowest, so that an interrupted study has about as many runs of every scenario
    /// and arm. Scenarios vary fastest, so that an arm with a matched budget finds the evolved run
    /// done if the evolved arm comes first in the plan.
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

    /// Returns the runs with a name: a number, a list of numbers and ranges, or
    /// `SCENARIO/ARM/seed-N`.
    ///
    /// # Errors
    /// When the study has no such run.
    pub fn find(&self, name: &str) -> Result<Vec<RunId>, StudyError> {
        let runs = self.runs();
        let last = runs.len();
        let numbers: Option<Numbers> = name.parse().ok();
        let exists = |number| (1..=last as u64).contains(&number);
        let all_exist = numbers
            .as_ref()
            .is_none_or(|numbers| numbers.iter().all(exists));
        let is_named = |run: &RunId| match &numbers {
            Some(numbers) => all_exist && numbers.contains(run.number as u64),
            None => self.name(run) == name,
        };
        let found: Vec<_> = runs.into_iter().filter(is_named).collect();
        if found.is_empty() {
            return Err(StudyError::NoSuchRun {
                found: name.to_owned(),
                allowed: format!(
                    "1 to {last}, or SCENARIO/ARM/seed-N as 'study commands' lists them"
                ),
            });
        }
        Ok(found)
    }

    /// Returns the name of a run: its folder relative to that of the study.
    #[must_use]
    pub fn name(&self, run: &RunId) -> String {
        let (scenario, arm) = (&self.scenario(run).name, &self.arm(run).name);
        format!("{scenario}/{arm}/seed-{}", run.seed)
    }

    /// Returns the folder of a run.
    #[must_use]
    pub fn run_folder(&self, run: &RunId) -> PathBuf {
        self.folder.join(self.name(run))
    }

    /// Returns the scenario of a run, without the changes of its arm.
    #[must_use]
    pub fn scenario(&self, run: &RunId) -> &Scenario {
        &self.plan.scenarios[run.scenario]
    }

    /// Returns the arm of a run.
    #[must_use]
    pub fn arm(&self, run: &RunId) -> &Arm {
        &self.plan.arms[run.arm]
    }
}
