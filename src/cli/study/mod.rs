//! `maxq-lab study`: many runs, how far they are, what comes out.

mod elsewhere;
mod runs;
mod status;
mod watch;

use std::path::PathBuf;

use clap::Subcommand;

use super::output::{Done, Failure};
use crate::lab::Keep;
use crate::report::{Arm, Base, Numbers, Plan, Study};

/// Do many runs: scenarios, arms and seeds of a plan.
///
/// Every scenario, arm and seed gets a run folder of its own, DIR/SCENARIO/ARM/seed-N. Runs
/// that are done are skipped, runs that were broken off are gone on with, as many at a
/// time as there are processors, each on one thread. Ending this at any moment and starting
/// it again gives the same bytes. When a run is over, the structure of its winner is
/// evaluated anew: fresh hierarchies, fresh trials, freshly trained primitive subtasks.
///
/// Arms: evolved; random_selection (chance in the place of fitness: the control that tells
/// selection from drift); random_choice (composite subtasks choose uniformly: tells what
/// their learning adds); hand_designed (the complete hierarchy, learning only); random_search
/// (random hierarchies in the place of offspring); no_learning_inheritance (Darwinian);
/// flat (a root that chooses among all primitive subtasks). hand_designed, random_search and
/// flat get as many generations as the evolved run of the same seed.
#[derive(Debug, clap::Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "\
Examples:
  maxq-lab study thesis --out studies/thesis               the study of the thesis's claims
  maxq-lab study environment-1 environment-2 --seeds 1..10 --arms evolved,flat --out mine
  maxq-lab study status studies/thesis                     at any time
  maxq-lab study watch studies/thesis                      live, as a table of runs to open
  maxq-lab study report studies/thesis                     what comes out"
)]
pub(super) struct Args {
    #[command(subcommand)]
    command: Option<Command>,

    #[command(flatten)]
    what: What,

    /// Runs to do: a number, a range of numbers, or SCENARIO/ARM/seed-N; may be repeated
    /// [default: all]. 'study plan' lists them.
    #[arg(long, value_name = "RUN")]
    only: Vec<String>,

    /// Runs at a time; 0 means one for each processor.
    #[arg(long, short, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    jobs: u16,

    /// Checkpoints kept of every run: all, none, or every N-th generation's.
    #[arg(long, value_name = "all|none|N", default_value = "none")]
    keep: Keep,

    /// Show no progress, although standard error is a terminal.
    #[arg(long)]
    headless: bool,
}

/// A study: what to run and where.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct What {
    /// A plan (a file, or 'thesis'), or scenarios (files, or names of embedded ones).
    #[arg(required = true, value_name = "PLAN|SCENARIO")]
    what: Vec<String>,

    /// Seeds for scenarios: numbers and ranges, both ends counted; a plan has its own.
    #[arg(long, value_name = "A..B", default_value = "1..10")]
    seeds: Numbers,

    /// Arms for scenarios; a plan has its own.
    #[arg(
        long,
        value_name = "ARM,...",
        value_delimiter = ',',
        default_value = "evolved,random_selection"
    )]
    arms: Vec<String>,

    /// The folder of the study.
    #[arg(long, value_name = "DIR", required = true)]
    out: Option<PathBuf>,
}

impl What {
    /// The study, its folder made if it is not there.
    pub(super) fn study(&self) -> Result<Study, Failure> {
        let folder = self.out.clone().unwrap_or_default();
        Ok(Study::create(self.plan()?, &folder)?)
    }

    fn plan(&self) -> Result<Plan, Failure> {
        if let [only] = self.what.as_slice()
            && Plan::is_plan(only)
        {
            return Ok(Plan::load(only)?);
        }
        let arms = self.arms.iter().map(|name| {
            let base = Base::find(name);
            base.map(Arm::of)
                .ok_or_else(|| format!("--arms: found {name:?}; allowed: {}", Base::names()))
        });
        let arms = arms.collect::<Result<_, _>>()?;
        Ok(Plan::of(&self.what, self.seeds.clone(), arms)?)
    }
}

#[derive(Debug, Subcommand)]
enum Command {
    Status(status::StatusArgs),
    Watch(watch::WatchArgs),
    Report(status::ReportArgs),
    Plan(elsewhere::PlanArgs),
    Slurm(elsewhere::SlurmArgs),
    Merge(elsewhere::MergeArgs),
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> Done {
    match &args.command {
        Some(Command::Status(args)) => status::show(args),
        Some(Command::Watch(args)) => watch::main(args),
        Some(Command::Report(args)) => status::report(args),
        Some(Command::Plan(args)) => elsewhere::plan(args),
        Some(Command::Slurm(args)) => elsewhere::slurm(args),
        Some(Command::Merge(args)) => elsewhere::merge_parts(args),
        None => runs::main(args),
    }
}
