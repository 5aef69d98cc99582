//! How far the runs of a study are, read from their folders at any time.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::single::{SingleError, fresh, summary};
use super::study::{RunId, Study};
use crate::lab::{Event, Life, Recording, RunError};

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// Its winner has been evaluated.
    Done,
    /// Evolution is over, its winner is being evaluated or waits for that.
    Evolved,
    /// A process works on it.
    Running,
    /// It was begun and nobody works on it.
    Interrupted,
    /// It has not begun.
    Waiting,
    /// Its folder cannot be read.
    Unreadable,
}

impl Stage {
    /// All of them, in the order in which they are listed.
    pub const ALL: [Self; 6] = [
        Self::Done,
        Self::Evolved,
        Self::Running,
        Self::Interrupted,
        Self::Waiting,
        Self::Unreadable,
    ];

    /// In a word, for people.
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

/// How far one run is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunStatus {
    /// The run.
    #[serde(skip)]
    pub run: RunId,
    /// Its number in the study, from 1.
    pub number: usize,
    /// Its name: the folder in the study's.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
    /// How far it is.
    pub stage: Stage,
    /// Generations lived.
    pub generations: u64,
    /// Whether evolution converged; `false` too while it is not over.
    pub converged: bool,
    /// Mean time steps of a scored trial of the best individual, generation by generation,
    /// while it runs; of the last generation alone when it is over.
    pub best_steps: Vec<f64>,
    /// Mean time steps of a trial of its winner's structure, evaluated anew.
    pub fresh_steps: Option<f64>,
    /// Why it is unreadable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trouble: Option<String>,
}

/// How far every run of a study is. Nothing is locked or written; a study of hundreds of
/// runs takes a fraction of a second.
#[must_use]
pub fn status(study: &Study) -> Vec<RunStatus> {
    study
        .runs()
        .into_iter()
        .map(|run| status_of(study, run))
        .collect()
}

fn status_of(study: &Study, run: RunId) -> RunStatus {
    let mut status = RunStatus {
        run,
        number: run.number,
        name: study.name(&run),
        folder: study.run_folder(&run),
        stage: Stage::Waiting,
        generations: 0,
        converged: false,
        best_steps: Vec::new(),
        fresh_steps: None,
        trouble: None,
    };
    if let Err(error) = look(&mut status) {
        status.stage = Stage::Unreadable;
        status.trouble = Some(error);
    }
    status
}

fn look(status: &mut RunStatus) -> Result<(), String> {
    let words = |error: SingleError| error.to_string();
    let folder = &status.folder;
    if let Some(outcome) = summary(folder).map_err(words)? {
        status.generations = outcome.generations;
        status.converged = outcome.converged;
        status.best_steps = outcome.best.iter().map(|best| best.fitness).collect();
        let fresh = fresh(folder).map_err(words)?;
        status.stage = match &fresh {
            Some(_) => Stage::Done,
            None => Stage::Evolved,
        };
        status.fresh_steps = fresh.map(|fresh| fresh.evaluation.mean);
        return Ok(());
    }
    if !folder.join("run.json").is_file() {
        return Ok(());
    }
    let recording = Recording::read(folder).map_err(|error| error.to_string())?;
    for event in &recording.events {
        if let Event::Generation(record) = event {
            status.generations = record.generation;
        }
    }
    status.best_steps = best_steps(&recording.events);
    status.stage = match recording.life {
        Life::Computing => Stage::Running,
        Life::Over => Stage::Evolved,
        Life::Absent | Life::Silent | Life::Stopped => Stage::Interrupted,
    };
    Ok(())
}

/// Mean time steps of a scored trial of the best individual of the run in a folder,
/// generation by generation so far.
///
/// # Errors
/// When the folder holds no run, or its log cannot be read.
pub fn course(folder: &Path) -> Result<Vec<f64>, RunError> {
    Recording::read(folder).map(|recording| best_steps(&recording.events))
}

fn best_steps(events: &[Event]) -> Vec<f64> {
    let steps = events.iter().filter_map(|event| match event {
        Event::Generation(record) => record.mean_trial_steps(1),
        _ => None,
    });
    steps.collect()
}
