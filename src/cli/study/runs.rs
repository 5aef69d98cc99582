//! The runs of a study, done by this process: on a terminal with their table.

use std::num::NonZeroUsize;
use std::process::ExitCode;
use std::sync::Arc;
use std::thread;

use super::Args;
use super::progress::Progress;
use super::table;
use crate::cli::args::OnHangup;
use crate::cli::dashboard::{DashboardArgs, DashboardSettings};
use crate::cli::live::{PATIENCE, end_within, goes_on};
use crate::cli::output::{self, CommandResult, Failure};
use crate::cli::signals::{SignalWatcher, Termination};
use crate::dashboard::session::Exit;
use crate::dashboard::terminal;
use crate::report::{RunId, RunState, Study, StudyControls, run_study, status};

/// Carries out `study`.
pub(super) fn main(args: &Args) -> CommandResult {
    // What is wrong is told before anything is made.
    let runs = wanted(&args.what.planned()?, &args.only)?;
    let study = args.what.study()?;
    let signals = SignalWatcher::now()?;
    let dashboard = match args.headless || !DashboardArgs::is_possible() {
        true => None,
        false => Some(args.dashboard.settings()?),
    };
    let jobs = jobs(args.jobs);
    let work = Arc::new(OwnWork {
        controls: StudyControls::default(),
        progress: Progress::new(&study, &runs, jobs.get()),
    });
    let ended = Termination::default();
    let exit = thread::scope(|scope| {
        scope.spawn(|| {
            let tell = |happening| work.progress.tell(&happening);
            run_study(&study, &runs, jobs, args.keep, &work.controls, tell);
            work.progress.end();
        });
        let followed = follow(&study, &work, dashboard, signals, &ended, args.on_hangup);
        if followed.is_err() {
            work.controls.stop();
        }
        followed
    })?;
    if let Some(Exit::Signal(signal)) = exit {
        end_within(PATIENCE, 128 + signal)?;
    }
    let failed = work.progress.finish();
    let left = tell_done(&study, &runs)?;
    conclude(failed, left, &work.controls, &ended, exit)
}

/// The work on the runs that this process does, and how far it is.
struct OwnWork {
    controls: StudyControls,
    progress: Progress,
}

/// Follows the work with a table, as long as somebody wants to see it, then with a bar.
/// Returns while the work goes on, or is about to stop; how the table was left, if there
/// was one.
fn follow(
    study: &Study,
    work: &Arc<OwnWork>,
    dashboard: Option<DashboardSettings>,
    signals: SignalWatcher,
    ended: &Termination,
    on_hangup: OnHangup,
) -> Result<Option<Exit>, Failure> {
    // There is a line that can drop. Without one SIGHUP asks the program to end.
    let survives = on_hangup == OnHangup::Detach && terminal::is_attached();
    let own = Arc::clone(work);
    let exit = match dashboard {
        Some(dashboard) => Some(table::show(study, dashboard, &signals, move || {
            own.progress.own()
        })?),
        None => None,
    };
    if exit == Some(Exit::Detached) || goes_on(exit, ended, on_hangup, || {}) {
        let stopping = Arc::clone(work);
        signals.stop(ended, survives, move || stopping.controls.stop())?;
        work.progress.appear();
    } else {
        if exit == Some(Exit::Left) && !work.progress.is_over() {
            ended.by_hand();
        }
        work.controls.stop();
    }
    Ok(exit)
}

/// Says how many runs are done, and where all of the study are what to do next; returns how
/// many are not.
fn tell_done(study: &Study, runs: &[RunId]) -> Result<usize, Failure> {
    let (now, all) = (status(study), runs.len());
    let done = || now.iter().filter(|status| status.stage == RunState::Done);
    let is_whole = done().count() == now.len();
    let done = done().filter(|status| runs.contains(&status.run)).count();
    let folder = study.folder.display();
    let next = match is_whole {
        true => format!("; 'maxq-lab study report {folder}' says what comes out"),
        false => String::new(),
    };
    output::text(&format!("{done} of {all} runs done in {folder}{next}\n"))?;
    Ok(all - done)
}

fn conclude(
    failed: usize,
    left: usize,
    controls: &StudyControls,
    ended: &Termination,
    exit: Option<Exit>,
) -> CommandResult {
    if left > 0 && controls.is_stopped() {
        output::message("stopped; the same command goes on");
    } else if failed == 0 && left > 0 {
        output::message(
            "the others are done by another process; 'study status' tells how far it is",
        );
    }
    if let Some(code) = ended.exit_code().filter(|_| left > failed) {
        return Ok(ExitCode::from(code));
    }
    match failed > 0 || exit == Some(Exit::Panicked) {
        true => Ok(ExitCode::FAILURE),
        false => Ok(ExitCode::SUCCESS),
    }
}

fn wanted(study: &Study, only: &[String]) -> Result<Vec<RunId>, Failure> {
    if only.is_empty() {
        return Ok(study.runs());
    }
    let mut runs = Vec::new();
    for name in only {
        runs.extend(study.find(name)?);
    }
    runs.sort_by_key(|run| run.number);
    runs.dedup();
    Ok(runs)
}

fn jobs(asked: u16) -> NonZeroUsize {
    let all = || std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    NonZeroUsize::new(usize::from(asked)).unwrap_or_else(all)
}
