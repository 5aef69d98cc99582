//! The table of the runs of a study; Enter opens a run in the dashboard.

use std::collections::HashMap;
use std::path::Path;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use super::progress::OwnProgress;
use crate::cli::dashboard::DashboardSettings;
use crate::cli::output::Failure;
use crate::cli::signals::{SignalWatcher, spawn};
use crate::cli::watch::INTERVAL;
use crate::dashboard::session::{Exit, RunsExit, RunsSession, Source};
use crate::dashboard::terminal::Terminal;
use crate::dashboard::{RowStatus, RunRow, RunsNews};
use crate::lab::{Liveness, Recording, Watch, lasting_experiment};
use crate::report::{RunState, RunStatus, StatusWatch, Study, course};

/// Shortest time between two reads of the study folder.
const SHORTEST_INTERVAL: Duration = Duration::from_secs(1);

/// How long one read may spend on the sparklines of finished runs.
///
/// The first rows appear at once; the sparklines of hundreds of runs follow.
const PATIENCE: Duration = Duration::from_millis(300);

/// Shows the runs of a study until the user leaves the table or something ends it; `own` returns
/// the progress of this process.
pub(super) fn show(
    study: &Study,
    mut dashboard: DashboardSettings,
    signals: &SignalWatcher,
    own: impl Fn() -> OwnProgress + Send + 'static,
) -> Result<Exit, Failure> {
    let runs = study.runs();
    let folder = study.folder.display().to_string();
    let interval = dashboard.period().max(SHORTEST_INTERVAL);
    let reader = Reader::start(study.clone(), interval, own)?;
    let mut terminal = dashboard.terminal()?;
    let mut table = dashboard.table(study.plan.name.clone(), folder);
    loop {
        let session = RunsSession::new(&mut table, &mut terminal, &reader.news);
        let place = match session.run(&signals.received)? {
            RunsExit::End(exit) => return Ok(exit),
            RunsExit::Open(place) => place,
        };
        let Some(run) = runs.get(place) else {
            continue;
        };
        dashboard.look = table.look().clone();
        match open(&study.run_folder(run), &dashboard, &mut terminal, signals) {
            Ok(Exit::Left | Exit::Detached) => {}
            Ok(exit) => return Ok(exit),
            Err(Failure::Message(message)) => table.show_message(message),
            Err(failure) => return Err(failure),
        }
    }
}

/// Shows the run in `folder` in the dashboard: live if a process computes it, else a replay.
fn open(
    folder: &Path,
    dashboard: &DashboardSettings,
    terminal: &mut Terminal,
    signals: &SignalWatcher,
) -> Result<Exit, Failure> {
    let recording = Recording::read(folder)?;
    let manifest = &recording.manifest;
    let experiment = lasting_experiment(manifest.scenario.clone(), manifest.seed)?;
    let watch = match recording.liveness {
        Liveness::Computing => Some(Watch::start(folder, INTERVAL)?),
        _ => None,
    };
    let source = match &watch {
        Some(watch) => Source::Watched(watch),
        None => Source::recorded(recording),
    };
    let session = dashboard.session(experiment, folder, source, terminal)?;
    Ok(session.with_back().run(&signals.received)?)
}

/// A thread that reads a study again and again until this is dropped.
struct Reader {
    /// The runs, in the order of the study, and the progress of this process.
    news: Receiver<RunsNews>,
    _stop: Sender<()>,
}

impl Reader {
    fn start(
        study: Study,
        interval: Duration,
        own: impl Fn() -> OwnProgress + Send + 'static,
    ) -> Result<Self, Failure> {
        let (sender, news) = bounded(0);
        let (stop, stopped) = bounded::<()>(0);
        spawn("study", move || {
            let (mut past, mut watch) = (HashMap::new(), StatusWatch::of(&study));
            let mut read = || rows(&study, watch.look(), &mut past, own());
            // The channel has no buffer: nothing is read while the table is not shown.
            while sender.send(read()).is_ok() {
                if stopped.recv_timeout(interval) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
            }
        })?;
        Ok(Self { news, _stop: stop })
    }
}

/// The rows of the table; `past` keeps the sparklines of finished runs, by run number.
fn rows(
    study: &Study,
    now: Vec<RunStatus>,
    past: &mut HashMap<usize, Vec<f64>>,
    own: OwnProgress,
) -> RunsNews {
    let begun = Instant::now();
    let rows = now.into_iter().map(|status| {
        let is_over = matches!(status.stage, RunState::Done | RunState::Evolved);
        if !is_over {
            past.remove(&status.number);
        } else if !past.contains_key(&status.number) && begun.elapsed() < PATIENCE {
            // If the log cannot be read, the final value is all there is.
            let read = course(&status.folder);
            past.insert(status.number, read.unwrap_or(status.best_steps.clone()));
        }
        let known = past.get(&status.number).cloned();
        let failure = own.failures.get(&status.number);
        row(study, status, known, failure)
    });
    RunsNews {
        rows: rows.collect(),
        work: own.work,
    }
}

fn row(
    study: &Study,
    status: RunStatus,
    past: Option<Vec<f64>>,
    failure: Option<&String>,
) -> RunRow {
    RunRow {
        scenario: study.scenario(&status.run).name.clone(),
        arm: study.arm(&status.run).name.clone(),
        seed: status.run.seed,
        status: match status.stage {
            _ if failure.is_some() => RowStatus::Failed,
            RunState::Done => RowStatus::Done,
            RunState::Evolved => RowStatus::Evolved,
            RunState::Running => RowStatus::Running,
            RunState::Interrupted => RowStatus::Interrupted,
            RunState::Waiting => RowStatus::Waiting,
            RunState::Unreadable => RowStatus::Unreadable,
        },
        generations: status.generations,
        course: past.unwrap_or(status.best_steps),
        fresh: status.fresh_steps,
        trouble: failure.cloned().or(status.trouble),
    }
}
