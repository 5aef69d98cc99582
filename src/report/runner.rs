//! Does runs of a study in parallel. Each run uses one thread, so that no thread waits for
//! another.

use std::collections::VecDeque;
use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::results::{StudyRunError, WinnerEvaluation};
use super::study::{RunId, Study};
use super::study_run::{StudyControls, StudyRun};
use crate::lab::Keep;

/// An event in the work on the runs of a study.
#[derive(Debug)]
pub enum StudyEvent {
    /// A run was started or resumed.
    Started(RunId),
    /// A run is done; it may have been done before.
    Done {
        /// The run.
        run: RunId,
        /// The evaluation of its winner.
        evaluation: Box<WinnerEvaluation>,
        /// The time that the work took.
        took: Duration,
    },
    /// Another process is working on the run.
    Elsewhere(RunId),
    /// A run failed.
    Failed {
        /// The run.
        run: RunId,
        /// The cause.
        error: StudyRunError,
    },
}

/// Does `runs`, `jobs` at a time, until each of them is done, has failed or was stopped.
///
/// `report` receives every event. It is called from the threads that do the runs.
pub fn run_study(
    study: &Study,
    runs: &[RunId],
    jobs: NonZeroUsize,
    keep: Keep,
    controls: &StudyControls,
    report: impl Fn(StudyEvent) + Sync,
) {
    let waiting: Mutex<VecDeque<RunId>> = Mutex::new(runs.iter().copied().collect());
    let next = || {
        let mut waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.pop_front().filter(|_| !controls.is_stopped())
    };
    let work = || {
        while let Some(run) = next() {
            report(StudyEvent::Started(run));
            let started = Instant::now();
            let study_run = StudyRun {
                study,
                run,
                keep,
                controls,
            };
            match study_run.finish() {
                Ok(evaluation) => report(StudyEvent::Done {
                    run,
                    evaluation: Box::new(evaluation),
                    took: started.elapsed(),
                }),
                Err(StudyRunError::Stopped(_)) => {}
                Err(error) if study_run.is_elsewhere(&error) => report(StudyEvent::Elsewhere(run)),
                Err(error) => report(StudyEvent::Failed { run, error }),
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
