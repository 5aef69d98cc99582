//! `study watch`: the table of the runs of a study that others do.

use std::path::PathBuf;

use super::progress::Own;
use super::table;
use crate::cli::output::Done;
use crate::cli::show::{Show, exit_code};
use crate::report::Study;

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
    let study = Study::open(&args.dir)?;
    let instead = format!("maxq-lab study status {}", args.dir.display());
    let (outfit, signals) = args.show.require(&instead)?;
    exit_code(table::show(&study, outfit, &signals, Own::default)?)
}
