//! `maxq-lab replay`: look at a run that is not going on.

use std::path::PathBuf;

use super::beginning::Beginning;
use super::output::{self, Done};
use super::show::{Show, exit_code};
use crate::dashboard::session::Source;
use crate::lab::specimen::bench;
use crate::lab::{Life, Recording};

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
pub(super) struct Args {
    /// The run folder.
    run_dir: PathBuf,

    #[command(flatten)]
    beginning: Beginning,

    #[command(flatten)]
    show: Show,
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> Done {
    let (outfit, signals) = args.show.require_for_run(&args.run_dir)?;
    let recording = Recording::read(&args.run_dir)?;
    let manifest = &recording.manifest;
    let what = bench(manifest.scenario.clone(), manifest.seed)?;
    let start = args.beginning.read(what)?;
    let goes_on = recording.life == Life::Computing;
    let exit = outfit.beginning_at(start).show(
        what,
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
