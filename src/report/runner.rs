//! Many runs side by side, each on one thread: that keeps every processor busy without
//! any of them waiting for another.

use std::collections::VecDeque;
use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::controls::StudyControls;
use super::single::{Fresh, Single, SingleError};
use super::study::{RunId, Study};
use crate::lab::Keep;

/// What happens to the runs of a study.
#[derive(Debug)]
pub enum StudyEvent {
    /// A run is begun, or gone on with.
    Started(RunId),
    /// A run has come to its end, now or before.
    Done {
        /// The run.
        run: RunId,
        /// How good its winner is.
        fresh: Box<Fresh>,
        /// How long this took.
        took: Duration,
    },
    /// Another process does the run.
    Elsewhere(RunId),
    /// A run cannot be done.
    Failed {
        /// The run.
        run: RunId,
        /// Why.
        error: SingleError,
    },
}

/// Does `runs`, `jobs` at a time, until all are done, have failed, or were stopped.
/// `tell` is told what happens; it is called from the threads that do the runs.
pub fn run_study(
    study: &Study,
    runs: &[RunId],
    jobs: NonZeroUsize,
    keep: Keep,
    controls: &StudyControls,
    tell: impl Fn(StudyEvent) + Sync,
) {
    let waiting: Mutex<VecDeque<RunId>> = Mutex::new(runs.iter().copied().collect());
    let next = || {
        let mut waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.pop_front().filter(|_| !controls.is_stopped())
    };
    let work = || {
        while let Some(run) = next() {
            tell(StudyEvent::Started(run));
            let begun = Instant::now();
            let single = Single {
                study,
                run,
                keep,
                controls,
            };
            match single.carry_out() {
                Ok(fresh) => tell(StudyEvent::Done {
                    run,
                    fresh: Box::new(fresh),
                    took: begun.elapsed(),
                }),
                Err(SingleError::Stopped(_)) => {}
                Err(error) if single.is_elsewhere(&error) => tell(StudyEvent::Elsewhere(run)),
                Err(error) => tell(StudyEvent::Failed { run, error }),
            }
        }
    };
    thread::scope(|scope| {
        for _ in 1..jobs.get().min(runs.len().max(1)) {
            scope.spawn(work);
        }
        work();
    });
}
