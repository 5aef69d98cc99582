//! `maxq-lab run` and `maxq-lab resume`.

use std::path::PathBuf;

use super::args::{ExecutionArgs, ScenarioArgs};
use super::live;
use super::output::{self, CommandResult};
use super::signals::SignalWatcher;
use crate::lab::{Invocation, RunFolder, resume, start};

/// Evolve hierarchies for a scenario.
///
/// On a terminal a dashboard shows the evolution while it goes on: press ? there to see what
/// it can do. Without a terminal, or with --headless, there is none, and the result is the
/// same, bit for bit.
///
/// The run is kept in its folder as it goes: run.json (what was run), events.jsonl (every
/// generation), checkpoint.json (the latest state), generations/ (the states before), and
/// at the end summary.json. It can be interrupted at any moment, by kill -9 too, and
/// resumed without losing anything: 'maxq-lab resume DIR'.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab run environment-2 --seed 7
  maxq-lab run my-scenario.json --threads 4 --format json > result.json
  maxq-lab run environment-1 --set evolution.selection=random --out runs/drift
  maxq-lab run environment-3 --fps 2               over a slow line
  maxq-lab run environment-3 --headless            no dashboard: a progress bar")]
pub(super) struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,

    /// Seed of all random streams: the same seed gives the same bits.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    seed: u64,

    /// Generations after which the run ends although it has not converged.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    generations: Option<u64>,

    /// The run folder [default: runs/SCENARIO-seedN].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace the run in the folder, if there is one.
    #[arg(long)]
    force: bool,

    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Carries out the command.
pub(super) fn main(args: Args) -> CommandResult {
    let mut scenario = args.scenario.load()?;
    if let Some(generations) = args.generations {
        scenario.evolution.generation_limit = generations;
        scenario = scenario.checked("--generations")?;
    }
    let folder = args.out.unwrap_or_else(|| {
        PathBuf::from("runs").join(format!("{}-seed{}", scenario.name, args.seed))
    });
    let signals = SignalWatcher::now()?;
    let dashboard = live::dashboard(&args.execution)?;
    let run = start(
        scenario,
        args.seed,
        &folder,
        &args.execution.options(args.force),
    )?;
    live::follow(run, dashboard, signals, &args.execution)
}

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
pub(super) struct ResumeArgs {
    /// The run folder.
    run_dir: PathBuf,

    /// Another generation limit.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    generations: Option<u64>,

    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Carries out the command.
pub(super) fn resume_main(args: &ResumeArgs) -> CommandResult {
    let signals = SignalWatcher::now()?;
    let manifest = RunFolder::read_manifest(&args.run_dir)?;
    let (then, now) = (manifest.started, Invocation::now(0));
    if (&then.version, &then.commit) != (&now.version, &now.commit) {
        output::message(&format!(
            "note: the run was started by version {} ({}), this is {} ({}): the bits may differ from \
             those of a run never interrupted",
            then.version, then.commit, now.version, now.commit
        ));
    }
    let dashboard = live::dashboard(&args.execution)?;
    let run = resume(
        &args.run_dir,
        args.generations,
        &args.execution.options(false),
    )?;
    live::follow(run, dashboard, signals, &args.execution)
}
