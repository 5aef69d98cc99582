//! `study transfer`: how the winners of each scenario do in the others.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::cli::args::useful_threads;
use crate::cli::output::{CommandResult, Format};
use crate::cli::progress::repeats;
use crate::evolution::Workers;
use crate::learning::Gate;
use crate::report::{Numbers, Study, TransferPlan, transfer, transfer_table};
use crate::words::quoted;

/// Evaluate the winners of each scenario in every scenario.
///
/// The structure of each winner learns from nothing in every scenario of the study and is then
/// scored. The table has a row for the winners of each scenario and a column for each scenario
/// that they are scored in: mean time steps per trial, with the 95 % interval over winners. The
/// least of a column is marked: if it is on the diagonal, each scenario wants its own structure.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab study transfer studies/learning --arm timed --seeds 1..5")]
pub(super) struct TransferArgs {
    /// Study folder.
    dir: PathBuf,

    /// The arm whose winners are evaluated, with its settings [default: the first arm].
    #[arg(long, value_name = "ARM")]
    arm: Option<String>,

    /// The seeds of the winners [default: those of all runs that are done].
    #[arg(long, value_name = "A..B")]
    seeds: Option<Numbers>,

    /// Number of trials before scoring starts.
    #[arg(long, value_name = "W", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(0..=100_000))]
    warmup: u32,

    /// Number of scored trials.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    trials: u32,

    /// Number of threads, at most one per processor; 0 means one per processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Output format.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs `study transfer`.
pub(super) fn main(args: &TransferArgs) -> CommandResult {
    let study = Study::open(&args.dir)?;
    let arms = &study.plan.arms;
    let arm = match &args.arm {
        None => 0,
        Some(name) => {
            let place = arms.iter().position(|arm| arm.name == *name);
            place.ok_or_else(|| {
                let names: Vec<_> = arms.iter().map(|arm| arm.name.as_str()).collect();
                format!(
                    "--arm: found {}; allowed: {}",
                    quoted(name),
                    names.join(", ")
                )
            })?
        }
    };
    let plan = TransferPlan {
        arm,
        seeds: args.seeds.clone(),
        warmup: args.warmup as usize,
        trials: args.trials as usize,
    };
    let workers = Workers::new(useful_threads(args.threads).get())?;
    let bar = repeats(0);
    let show = |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let transfers = transfer(&study, &plan, &workers, &Gate::default(), &show)?;
    bar.finish_and_clear();
    args.format.print(&transfers, |transfers| {
        format!(
            "{}, arm {}: mean time steps of {} trials after {}, +- 95 % interval over winners\n\n{}",
            study.plan.name,
            arms[arm].name,
            args.trials,
            args.warmup,
            transfer_table(transfers).markdown()
        )
    })?;
    Ok(ExitCode::SUCCESS)
}
