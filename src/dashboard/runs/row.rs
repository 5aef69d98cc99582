//! A row of the table, and the status of its run.

use crate::dashboard::look::{Paint, Signs};

/// A run of a study, as shown in the table.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRow {
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the arm: one of the settings that the study compares.
    pub arm: String,
    /// The seed.
    pub seed: u64,
    /// The status.
    pub status: RowStatus,
    /// Complete generations.
    pub generations: u64,
    /// Mean time steps per scored trial of the best individual, one value per generation.
    pub course: Vec<f64>,
    /// Mean time steps per trial of the winner's structure, evaluated again after the run.
    pub fresh: Option<f64>,
    /// The error, if there is one.
    pub trouble: Option<String>,
}

impl RunRow {
    /// Returns the latest value of the course.
    pub(super) fn best(&self) -> Option<f64> {
        self.course.last().copied()
    }
}

/// The status of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum RowStatus {
    /// A process is computing the run.
    Running,
    /// The run has started and has not finished, and no process is computing it.
    Interrupted,
    /// The run folder cannot be read.
    Unreadable,
    /// The run has failed in this program.
    Failed,
    /// Evolution has finished; the winner has not been evaluated yet.
    Evolved,
    /// Evolution and the evaluation of the winner have finished.
    Done,
    /// The run has not started.
    Waiting,
}

impl RowStatus {
    /// All statuses: the active ones and those that need attention first.
    pub const ALL: [Self; 7] = [
        Self::Running,
        Self::Interrupted,
        Self::Unreadable,
        Self::Failed,
        Self::Evolved,
        Self::Done,
        Self::Waiting,
    ];

    /// Returns the status in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Interrupted => "interrupted",
            Self::Unreadable => "unreadable",
            Self::Failed => "failed",
            Self::Evolved => "evolved",
            Self::Done => "done",
            Self::Waiting => "waiting",
        }
    }

    /// Returns the sign of the status, which can be read without colours.
    pub(super) fn sign(self, signs: &Signs) -> &'static str {
        match self {
            Self::Running => signs.running,
            Self::Interrupted => signs.stopped,
            Self::Unreadable | Self::Failed => "!",
            Self::Evolved => signs.stepping,
            Self::Done => signs.finished,
            Self::Waiting => signs.separator,
        }
    }

    pub(super) fn paint(self) -> Paint {
        match self {
            Self::Running => Paint::Active,
            Self::Interrupted => Paint::Notice,
            Self::Unreadable | Self::Failed => Paint::Bad,
            Self::Evolved | Self::Done => Paint::Good,
            Self::Waiting => Paint::Dim,
        }
    }
}
