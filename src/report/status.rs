//! The states of a study's runs, read from their folders at any time.

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;

use super::results::{PlannedRun, StudyRunError, evaluation};
use super::study::{RunId, Study};
use crate::files::Stamp;
use crate::lab::{
    EVALUATION, Event, Follower, LastSign, Liveness, MANIFEST, News, Recording, RunError, SUMMARY,
};

/// The state of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RunState {
    /// It is done: its winner has been evaluated.
    Done,
    /// Evolution has ended; its winner has not been evaluated yet.
    Evolved,
    /// A process is working on it.
    Running,
    /// It was started, and no process is working on it.
    Interrupted,
    /// It has not been started.
    Waiting,
    /// Its folder cannot be read.
    Unreadable,
}

impl RunState {
    /// All states, in the order in which they are listed.
    pub const ALL: [Self; 6] = [
        Self::Done,
        Self::Evolved,
        Self::Running,
        Self::Interrupted,
        Self::Waiting,
        Self::Unreadable,
    ];

    /// Returns the state in one word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Evolved => "evolved",
            Self::Running => "running",
            Self::Interrupted => "interrupted",
            Self::Waiting => "waiting",
            Self::Unreadable => "unreadable",
        }
    }
}

/// The state and the results of one run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunStatus {
    /// The run.
    #[serde(skip)]
    pub run: RunId,
    /// Its number in the study, from 1.
    pub number: usize,
    /// Its name: its folder relative to that of the study.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
    /// Its state.
    pub stage: RunState,
    /// Finished generations.
    pub generations: u64,
    /// Whether evolution has converged.
    pub converged: bool,
    /// Mean time steps of a scored trial of the best individual, for each generation. When
    /// evolution has ended, for the last generation only.
    pub best_steps: Vec<f64>,
    /// Mean time steps of a trial in the evaluation of its winner.
    pub fresh_steps: Option<f64>,
    /// The last sign of the process that worked on it, if that is gone and left the work undone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_sign: Option<LastSign>,
    /// The cause if it is unreadable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trouble: Option<String>,
}

/// Returns the status of every run of a study.
///
/// It locks and writes nothing, and takes a fraction of a second for hundreds of runs.
#[must_use]
pub fn status(study: &Study) -> Vec<RunStatus> {
    StatusWatch::of(study).look()
}

/// Follows the runs of a study. Each look reads only what has changed since the last one.
#[derive(Debug)]
pub struct StatusWatch {
    runs: Vec<Watched>,
}

impl StatusWatch {
    /// Creates a watch of all runs of a study, including those that have not been started.
    #[must_use]
    pub fn of(study: &Study) -> Self {
        let runs = study.runs().into_iter();
        Self {
            runs: runs.map(|run| Watched::of(study, run)).collect(),
        }
    }

    /// Returns the status of every run now, in the order of the study.
    #[must_use]
    pub fn look(&mut self) -> Vec<RunStatus> {
        let now = Instant::now();
        let look = |run: &mut Watched| run.look(now).clone();
        self.runs.iter_mut().map(look).collect()
    }
}

fn waiting(study: &Study, run: RunId) -> RunStatus {
    RunStatus {
        run,
        number: run.number,
        name: study.name(&run),
        folder: study.run_folder(&run),
        stage: RunState::Waiting,
        generations: 0,
        converged: false,
        best_steps: Vec::new(),
        fresh_steps: None,
        last_sign: None,
        trouble: None,
    }
}

/// A run that is followed.
#[derive(Debug)]
struct Watched {
    /// Its status as long as it has no folder.
    waiting: RunStatus,
    planned: Result<PlannedRun, String>,
    status: RunStatus,
    /// The versions of its result files that were read last.
    results: [Option<Stamp>; 2],
    /// Follows its log until evolution has ended.
    follower: Option<Followed>,
}

impl Watched {
    fn of(study: &Study, run: RunId) -> Self {
        let waiting = waiting(study, run);
        Self {
            status: waiting.clone(),
            planned: PlannedRun::of(study, &run).map_err(|error| error.to_string()),
            waiting,
            results: [None; 2],
            follower: None,
        }
    }

    fn look(&mut self, now: Instant) -> &RunStatus {
        let folder = &self.waiting.folder;
        let results = [SUMMARY, EVALUATION].map(|name| Stamp::of(&folder.join(name)));
        let is_over = results[0].is_some();
        if is_over && results == self.results {
            return &self.status;
        }
        self.results = results;
        let mut status = self.waiting.clone();
        let looked = match &self.planned {
            Ok(planned) if is_over => {
                self.follower = None;
                read_results(planned, &mut status).map_err(|error| error.to_string())
            }
            Ok(planned) => follow(&mut self.follower, planned, &mut status, now)
                .map_err(|error| error.to_string()),
            Err(message) => Err(message.clone()),
        };
        if let Err(trouble) = looked {
            status.stage = RunState::Unreadable;
            status.trouble = Some(trouble);
        }
        self.status = status;
        &self.status
    }
}

/// Reads what is new of a run whose evolution has not ended.
fn follow(
    follower: &mut Option<Followed>,
    planned: &PlannedRun,
    status: &mut RunStatus,
    now: Instant,
) -> Result<(), StudyRunError> {
    if !status.folder.join(MANIFEST).is_file() {
        *follower = None;
        return Ok(());
    }
    let follower = follower.get_or_insert_with(|| Followed::of(&status.folder));
    follower.look(now, planned)?;
    status.generations = follower.generations;
    status.best_steps.clone_from(&follower.best_steps);
    status.last_sign.clone_from(&follower.last_sign);
    status.stage = match follower.liveness {
        Liveness::Computing => RunState::Running,
        Liveness::Over => RunState::Evolved,
        Liveness::Absent | Liveness::Silent | Liveness::Stopped => RunState::Interrupted,
    };
    Ok(())
}

/// Reads the results of a run whose evolution has ended.
fn read_results(planned: &PlannedRun, status: &mut RunStatus) -> Result<(), StudyRunError> {
    if let Some(outcome) = planned.outcome()? {
        status.generations = outcome.generations;
        status.converged = outcome.converged;
        status.best_steps = outcome.best.iter().map(|best| best.fitness).collect();
        let fresh = evaluation(&status.folder)?;
        status.stage = fresh.as_ref().map_or(RunState::Evolved, |_| RunState::Done);
        status.last_sign = match status.stage {
            RunState::Evolved => LastSign::read(&status.folder),
            _ => None,
        };
        status.fresh_steps = fresh.map(|fresh| fresh.evaluation.mean);
    }
    Ok(())
}

/// The generations of a run whose log is followed.
#[derive(Debug)]
struct Followed {
    follower: Follower,
    generations: u64,
    best_steps: Vec<f64>,
    liveness: Liveness,
    last_sign: Option<LastSign>,
}

impl Followed {
    fn of(folder: &Path) -> Self {
        Self {
            follower: Follower::of(folder),
            generations: 0,
            best_steps: Vec::new(),
            liveness: Liveness::Stopped,
            last_sign: None,
        }
    }

    fn look(&mut self, now: Instant, planned: &PlannedRun) -> Result<(), StudyRunError> {
        let mut all = Vec::new();
        self.follower.update(now, &mut all)?;
        for news in all {
            match news {
                News::Run(manifest) => {
                    planned.check(&manifest)?;
                    (self.generations, self.best_steps) = (0, Vec::new());
                }
                News::Event(Event::Generation(record)) => {
                    self.generations = record.generation;
                    self.best_steps.extend(record.mean_trial_steps(1));
                }
                News::Liveness(life) => {
                    self.liveness = life;
                    self.last_sign = None;
                }
                News::LastSign(sign) => self.last_sign = Some(sign),
                News::Event(_) | News::Trouble(_) => {}
            }
        }
        Ok(())
    }
}

/// Returns, for each finished generation of the run in a folder, the mean time steps of a scored
/// trial of the best individual.
///
/// # Errors
/// When the folder holds no run, or its log cannot be read.
pub fn course(folder: &Path) -> Result<Vec<f64>, RunError> {
    let recording = Recording::read(folder)?;
    let steps = recording.events.iter().filter_map(|event| match event {
        Event::Generation(record) => record.mean_trial_steps(1),
        _ => None,
    });
    Ok(steps.collect())
}
