//! ExecutionArgs far this program's work on the runs of a study is: as a bar, and for the table.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::ProgressBar;

use crate::cli::output;
use crate::cli::progress;
use crate::dashboard::Work;
use crate::report::{Pace, RunId, Study, StudyEvent};

/// Progress of the work on runs of a study.
pub(super) struct Progress {
    study: Study,
    jobs: usize,
    bar: ProgressBar,
    state: Mutex<State>,
}

struct State {
    pace: Pace,
    /// Why runs cannot be done, by their numbers.
    failures: BTreeMap<usize, String>,
    /// Whether standard error may be written to: no table has the screen.
    is_said: bool,
    is_over: bool,
}

/// What this program does on the runs of a study.
#[derive(Clone, Debug, Default)]
pub(super) struct Own {
    /// Its work, while it goes on.
    pub(super) work: Option<Work>,
    /// Why runs cannot be done, by their numbers.
    pub(super) failures: BTreeMap<usize, String>,
}

impl Progress {
    /// With all of these runs to do, so many at a time; nothing is shown yet.
    pub(super) fn new(study: &Study, runs: &[RunId], jobs: usize) -> Self {
        let bar = progress::bar(runs.len() as u64, false);
        if let Ok(style) =
            indicatif::ProgressStyle::with_template("{bar:20} {pos}/{len} {elapsed}  {wide_msg}")
        {
            bar.set_style(style);
        }
        Self {
            study: study.clone(),
            jobs,
            bar,
            state: Mutex::new(State {
                pace: Pace::of(runs),
                failures: BTreeMap::new(),
                is_said: false,
                is_over: false,
            }),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Shows itself on standard error from now on, and says what failed before.
    pub(super) fn appear(&self) {
        let mut state = self.state();
        if !state.is_said {
            state.is_said = true;
            state.failures.values().for_each(|why| output::message(why));
            progress::appear(&self.bar);
        }
    }

    /// Takes in what happened to a run.
    pub(super) fn tell(&self, happening: &StudyEvent) {
        let mut state = self.state();
        let (run, took) = match happening {
            StudyEvent::Started(_) => return,
            StudyEvent::Done { run, took, .. } => (run, Some(*took)),
            StudyEvent::Elsewhere(run) => (run, None),
            StudyEvent::Failed { run, error } => {
                let why = format!("error: {}: {error}", self.study.name(run));
                if state.is_said {
                    self.bar.suspend(|| output::message(&why));
                }
                state.failures.insert(run.number, why);
                (run, None)
            }
        };
        state.pace.note(run, took);
        self.bar.inc(1);
        let left = state.pace.left(self.jobs).map(|left| {
            let whole = Duration::from_secs(left.as_secs());
            format!("about {} left, ", humantime::format_duration(whole))
        });
        let left = left.unwrap_or_default();
        self.bar
            .set_message(format!("{left}last: {}", self.study.name(run)));
    }

    /// The work is over.
    pub(super) fn end(&self) {
        self.state().is_over = true;
    }

    /// Whether the work is over.
    pub(super) fn is_over(&self) -> bool {
        self.state().is_over
    }

    /// What this program does now.
    pub(super) fn own(&self) -> Own {
        let state = self.state();
        let left = state.pace.left(self.jobs);
        Own {
            work: (!state.is_over).then_some(Work { left }),
            failures: state.failures.clone(),
        }
    }

    /// Ends the display; says what failed, if it was not said, and how many runs did.
    pub(super) fn finish(&self) -> usize {
        self.appear();
        self.bar.finish_and_clear();
        self.state().failures.len()
    }
}
