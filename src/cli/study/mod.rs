//! `maxq-lab study`: many runs, how far they are, what comes out.

mod elsewhere;
mod progress;
mod runs;
mod status;
mod table;

use std::path::{Path, PathBuf};

use clap::Subcommand;

use super::args::OnHangup;
use super::dashboard::DashboardArgs;
use super::output::{CommandResult, Failure};
use crate::lab::Keep;
use crate::report::{Arm, Base, Numbers, Plan, Study};
use crate::scenario::{EMBEDDED, EMBEDDED_PLANS, Embedded};

/// Do many runs: scenarios, arms and seeds of a plan.
///
/// Every scenario, arm and seed gets a run folder of its own, DIR/SCENARIO/ARM/seed-N. Runs
/// that are done are skipped, runs that were broken off are gone on with, as many at a
/// time as there are processors, each on one thread. Ending this at any moment and starting
/// it again gives the same bytes. On a terminal a table shows the runs, and opens any of them in
/// the dashboard: press ? there. When a run is over, the structure of its winner is
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
  maxq-lab study studies/thesis                            go on with a study
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

    /// Open no table of the runs, although there is a terminal; a bar on standard error shows
    /// the progress.
    #[arg(long)]
    headless: bool,

    /// What becomes of the study when the line drops: it goes on without a terminal, or is
    /// saved and ended.
    #[arg(long, value_enum, default_value_t)]
    on_hangup: OnHangup,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// A study: what to run and where.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct What {
    /// A plan (a file, or the name of an embedded one), or the folder of a study to go on
    /// with, or scenarios (files, or names of embedded ones).
    #[arg(required = true, value_name = "PLAN|DIR|SCENARIO")]
    what: Vec<String>,

    /// Seeds for scenarios: numbers and ranges, both ends counted; a plan has its own
    /// [default: 1..10].
    #[arg(long, value_name = "A..B")]
    seeds: Option<Numbers>,

    /// Arms for scenarios; a plan has its own [default: evolved,random_selection].
    #[arg(long, value_name = "ARM,...", value_delimiter = ',')]
    arms: Vec<String>,

    /// The folder of the study [default for the folder of a study: itself].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl What {
    /// The study, its folder made if it is not there.
    pub(super) fn study(&self) -> Result<Study, Failure> {
        let Study { plan, folder } = self.planned()?;
        Ok(Study::create(plan, &folder)?)
    }

    /// The study as it is to be; nothing is made.
    pub(super) fn planned(&self) -> Result<Study, Failure> {
        let plan = self.plan()?;
        let itself = || match self.what.as_slice() {
            [only] if Study::is_in(Path::new(only)) => Some(PathBuf::from(only)),
            _ => None,
        };
        let folder = self.out.clone().or_else(itself);
        let folder = folder.ok_or("--out: found none; allowed: the folder of the study")?;
        Ok(Study { plan, folder })
    }

    fn plan(&self) -> Result<Plan, Failure> {
        if let [only] = self.what.as_slice()
            && Plan::is_plan(only)
        {
            if self.seeds.is_some() || !self.arms.is_empty() {
                let message = "--seeds, --arms: found beside a plan, which has its own; \
                               allowed: beside scenarios";
                return Err(message.into());
            }
            return Ok(Plan::load(only)?);
        }
        self.refuse_what_is_no_scenario()?;
        let arms = self.arms.iter().map(|name| {
            let base = Base::find(name);
            base.map(Arm::of)
                .ok_or_else(|| format!("--arms: found {name:?}; allowed: {}", Base::names()))
        });
        let mut arms: Vec<_> = arms.collect::<Result<_, _>>()?;
        if arms.is_empty() {
            arms = [Base::Evolved, Base::RandomSelection].map(Arm::of).into();
        }
        let seeds = match &self.seeds {
            Some(seeds) => seeds.clone(),
            None => "1..10".parse::<Numbers>()?,
        };
        Ok(Plan::of(&self.what, seeds, arms)?)
    }

    /// A folder, and a single name that nothing has, may have been meant for a plan or a study.
    fn refuse_what_is_no_scenario(&self) -> Result<(), Failure> {
        if let Some(folder) = self.what.iter().find(|name| Path::new(name).is_dir()) {
            Study::open(Path::new(folder))?;
            let message = format!("{folder}: found a study beside others; allowed: alone");
            return Err(message.into());
        }
        let names = |all: &[Embedded]| all.iter().map(|known| known.name).collect::<Vec<_>>();
        let (plans, scenarios) = (names(EMBEDDED_PLANS), names(EMBEDDED));
        match self.what.as_slice() {
            [only] if !Path::new(only).exists() && !scenarios.contains(&only.as_str()) => {
                let (plans, scenarios) = (plans.join(", "), scenarios.join(", "));
                let message = format!(
                    "no plan, study or scenario {only:?}: there is no such file or folder, the \
                     embedded plans are {plans}, the embedded scenarios {scenarios}"
                );
                Err(message.into())
            }
            _ => Ok(()),
        }
    }
}

#[derive(Debug, Subcommand)]
enum Command {
    Status(status::StatusArgs),
    Watch(status::WatchArgs),
    Report(status::ReportArgs),
    Plan(elsewhere::PlanArgs),
    Slurm(elsewhere::SlurmArgs),
    Merge(elsewhere::MergeArgs),
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> CommandResult {
    match &args.command {
        Some(Command::Status(args)) => status::show(args),
        Some(Command::Watch(args)) => status::watch(args),
        Some(Command::Report(args)) => status::report(args),
        Some(Command::Plan(args)) => elsewhere::plan(args),
        Some(Command::Slurm(args)) => elsewhere::slurm(args),
        Some(Command::Merge(args)) => elsewhere::merge_parts(args),
        None => runs::main(args),
    }
}
