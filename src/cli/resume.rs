//! `maxq-lab resume`: go on with a run.

use std::path::PathBuf;

use super::how::How;
use super::live;
use super::output::{self, Done};
use super::signals::Caught;
use crate::lab::{Invocation, RunFolder, resume};

/// Go on with a run that was stopped, or died.
///
/// The result is the same, bit for bit, as if the run had never been interrupted. With
/// --generations a run that ended at its limit goes on to another limit. On a terminal a
/// dashboard shows it, the past generations included.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab resume runs/environment-3-seed7
  maxq-lab resume runs/environment-3-seed7 --generations 400        beyond its limit")]
pub(super) struct Args {
    /// The run folder.
    run_dir: PathBuf,

    /// Another generation limit.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    generations: Option<u64>,

    #[command(flatten)]
    how: How,
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> Done {
    let signals = Caught::now()?;
    let manifest = RunFolder::read_manifest(&args.run_dir)?;
    let (then, now) = (manifest.started, Invocation::now(0));
    if (&then.version, &then.commit) != (&now.version, &now.commit) {
        output::message(&format!(
            "note: the run was started by version {} ({}), this is {} ({}): the bits may differ from \
             those of a run never interrupted",
            then.version, then.commit, now.version, now.commit
        ));
    }
    let outfit = live::outfit(&args.how)?;
    let run = resume(&args.run_dir, args.generations, &args.how.options(false))?;
    live::follow(run, outfit, signals, &args.how)
}
