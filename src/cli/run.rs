//! `maxq-lab run`: evolve hierarchies for a scenario.

use std::path::PathBuf;
use std::process::ExitCode;

use super::output::{self, Done, Format};
use super::progress;
use super::signals::Caught;
use super::source::Source;
use crate::hierarchy::{Glyphs, draw};
use crate::lab::{Keep, Outcome, Run, RunOptions, start};

/// Evolve hierarchies for a scenario.
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
  maxq-lab run environment-1 --set evolution.selection=random --out runs/drift")]
pub(super) struct Args {
    #[command(flatten)]
    source: Source,

    /// Seed of all random streams: the same seed gives the same bits.
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Generations after which the run ends although it has not converged.
    #[arg(long, value_name = "N")]
    generations: Option<u64>,

    #[command(flatten)]
    how: How,

    /// The run folder [default: runs/SCENARIO-seedN].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace the run in the folder, if there is one.
    #[arg(long)]
    force: bool,
}

/// How a run is carried out, whatever it is.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct How {
    /// Computing threads; 0 means one for each processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Checkpoints kept in generations/: all, none, or every N-th generation's.
    #[arg(long, value_name = "all|none|N", default_value = "all")]
    keep: Keep,

    /// Show no progress, although standard error is a terminal.
    #[arg(long)]
    headless: bool,

    /// How to report the result.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

impl How {
    /// The library's options.
    pub(super) fn options(&self, force: bool) -> RunOptions {
        RunOptions {
            threads: usize::from(self.threads),
            keep: self.keep,
            force,
        }
    }
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
    let run = start(scenario, args.seed, &folder, &args.how.options(args.force))?;
    follow(run, signals, &args.how)
}

/// Follows a run to its end and reports its result. Signals were caught before the run
/// began, so that none falls between.
pub(super) fn follow(run: Run, signals: Caught, how: &How) -> Done {
    let controls = run.controls.clone();
    let ended = signals.then(move || controls.stop())?;
    let evolution = &run.scenario.evolution;
    let (limit, population) = (evolution.generation_limit, evolution.population_size);
    progress::follow(&run.events, limit, population, !how.headless);
    let scenario = run.scenario.clone();
    let outcome = run.join()?;
    match how.format {
        Format::Json => output::json(&outcome)?,
        Format::Text => output::text(&describe(&outcome, &scenario)?)?,
    }
    if outcome.stopped {
        let folder = &outcome.run_dir;
        output::message(&format!("stopped; go on with: maxq-lab resume {folder}"));
    }
    Ok(ended
        .exit_code()
        .filter(|_| outcome.stopped)
        .map_or(ExitCode::SUCCESS, ExitCode::from))
}

fn describe(
    outcome: &Outcome,
    scenario: &crate::scenario::Scenario,
) -> Result<String, super::output::Failure> {
    let Outcome {
        generations,
        control_steps,
        wall_seconds,
        ..
    } = outcome;
    let ending = match (outcome.converged, outcome.stopped) {
        (true, _) => "converged after",
        (_, true) => "stopped after",
        _ => "reached its limit of",
    };
    let mut lines = vec![
        format!(
            "{}, seed {}: {ending} {generations} generations",
            outcome.scenario, outcome.seed
        ),
        format!(
            "{control_steps} control steps in all, {wall_seconds:.2} s now, in {}",
            outcome.run_dir
        ),
    ];
    if let Some(best) = &outcome.best {
        lines.push(format!(
            "best individual {}: {:.1} time steps a trial, {} composite and {} primitive subtasks",
            best.id,
            best.fitness,
            best.composites,
            best.primitives.len()
        ));
        lines.push(String::new());
        lines.extend(super::tree::with_tree(
            scenario,
            &best.tree,
            |tree, catalogue| draw(tree, catalogue, Glyphs::of_locale()),
        )?);
        lines.push(String::new());
        for (index, primitives) in best.primitives_by_state_type.iter().enumerate() {
            lines.push(format!(
                "state type {}: {}",
                index + 1,
                primitives.join(", ")
            ));
        }
        lines.push(String::from(
            "\nThe best of many is also the luckiest; 'maxq-lab evaluate' tells how good its structure is.",
        ));
    }
    Ok(lines.join("\n") + "\n")
}
