//! The progress of this process on the runs of a study, for the bar and for the table.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::ProgressBar;

use crate::cli::output;
use crate::cli::progress;
use crate::dashboard::Work;
use crate::report::{Pace, RunId, Study, StudyEvent};

/// The progress of this process.
pub(super) struct Progress {
    study: Study,
    jobs: usize,
    bar: ProgressBar,
    state: Mutex<State>,
}

struct State {
    pace: Pace,
    /// Errors of failed runs, by run number.
    failures: BTreeMap<usize, String>,
    /// Whether the bar is shown; while a table has the screen, standard error is not written.
    is_shown: bool,
    is_over: bool,
}

/// The part of this process in a study, as the table shows it.
#[derive(Clone, Debug, Default)]
pub(super) struct OwnProgress {
    /// Its work, until that ends.
    pub(super) work: Option<Work>,
    /// Errors of failed runs, by run number.
    pub(super) failures: BTreeMap<usize, String>,
}

impl Progress {
    /// The start: all of `runs` are to do, `jobs` at a time. Nothing is shown yet.
    pub(super) fn new(study: &Study, runs: &[RunId], jobs: usize) -> Self {
        let template = "{bar:20} {pos}/{len} runs, {elapsed}  {wide_msg}";
        let bar = progress::hidden(runs.len() as u64, template);
        Self {
            study: study.clone(),
            jobs,
            bar,
            state: Mutex::new(State {
                pace: Pace::of(runs),
                failures: BTreeMap::new(),
                is_shown: false,
                is_over: false,
            }),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Shows the bar from now on, after the errors so far.
    pub(super) fn show(&self) {
        let mut state = self.state();
        if !state.is_shown {
            state.is_shown = true;
            state
                .failures
                .values()
                .for_each(|message| output::message(message));
            progress::show(&self.bar);
        }
    }

    /// Updates the progress after an event.
    pub(super) fn update(&self, event: &StudyEvent) {
        let mut state = self.state();
        let (run, took) = match event {
            StudyEvent::Started(_) => return,
            StudyEvent::Done { run, took, .. } => (run, Some(*took)),
            StudyEvent::Elsewhere(run) => (run, None),
            StudyEvent::Failed { run, error } => {
                let message = format!("error: {}: {error}", self.study.name(run));
                if state.is_shown {
                    self.bar.suspend(|| output::message(&message));
                }
                state.failures.insert(run.number, message);
                (run, None)
            }
        };
        state.pace.note(run, took);
        self.bar.inc(1);
        let left = state.pace.left(self.jobs).map(|left| {
            let whole = Duration::from_secs(left.as_secs());
            format!("about {} left; ", humantime::format_duration(whole))
        });
        let left = left.unwrap_or_default();
        self.bar
            .set_message(format!("{left}last run: {}", self.study.name(run)));
    }

    /// Records that the work is over.
    pub(super) fn end(&self) {
        self.state().is_over = true;
    }

    /// Whether the work is over.
    pub(super) fn is_over(&self) -> bool {
        self.state().is_over
    }

    /// The progress now.
    pub(super) fn own(&self) -> OwnProgress {
        let state = self.state();
        let left = state.pace.left(self.jobs);
        OwnProgress {
            work: (!state.is_over).then_some(Work { left }),
            failures: state.failures.clone(),
        }
    }

    /// Removes the bar, prints errors that are not printed yet, and returns the number of
    /// failed runs.
    pub(super) fn finish(&self) -> usize {
        self.show();
        self.bar.finish_and_clear();
        self.state().failures.len()
    }
}
