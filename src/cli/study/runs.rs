//! Does the runs of a study in this process, with a table on a terminal.

use std::process::ExitCode;
use std::sync::Arc;
use std::thread;

use super::Args;
use super::progress::Progress;
use super::table;
use crate::cli::args::{OnHangup, useful_threads};
use crate::cli::dashboard::DashboardSettings;
use crate::cli::live::{PATIENCE, continues, end_within};
use crate::cli::output::{self, CommandResult, Failure};
use crate::cli::signals::{SignalWatcher, Termination};
use crate::dashboard::session::Exit;
use crate::lab::Keep;
use crate::report::{
    RunId, RunState, Study, StudyControls, bytes_of_all_generations, run_study, status,
};
use crate::words::shell_path;

/// Runs `maxq-lab study`.
pub(super) fn main(args: &Args) -> CommandResult {
    // Mistakes are reported before anything is created.
    let runs = selected(&args.study.planned()?, &args.only)?;
    let study = args.study.create()?;
    if args.keep == Keep::All {
        output::message(&format!(
            "note: keeping all generations takes up to about {} for all runs, more if hierarchies \
             grow",
            bytes_of_all_generations(&study.plan)
        ));
    }
    let signals = SignalWatcher::start()?;
    let dashboard = args.dashboard.unless(args.headless)?;
    let jobs = useful_threads(args.jobs);
    let work = Arc::new(OwnWork {
        controls: StudyControls::default(),
        progress: Progress::new(&study, &runs, jobs.get()),
    });
    let termination = Termination::default();
    let exit = thread::scope(|scope| {
        scope.spawn(|| {
            let update = |event| work.progress.update(&event);
            run_study(&study, &runs, jobs, args.keep, &work.controls, update);
            work.progress.end();
        });
        let followed = follow(
            &study,
            &work,
            dashboard,
            signals,
            &termination,
            args.on_hangup,
        );
        if followed.is_err() {
            work.controls.stop();
        }
        followed
    })?;
    if let Some(Exit::Signal(signal)) = exit {
        end_within(PATIENCE, 128 + signal)?;
    }
    let failed = work.progress.finish();
    let left = report(&study, &runs)?;
    conclude(failed, left, &work.controls, &termination, exit)
}

/// The work of this process and its progress.
struct OwnWork {
    controls: StudyControls,
    progress: Progress,
}

/// Shows the table until the user leaves it, then the bar.
///
/// Returns how the table was left, if there was one, while the work continues or is about to
/// stop.
fn follow(
    study: &Study,
    work: &Arc<OwnWork>,
    dashboard: Option<DashboardSettings>,
    signals: SignalWatcher,
    termination: &Termination,
    on_hangup: OnHangup,
) -> Result<Option<Exit>, Failure> {
    // Asked while there is still a terminal.
    let survives = on_hangup.survives();
    let own = Arc::clone(work);
    let own = move || own.progress.own();
    let exit = dashboard.map(|dashboard| table::show(study, dashboard, &signals, own));
    let exit = exit.transpose()?;
    if exit == Some(Exit::Detached) || continues(exit, termination, on_hangup, || {}) {
        let stopping = Arc::clone(work);
        signals.stop_on_signals(termination, survives, move || stopping.controls.stop())?;
        work.progress.show();
    } else {
        if exit == Some(Exit::Left) && !work.progress.is_over() {
            termination.record_user_stop();
        }
        work.controls.stop();
    }
    Ok(exit)
}

/// Prints how many of `runs` are done; returns how many are not.
fn report(study: &Study, runs: &[RunId]) -> Result<usize, Failure> {
    let (now, all) = (status(study), runs.len());
    let done = || now.iter().filter(|status| status.stage == RunState::Done);
    let folder = study.folder.display();
    let next = if done().count() == now.len() {
        format!(
            "; next: maxq-lab study report {}",
            shell_path(&study.folder)
        )
    } else {
        String::new()
    };
    let done = done().filter(|status| runs.contains(&status.run)).count();
    output::text(&format!("{done} of {all} runs done in {folder}{next}\n"))?;
    Ok(all - done)
}

/// Prints why runs are not done and returns the exit code.
fn conclude(
    failed: usize,
    left: usize,
    controls: &StudyControls,
    termination: &Termination,
    exit: Option<Exit>,
) -> CommandResult {
    if left > 0 && controls.is_stopped() {
        output::message("stopped; run the same command to resume");
    } else if failed == 0 && left > 0 {
        output::message(
            "another process is working on the other runs; 'maxq-lab study status' shows their \
             progress",
        );
    }
    if let Some(code) = termination.exit_code().filter(|_| left > failed) {
        return Ok(ExitCode::from(code));
    }
    if failed > 0 || exit == Some(Exit::Panicked) {
        return Ok(ExitCode::FAILURE);
    }
    Ok(ExitCode::SUCCESS)
}

/// The runs that `--only` names, or all.
fn selected(study: &Study, only: &[String]) -> Result<Vec<RunId>, Failure> {
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
