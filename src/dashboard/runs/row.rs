//! A row of the table, and how its run stands.

use crate::dashboard::look::{Paint, Signs};

/// A run of a study, as the table shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRow {
    /// Name of its scenario.
    pub scenario: String,
    /// Name of its arm: the settings that are studied.
    pub arm: String,
    /// Its seed.
    pub seed: u64,
    /// How it stands.
    pub standing: Standing,
    /// Generations lived.
    pub generations: u64,
    /// Mean time steps of a scored trial of the best individual, generation by generation.
    pub course: Vec<f64>,
    /// Mean time steps of a trial of its winner's structure, evaluated anew.
    pub fresh: Option<f64>,
    /// What is wrong with it.
    pub trouble: Option<String>,
}

impl RunRow {
    /// Mean time steps of a scored trial of the best individual so far as is known.
    pub(super) fn best(&self) -> Option<f64> {
        self.course.last().copied()
    }
}

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Standing {
    /// A process works on it.
    Running,
    /// It was begun, is not over, and nobody works on it.
    BrokenOff,
    /// Its folder cannot be read.
    Unreadable,
    /// This program could not do it.
    Failed,
    /// Evolution is over, its winner is not evaluated yet.
    Evolved,
    /// All is done.
    Done,
    /// It has not begun.
    Waiting,
}

impl Standing {
    /// All of them, what goes on and what asks for attention first.
    pub const ALL: [Self; 7] = [
        Self::Running,
        Self::BrokenOff,
        Self::Unreadable,
        Self::Failed,
        Self::Evolved,
        Self::Done,
        Self::Waiting,
    ];

    /// In a word or two.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::BrokenOff => "broken off",
            Self::Unreadable => "unreadable",
            Self::Failed => "failed",
            Self::Evolved => "evolved",
            Self::Done => "done",
            Self::Waiting => "waiting",
        }
    }

    /// In a sign, so that it is told without colours and reading.
    pub(super) fn sign(self, signs: &Signs) -> &'static str {
        match self {
            Self::Running => signs.running,
            Self::BrokenOff => signs.stopped,
            Self::Unreadable | Self::Failed => "!",
            Self::Evolved => signs.stepping,
            Self::Done => signs.finished,
            Self::Waiting => signs.separator,
        }
    }

    pub(super) fn paint(self) -> Paint {
        match self {
            Self::Running => Paint::Active,
            Self::BrokenOff => Paint::Notice,
            Self::Unreadable | Self::Failed => Paint::Bad,
            Self::Evolved | Self::Done => Paint::Good,
            Self::Waiting => Paint::Dim,
        }
    }
}
