//! `maxq-lab watch` and `maxq-lab replay`: dashboards that never change a run.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crossbeam_channel::select;

use super::args::StartArg;
use super::dashboard::{DashboardArgs, exit_code};
use super::output::{self, CommandResult, Failure};
use super::signals::SignalWatcher;
use crate::dashboard::session::{Exit, Source};
use crate::lab::{Liveness, Manifest, News, Recording, Watch, lasting_experiment};
use crate::words::shell_path;

/// Time between two reads of a run folder.
pub(super) const INTERVAL: Duration = Duration::from_millis(250);

/// Watch a run of another process.
///
/// The dashboard is that of 'maxq-lab run', but it cannot control the run: the folder is only
/// read and never locked. Any number of people can watch, also a run of another machine in a
/// shared folder. You can start watching before the run starts, and keep watching while it is
/// stopped, resumed or replaced.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab watch runs/environment-3-seed7
  maxq-lab watch /shared/runs/environment-3-seed7 --fps 2")]
pub(super) struct Args {
    /// Run folder; it need not exist yet.
    run_dir: PathBuf,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// Runs `maxq-lab watch`.
pub(super) fn main(args: &Args) -> CommandResult {
    let (dashboard, signals) = args.dashboard.require_for_run(&args.run_dir)?;
    let watch = Watch::start(&args.run_dir, INTERVAL)?;
    let manifest = match wait_for_run(&args.run_dir, &watch, &signals)? {
        Found::Run(manifest) => *manifest,
        Found::Signal(signal) => return exit_code(Exit::Signal(signal)),
    };
    let experiment = lasting_experiment(manifest.scenario, manifest.seed)?;
    exit_code(dashboard.show(experiment, &args.run_dir, Source::Watched(&watch), &signals)?)
}

/// What arrived first.
enum Found {
    Run(Box<Manifest>),
    Signal(i32),
}

fn wait_for_run(folder: &Path, watch: &Watch, signals: &SignalWatcher) -> Result<Found, Failure> {
    loop {
        select! {
            recv(watch.news) -> news => match news {
                Ok(News::Run(manifest)) => return Ok(Found::Run(manifest)),
                Ok(News::Liveness(Liveness::Absent)) => output::message(&format!(
                    "waiting for a run in {} (Ctrl-C to cancel)",
                    folder.display()
                )),
                Ok(News::Trouble(message)) => return Err(message.into()),
                Ok(_) => {}
                Err(_) => return Err("the run folder is no longer read".into()),
            },
            recv(signals.received) -> signal => match signal {
                Ok(signal) => return Ok(Found::Signal(signal)),
                Err(_) => return Err("signals are no longer received".into()),
            },
        }
    }
}

/// Replay a run that has finished or was interrupted.
///
/// The dashboard is that of 'maxq-lab run', fed from the recorded events: step through the
/// generations, inspect any individual, compare two, trace a lineage back to the first
/// generation. Nothing in the folder is changed. Press ? for the keys.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab replay runs/environment-1-seed1
  maxq-lab replay runs/environment-1-seed1 --theme mono")]
pub(super) struct ReplayArgs {
    /// Run folder.
    run_dir: PathBuf,

    #[command(flatten)]
    start: StartArg,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// Runs `maxq-lab replay`.
pub(super) fn replay(args: &ReplayArgs) -> CommandResult {
    let (dashboard, signals) = args.dashboard.require_for_run(&args.run_dir)?;
    let recording = Recording::read(&args.run_dir)?;
    let manifest = &recording.manifest;
    let experiment = lasting_experiment(manifest.scenario.clone(), manifest.seed)?;
    let start = args.start.read(experiment)?;
    let is_live = recording.liveness == Liveness::Computing;
    let exit = dashboard.starting_at(start).show(
        experiment,
        &args.run_dir,
        Source::recorded(recording),
        &signals,
    )?;
    if is_live {
        let folder = shell_path(&args.run_dir);
        output::message(&format!(
            "note: another process is working on this run; watch it with: maxq-lab watch {folder}"
        ));
    }
    exit_code(exit)
}
