//! `maxq-lab run` and `maxq-lab resume`.

use std::path::PathBuf;

use super::args::{ExecutionArgs, ScenarioArgs};
use super::live;
use super::output::{self, CommandResult};
use super::signals::SignalWatcher;
use crate::lab::{Invocation, LastSign, RunFolder, resume, resume_at, start};
use crate::scenario::Then;

/// Evolve hierarchies for a scenario.
///
/// On a terminal, a dashboard shows the evolution as it happens; press ? there for help.
/// Without a terminal, or with --headless, there is no dashboard. The result is bit for bit
/// the same.
///
/// The run is saved continuously in its folder: run.json (what is run), events.jsonl (every
/// generation), checkpoint.json (the latest state), generations/ (earlier checkpoints) and, at
/// the end, summary.json; learning.json with --then. It can be interrupted at any moment, even with kill -9, and resumed
/// without loss: 'maxq-lab resume DIR'.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab run environment-2 --seed 7
  maxq-lab run my-scenario.json --threads 4 --format json > result.json
  maxq-lab run environment-1 --set evolution.selection=random --out runs/drift
  maxq-lab run environment-4 --then learn=2000     how the best goes on learning
  maxq-lab run environment-3 --fps 2               over a slow connection
  maxq-lab run environment-3 --headless            a progress bar, no dashboard")]
pub(super) struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,

    /// Random seed: the same seed gives bit for bit the same result.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    seed: u64,

    /// Maximum number of generations; a run that converges ends earlier [default: the
    /// scenario's evolution.generation_limit].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    generations: Option<u64>,

    /// What happens after evolution: 'learn=2000' lets the best hierarchy live 2000 more trials
    /// and go on learning; learning.json holds them [default: the scenario's evolution.then].
    #[arg(long, value_name = "learn=TRIALS", value_parser = then)]
    then: Option<Then>,

    /// Run folder [default: runs/SCENARIO-seedN].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace an existing run in the folder.
    #[arg(long)]
    force: bool,

    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Runs `maxq-lab run`.
pub(super) fn main(args: Args) -> CommandResult {
    let mut scenario = args.scenario.load()?;
    if let Some(generations) = args.generations {
        scenario.evolution.generation_limit = generations;
        scenario = scenario.checked("--generations")?;
    }
    if args.then.is_some() {
        scenario.evolution.then = args.then;
        scenario = scenario.checked("--then")?;
    }
    let folder = args.out.unwrap_or_else(|| {
        PathBuf::from("runs").join(format!("{}-seed{}", scenario.name, args.seed))
    });
    let execution = &args.execution;
    let signals = SignalWatcher::start()?;
    let dashboard = execution.dashboard.unless(execution.headless)?;
    let kept = if args.force {
        RunFolder::foreign_files(&folder)
    } else {
        Vec::new()
    };
    let run = start(scenario, args.seed, &folder, &execution.options(args.force))?;
    output::warnings(&run.warnings);
    output::notes(&run.notes);
    if !kept.is_empty() {
        let folder = folder.display();
        output::message(&format!("note: kept in {folder}: {}", kept.join(", ")));
    }
    live::follow(run, dashboard, signals, execution)
}

/// Reads `learn=2000`.
fn then(text: &str) -> Result<Then, String> {
    let trials = text.strip_prefix("learn=");
    let trials = trials.and_then(|trials| trials.parse().ok());
    trials
        .map(Then::Learn)
        .ok_or_else(|| String::from("allowed: learn= and a number of trials from 1 to 1000000"))
}

/// Resume a run that was interrupted.
///
/// The result is bit for bit the same as if the run had never been interrupted. With
/// --generations, a run that reached its limit continues to a new limit. On a terminal, a
/// dashboard shows the run, including its past generations.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab resume runs/environment-3-seed7
  maxq-lab resume runs/environment-3-seed7 --generations 400        beyond its limit
  maxq-lab resume runs/environment-3-seed7 --at 12                  from generation 12 again")]
pub(super) struct ResumeArgs {
    /// Run folder.
    run_dir: PathBuf,

    /// New maximum number of generations.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    generations: Option<u64>,

    /// Resume from the kept state after generation N and compute what came later again.
    ///
    /// A state in generations/ can take the place of a damaged checkpoint.json.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    at: Option<u64>,

    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Runs `maxq-lab resume`.
pub(super) fn resume_main(args: &ResumeArgs) -> CommandResult {
    let signals = SignalWatcher::start()?;
    let manifest = RunFolder::read_manifest(&args.run_dir)?;
    let (then, now) = (manifest.started, Invocation::now(0));
    if (&then.version, &then.commit) != (&now.version, &now.commit) {
        output::message(&format!(
            "note: the run was started by version {} ({}), this is {} ({}): the result may differ \
             from that of an uninterrupted run",
            then.version, then.commit, now.version, now.commit
        ));
    }
    if let Some(sign) = LastSign::read(&args.run_dir).filter(|sign| sign.error.is_some()) {
        output::message(&format!("note: the process before {sign}"));
    }
    let execution = &args.execution;
    let dashboard = execution.dashboard.unless(execution.headless)?;
    let (folder, limit, options) = (&args.run_dir, args.generations, execution.options(false));
    let run = match args.at {
        None => resume(folder, limit, &options),
        Some(at) => resume_at(folder, at, limit, &options),
    }?;
    output::notes(&run.notes);
    output::warnings(&run.warnings);
    live::follow(run, dashboard, signals, execution)
}
