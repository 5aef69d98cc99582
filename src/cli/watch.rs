//! `maxq-lab watch` and `maxq-lab replay`.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crossbeam_channel::select;

use super::args::StartArg;
use super::dashboard::{DashboardArgs, exit_code};
use super::output::{self, CommandResult, Failure};
use super::signals::SignalWatcher;
use crate::dashboard::session::{Exit, Source};
use crate::lab::{Life, Manifest, News, Recording, Watch, lasting_experiment};

/// Time between two looks at the run folder.
pub(super) const INTERVAL: Duration = Duration::from_millis(250);

/// Follow a run that another process computes.
///
/// The dashboard is the one of 'maxq-lab run', but it cannot steer: the folder is read, never
/// written, and no lock is taken, so that a run of another machine in a shared folder can be
/// watched, by any number of people, as long as it takes. It may be started before the run
/// is, and goes on when the run is stopped, resumed or replaced.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab watch runs/environment-3-seed7
  maxq-lab watch /shared/runs/environment-3-seed7 --fps 2")]
pub(super) struct Args {
    /// The run folder; it need not be there yet.
    run_dir: PathBuf,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// Carries out the command.
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

/// What came first.
enum Found {
    Run(Box<Manifest>),
    Signal(i32),
}

fn wait_for_run(folder: &Path, watch: &Watch, signals: &SignalWatcher) -> Result<Found, Failure> {
    loop {
        select! {
            recv(watch.news) -> news => match news {
                Ok(News::Run(manifest)) => return Ok(Found::Run(manifest)),
                Ok(News::Life(Life::Absent)) => output::message(&format!(
                    "waiting for a run in {}; Ctrl-C gives up",
                    folder.display()
                )),
                Ok(News::Trouble(message)) => return Err(message.into()),
                Ok(_) => {}
                Err(_) => return Err("the run folder is not followed any more".into()),
            },
            recv(signals.heard) -> signal => match signal {
                Ok(signal) => return Ok(Found::Signal(signal)),
                Err(_) => return Err("signals are not heard any more".into()),
            },
        }
    }
}

/// Look at a run that has ended, was stopped, or died.
///
/// The dashboard is the one of 'maxq-lab run', over the events that the run left in its
/// folder: travel through its generations, open any individual, compare two, follow a
/// lineage back to the start. Nothing in the folder is changed. Press ? for the keys.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab replay runs/environment-1-seed1
  maxq-lab replay runs/environment-1-seed1 --theme mono")]
pub(super) struct ReplayArgs {
    /// The run folder.
    run_dir: PathBuf,

    #[command(flatten)]
    start: StartArg,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// Carries out the command.
pub(super) fn replay(args: &ReplayArgs) -> CommandResult {
    let (dashboard, signals) = args.dashboard.require_for_run(&args.run_dir)?;
    let recording = Recording::read(&args.run_dir)?;
    let manifest = &recording.manifest;
    let experiment = lasting_experiment(manifest.scenario.clone(), manifest.seed)?;
    let start = args.start.read(experiment)?;
    let goes_on = recording.life == Life::Computing;
    let exit = dashboard.starting_at(start).show(
        experiment,
        &args.run_dir,
        Source::recorded(recording),
        &signals,
    )?;
    if goes_on {
        let folder = args.run_dir.display();
        output::message(&format!(
            "note: another process was working on this run; follow it with: maxq-lab watch {folder}"
        ));
    }
    exit_code(exit)
}
