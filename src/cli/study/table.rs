//! The runs of a study as a table, each of which can be opened.

use std::collections::HashMap;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use super::progress::Own;
use crate::cli::dashboard::DashboardSettings;
use crate::cli::output::Failure;
use crate::cli::signals::SignalWatcher;
use crate::cli::watch::INTERVAL;
use crate::dashboard::session::{Exit, RunsExit, RunsSession, Source};
use crate::dashboard::terminal::Terminal;
use crate::dashboard::{RunRow, RunsNews, Standing};
use crate::lab::{Life, Recording, Watch, lasting_experiment};
use crate::report::{RunState, RunStatus, StatusWatch, Study, course};

/// Time between two looks at the study's folder, at least.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);

/// Time that a look may spend on the past of runs that are over: the first rows are there
/// at once, the sparklines of hundreds of runs follow.
const PATIENCE: Duration = Duration::from_millis(300);

/// Shows the runs of a study until somebody or something ends it; `own` tells what this
/// program does on them.
pub(super) fn show(
    study: &Study,
    mut dashboard: DashboardSettings,
    signals: &SignalWatcher,
    own: impl Fn() -> Own + Send + 'static,
) -> Result<Exit, Failure> {
    let runs = study.runs();
    let folder = study.folder.display().to_string();
    let mut table = dashboard.table(study.plan.name.clone(), folder);
    let interval = dashboard.period().max(BETWEEN_LOOKS);
    let looks = Looks::start(study.clone(), interval, own)?;
    let mut terminal = dashboard.terminal()?;
    loop {
        let session = RunsSession::new(&mut table, &mut terminal, &looks.news);
        let place = match session.run(&signals.heard)? {
            RunsExit::End(exit) => return Ok(exit),
            RunsExit::Open(place) => place,
        };
        let Some(run) = runs.get(place) else {
            continue;
        };
        dashboard.wear(table.look().clone());
        match open(&study.run_folder(run), &dashboard, &mut terminal, signals) {
            Ok(Exit::Left | Exit::Detached) => {}
            Ok(exit) => return Ok(exit),
            Err(Failure::Message(message)) => table.show_message(message),
            Err(failure) => return Err(failure),
        }
    }
}

/// Opens a run in the dashboard.
fn open(
    folder: &Path,
    dashboard: &DashboardSettings,
    terminal: &mut Terminal,
    signals: &SignalWatcher,
) -> Result<Exit, Failure> {
    let recording = Recording::read(folder)?;
    let manifest = &recording.manifest;
    let experiment = lasting_experiment(manifest.scenario.clone(), manifest.seed)?;
    let watch = match recording.life {
        Life::Computing => Some(Watch::start(folder, INTERVAL)?),
        _ => None,
    };
    let source = match &watch {
        Some(watch) => Source::Watched(watch),
        None => Source::recorded(recording),
    };
    let session = dashboard.session(experiment, folder, source, terminal)?;
    Ok(session.within().run(&signals.heard)?)
}

/// A study that is looked at from time to time, until this is dropped.
struct Looks {
    /// Its runs, in the order of the study, and this program's work on them.
    news: Receiver<RunsNews>,
    _stop: Sender<()>,
}

impl Looks {
    fn start(
        study: Study,
        interval: Duration,
        own: impl Fn() -> Own + Send + 'static,
    ) -> std::io::Result<Self> {
        let (sender, news) = bounded(0);
        let (stop, stopped) = bounded::<()>(0);
        thread::Builder::new()
            .name(String::from("study"))
            .spawn(move || {
                let (mut past, mut watch) = (HashMap::new(), StatusWatch::of(&study));
                // Nobody looks at the folders while nobody takes what was seen.
                while sender
                    .send(look(&study, watch.look(), &mut past, own()))
                    .is_ok()
                {
                    if stopped.recv_timeout(interval) != Err(RecvTimeoutError::Timeout) {
                        return;
                    }
                }
            })?;
        Ok(Self { news, _stop: stop })
    }
}

/// The runs as they are `now`, with what this program does; `past` keeps the courses of those
/// that are over, by number.
fn look(
    study: &Study,
    now: Vec<RunStatus>,
    past: &mut HashMap<usize, Vec<f64>>,
    own: Own,
) -> RunsNews {
    let begun = Instant::now();
    let rows = now.into_iter().map(|status| {
        let is_over = matches!(status.stage, RunState::Done | RunState::Evolved);
        if !is_over {
            past.remove(&status.number);
        } else if !past.contains_key(&status.number) && begun.elapsed() < PATIENCE {
            // A log that cannot be read leaves the end, which is known without it.
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
        standing: match status.stage {
            _ if failure.is_some() => Standing::Failed,
            RunState::Done => Standing::Done,
            RunState::Evolved => Standing::Evolved,
            RunState::Running => Standing::Running,
            RunState::Interrupted => Standing::BrokenOff,
            RunState::Waiting => Standing::Waiting,
            RunState::Unreadable => Standing::Unreadable,
        },
        generations: status.generations,
        course: past.unwrap_or(status.best_steps),
        fresh: status.fresh_steps,
        trouble: failure.cloned().or(status.trouble),
    }
}
