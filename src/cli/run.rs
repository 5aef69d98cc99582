//! `maxq-lab run`: evolve hierarchies for a scenario.

use std::path::PathBuf;

use super::how::How;
use super::live;
use super::output::Done;
use super::signals::Caught;
use super::source::Source;
use crate::lab::start;

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
    source: Source,

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
    how: How,
}

/// Carries out the command.
pub(super) fn main(args: Args) -> Done {
    let mut scenario = args.source.load()?;
    if let Some(generations) = args.generations {
        scenario.evolution.generation_limit = generations;
        scenario = scenario.checked("--generations")?;
    }
    let folder = args.out.unwrap_or_else(|| {
        PathBuf::from("runs").join(format!("{}-seed{}", scenario.name, args.seed))
    });
    let signals = Caught::now()?;
    let outfit = live::outfit(&args.how)?;
    let run = start(scenario, args.seed, &folder, &args.how.options(args.force))?;
    live::follow(run, outfit, signals, &args.how)
}
