//! `study watch`: the runs of a study as a table, each of which can be opened.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};

use crate::cli::output::{Done, Failure};
use crate::cli::show::{Outfit, Show, exit_code};
use crate::cli::signals::Caught;
use crate::cli::watch::INTERVAL;
use crate::dashboard::session::{Exit, RunsExit, RunsSession, Source};
use crate::dashboard::terminal::Terminal;
use crate::dashboard::{RunRow, Standing};
use crate::lab::specimen::bench;
use crate::lab::{Life, Recording, Watch};
use crate::report::{RunStatus, Stage, Study, course, status};

/// Time between two looks at the study's folder, at least.
const BETWEEN_LOOKS: Duration = Duration::from_secs(1);

/// Time that a look may spend on the past of runs that are over: the first rows are there
/// at once, the sparklines of hundreds of runs follow.
const PATIENCE: Duration = Duration::from_millis(300);

/// Follow the runs of a study, and open any of them.
///
/// A table of the runs: how each stands, its generation, the best fitness and its course.
/// Enter opens a run in the dashboard, as a replay if it is over or broken off, watched if it
/// goes on; q comes back. Folders are read once a second, never written or locked: the study
/// may be done by this machine or by others. Press ? for the keys.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study watch studies/thesis
  maxq-lab study watch /shared/studies/thesis --fps 0.2    look every 5 seconds")]
pub(super) struct WatchArgs {
    /// The folder of the study.
    dir: PathBuf,

    #[command(flatten)]
    show: Show,
}

/// Carries out `study watch`.
pub(super) fn main(args: &WatchArgs) -> Done {
    Show::require()?;
    let study = Study::open(&args.dir)?;
    let signals = Caught::now()?;
    let mut outfit = args.show.outfit()?;
    let folders: Vec<_> = study
        .runs()
        .iter()
        .map(|run| study.run_folder(run))
        .collect();
    let folder = args.dir.display().to_string();
    let mut table = outfit.table(study.plan.name.clone(), folder);
    let looks = Looks::start(study, outfit.period().max(BETWEEN_LOOKS))?;
    let mut terminal = outfit.terminal()?;
    loop {
        let session = RunsSession::new(&mut table, &mut terminal, &looks.rows);
        let place = match session.run(&signals.heard)? {
            RunsExit::End(exit) => return exit_code(exit),
            RunsExit::Open(place) => place,
        };
        let Some(folder) = folders.get(place) else {
            continue;
        };
        outfit.wear(table.look().clone());
        match open(folder, &outfit, &mut terminal, &signals) {
            Ok(Exit::Left | Exit::Detached) => {}
            Ok(exit) => return exit_code(exit),
            Err(Failure::Message(message)) => table.say(message),
            Err(failure) => return Err(failure),
        }
    }
}

/// Opens a run in the dashboard.
fn open(
    folder: &Path,
    outfit: &Outfit,
    terminal: &mut Terminal,
    signals: &Caught,
) -> Result<Exit, Failure> {
    let recording = Recording::read(folder)?;
    let manifest = &recording.manifest;
    let what = bench(manifest.scenario.clone(), manifest.seed)?;
    let watch = match recording.life {
        Life::Computing => Some(Watch::start(folder, INTERVAL)?),
        _ => None,
    };
    let source = match &watch {
        Some(watch) => Source::Watched(watch),
        None => Source::recorded(recording),
    };
    let session = outfit.session(what, folder, source, terminal)?;
    Ok(session.within().run(&signals.heard)?)
}

/// A study that is looked at from time to time, until this is dropped.
struct Looks {
    /// Its runs, in the order of the study.
    rows: Receiver<Vec<RunRow>>,
    _stop: Sender<()>,
}

impl Looks {
    fn start(study: Study, interval: Duration) -> std::io::Result<Self> {
        let (sender, rows) = bounded(0);
        let (stop, stopped) = bounded::<()>(0);
        thread::Builder::new()
            .name(String::from("study"))
            .spawn(move || {
                let mut past = HashMap::new();
                // Nobody looks at the folders while nobody takes what was seen.
                while sender.send(look(&study, &mut past)).is_ok() {
                    if stopped.recv_timeout(interval) != Err(RecvTimeoutError::Timeout) {
                        return;
                    }
                }
            })?;
        Ok(Self { rows, _stop: stop })
    }
}

/// The runs as they are now; `past` keeps the courses of those that are over, by number.
fn look(study: &Study, past: &mut HashMap<usize, Vec<f64>>) -> Vec<RunRow> {
    let begun = Instant::now();
    let rows = status(study).into_iter().map(|status| {
        let is_over = matches!(status.stage, Stage::Done | Stage::Evolved);
        if !is_over {
            past.remove(&status.number);
        } else if !past.contains_key(&status.number) && begun.elapsed() < PATIENCE {
            // A log that cannot be read leaves the end, which is known without it.
            let read = course(&status.folder);
            past.insert(status.number, read.unwrap_or(status.best_steps.clone()));
        }
        let known = past.get(&status.number).cloned();
        row(study, status, known)
    });
    rows.collect()
}

fn row(study: &Study, status: RunStatus, past: Option<Vec<f64>>) -> RunRow {
    RunRow {
        scenario: study.scenario(&status.run).name.clone(),
        arm: study.arm(&status.run).name.clone(),
        seed: status.run.seed,
        standing: match status.stage {
            Stage::Done => Standing::Done,
            Stage::Evolved => Standing::Evolved,
            Stage::Running => Standing::Running,
            Stage::Interrupted => Standing::BrokenOff,
            Stage::Waiting => Standing::Waiting,
            Stage::Unreadable => Standing::Unreadable,
        },
        generations: status.generations,
        course: past.unwrap_or(status.best_steps),
        fresh: status.fresh_steps,
        trouble: status.trouble,
    }
}
