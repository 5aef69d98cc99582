//! `maxq-lab study`: many runs, their progress and their report.

mod add;
mod distribute;
mod progress;
mod runs;
mod status;
mod table;
mod transfer;

use std::path::{Path, PathBuf};

use clap::Subcommand;

use super::args::OnHangup;
use super::dashboard::DashboardArgs;
use super::names;
use super::output::{self, CommandResult, Failure};
use crate::lab::{Keep, lock_warning};
use crate::report::{Arm, Base, Numbers, Plan, Study, plan_warnings};
use crate::scenario::{EMBEDDED, EMBEDDED_PLANS, Embedded};
use crate::words::quoted;

/// Run many seeds of scenarios and compare them.
///
/// A study runs every combination of scenario, arm and seed, each in its own folder:
/// DIR/SCENARIO/ARM/seed-N. It runs as many at a time as there are processors, each on one
/// thread. Finished runs are skipped and interrupted runs are resumed, so a study can be stopped
/// at any moment and started again, with the same bytes as result. On a terminal, a table shows
/// the runs and opens any of them in the dashboard; press ? there for help. When a run ends,
/// the structure of its best individual is evaluated again: with new hierarchies, new trials and
/// newly trained primitive subtasks.
///
/// Arms: evolved; random_selection (selection ignores fitness: the control that separates
/// selection from drift); random_choice (composite subtasks choose uniformly: shows what their
/// learning adds); hand_designed (the complete hierarchy, learning only); random_search (random
/// hierarchies instead of offspring); no_learning_inheritance (Darwinian: offspring inherit no
/// learned values); flat (a root that chooses among all primitive subtasks). hand_designed,
/// random_search and flat run for as many generations as the evolved run of the same seed.
#[derive(Debug, clap::Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "\
Examples:
  maxq-lab study thesis --out studies/thesis               test the claims of the thesis
  maxq-lab study environment-1 environment-2 --seeds 1..10 --arms evolved,flat --out mine
  maxq-lab study studies/thesis                            resume a study
  maxq-lab study add studies/thesis --seeds 31..60         plan more runs for it
  maxq-lab study status studies/thesis                     show its progress
  maxq-lab study watch studies/thesis                      watch it live
  maxq-lab study report studies/thesis                     write its report
  maxq-lab study transfer studies/thesis                   the winners in all scenarios"
)]
pub(super) struct Args {
    #[command(subcommand)]
    command: Option<Command>,

    #[command(flatten)]
    study: StudyArgs,

    /// Do only these runs: a number, a range of numbers, or SCENARIO/ARM/seed-N; may be repeated.
    ///
    /// 'maxq-lab study commands' lists the runs in order.
    #[arg(long, value_name = "RUN")]
    only: Vec<String>,

    /// Number of runs at a time; 0 means one per processor.
    #[arg(long, short, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    jobs: u16,

    /// Which states to keep of every run, for looking at past generations: thinned (the last 64,
    /// then fewer and fewer), all, none, or one every N generations.
    #[arg(long, value_name = "thinned|all|none|N", default_value = "none")]
    keep: Keep,

    /// Show a progress bar instead of the table of runs.
    #[arg(long)]
    headless: bool,

    /// What to do when the terminal is lost (SIGHUP): continue without one, or save and exit.
    #[arg(long, value_name = "ACTION", value_enum, default_value_t)]
    on_hangup: OnHangup,

    #[command(flatten)]
    dashboard: DashboardArgs,
}

/// What a study runs, and where.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct StudyArgs {
    /// Study plan (file or built-in name), folder of a study to resume, or scenarios (files or
    /// built-in names).
    #[arg(required = true, value_name = "PLAN|DIR|SCENARIO", value_parser = names::scenarios_and_plans(), hide_possible_values = true)]
    what: Vec<String>,

    /// Seeds, for scenarios: numbers and inclusive ranges, such as 1..10,42 [default: 1..10; a
    /// plan has its own].
    #[arg(long, value_name = "A..B")]
    seeds: Option<Numbers>,

    /// Arms, for scenarios [default: evolved,random_selection; a plan has its own].
    #[arg(long, value_name = "ARM,...", value_delimiter = ',')]
    arms: Vec<String>,

    /// Study folder [default: the folder given as DIR].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl StudyArgs {
    /// The study; creates its folder if it does not exist.
    pub(super) fn create(&self) -> Result<Study, Failure> {
        let Study { plan, folder } = self.planned()?;
        let warnings = plan_warnings(&plan);
        let study = Study::create(plan, &folder)?;
        output::warnings(&warnings);
        let unlocked = lock_warning(&study.folder);
        let unlocked = unlocked.map(|odd| format!("{}: {odd}", study.folder.display()));
        output::warnings(unlocked.as_slice());
        Ok(study)
    }

    /// The study as it would be created; creates nothing.
    pub(super) fn planned(&self) -> Result<Study, Failure> {
        let plan = self.plan()?;
        let itself = || match self.what.as_slice() {
            [only] if Study::is_in(Path::new(only)) => Some(PathBuf::from(only)),
            _ => None,
        };
        let folder = self.out.clone().or_else(itself);
        let folder = folder.ok_or("--out: found none; allowed: a folder for the study")?;
        Ok(Study { plan, folder })
    }

    fn plan(&self) -> Result<Plan, Failure> {
        if let [only] = self.what.as_slice()
            && Plan::is_plan(only)
        {
            if self.seeds.is_some() || !self.arms.is_empty() {
                let message = "--seeds, --arms: found with a plan, which has its own; \
                               allowed: with scenarios";
                return Err(message.into());
            }
            return Ok(Plan::load(only)?);
        }
        self.refuse_other_than_scenarios()?;
        let mut arms = arms_of(&self.arms)?;
        if arms.is_empty() {
            arms = [Base::Evolved, Base::RandomSelection].map(Arm::of).into();
        }
        let seeds = match &self.seeds {
            Some(seeds) => seeds.clone(),
            None => "1..10".parse::<Numbers>()?,
        };
        Ok(Plan::of(&self.what, seeds, arms)?)
    }

    /// Refuses a folder, and a single unknown name, which may have been meant as a plan or study.
    fn refuse_other_than_scenarios(&self) -> Result<(), Failure> {
        if let Some(folder) = self.what.iter().find(|name| Path::new(name).is_dir()) {
            Study::open(Path::new(folder))?;
            let message =
                format!("{folder}: found a study folder with other arguments; allowed: alone");
            return Err(message.into());
        }
        let names = |all: &[Embedded]| all.iter().map(|known| known.name).collect::<Vec<_>>();
        let (plans, scenarios) = (names(EMBEDDED_PLANS), names(EMBEDDED));
        match self.what.as_slice() {
            [only] if !Path::new(only).exists() && !scenarios.contains(&only.as_str()) => {
                let (plans, scenarios) = (plans.join(", "), scenarios.join(", "));
                let message = format!(
                    "no plan, study or scenario {only:?}; allowed: a file, a study folder, a \
                     built-in plan ({plans}) or a built-in scenario ({scenarios})"
                );
                Err(message.into())
            }
            _ => Ok(()),
        }
    }
}

/// The arms of the bases with these names.
fn arms_of(names: &[String]) -> Result<Vec<Arm>, Failure> {
    let arm = |name: &String| {
        let base = Base::find(name).map(Arm::of);
        base.ok_or_else(|| format!("--arms: found {}; allowed: {}", quoted(name), Base::names()))
    };
    Ok(names.iter().map(arm).collect::<Result<_, _>>()?)
}

#[derive(Debug, Subcommand)]
enum Command {
    Add(add::AddArgs),
    Status(status::StatusArgs),
    Watch(status::WatchArgs),
    Report(status::ReportArgs),
    #[command(alias = "plan")]
    Commands(distribute::CommandsArgs),
    Slurm(distribute::SlurmArgs),
    Merge(distribute::MergeArgs),
    Transfer(transfer::TransferArgs),
}

/// Runs `maxq-lab study` and its subcommands.
pub(super) fn main(args: &Args) -> CommandResult {
    match &args.command {
        Some(Command::Add(args)) => add::main(args),
        Some(Command::Status(args)) => status::show(args),
        Some(Command::Watch(args)) => status::watch(args),
        Some(Command::Report(args)) => status::report(args),
        Some(Command::Commands(args)) => distribute::commands(args),
        Some(Command::Slurm(args)) => distribute::slurm(args),
        Some(Command::Merge(args)) => distribute::merge_parts(args),
        Some(Command::Transfer(args)) => transfer::main(args),
        None => runs::main(args),
    }
}
