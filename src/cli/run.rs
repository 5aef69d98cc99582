//! `maxq-lab run`: evolve hierarchies for a scenario.

use std::path::PathBuf;

use super::live::{self, OnHangup};
use super::output::{Done, Failure, Format, counted};
use super::show::Show;
use super::signals::Caught;
use super::source::Source;
use crate::hierarchy::{Glyphs, draw};
use crate::lab::{Keep, Outcome, RunOptions, departures, in_words, start};
use crate::scenario::{Scenario, Selection};

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

/// How a run is carried out, whatever it is.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct How {
    /// Computing threads; 0 means one for each processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// Checkpoints kept in generations/: all, none, or every N-th generation's.
    #[arg(long, value_name = "all|none|N", default_value = "all")]
    keep: Keep,

    /// Open no dashboard, although there is a terminal; a bar on standard error shows the
    /// progress.
    #[arg(long)]
    pub(super) headless: bool,

    /// What becomes of the run when the line drops: it goes on without a terminal, or is
    /// saved and ended. 'maxq-lab watch' and 'maxq-lab resume' find it again.
    #[arg(long, value_enum, default_value_t)]
    pub(super) on_hangup: OnHangup,

    /// How to report the result.
    #[arg(long, value_enum, default_value_t)]
    pub(super) format: Format,

    #[command(flatten)]
    pub(super) show: Show,
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

    /// The arguments with which another process goes on with the run as it was, without a
    /// terminal.
    pub(super) fn resume_headless(&self) -> Vec<String> {
        let (threads, keep) = (self.threads.to_string(), self.keep.to_string());
        let arguments = [
            "resume",
            "--headless",
            "--threads",
            &threads,
            "--keep",
            &keep,
        ];
        arguments.map(String::from).to_vec()
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
    let outfit = live::outfit(&args.how)?;
    let run = start(scenario, args.seed, &folder, &args.how.options(args.force))?;
    live::follow(run, outfit, signals, &args.how)
}

/// A result, for people.
pub(super) fn describe(outcome: &Outcome, scenario: &Scenario) -> Result<String, Failure> {
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
            "{}, seed {}: {ending} {}",
            outcome.scenario,
            outcome.seed,
            counted(*generations, "generation")
        ),
        format!(
            "{control_steps} control steps in all, {wall_seconds:.2} s now, in {}",
            outcome.run_dir
        ),
    ];
    // A result must not pass for that of the embedded scenario whose name it has.
    let changed = in_words(&departures(scenario));
    lines.extend(changed.map(|changed| format!("changed: {changed}")));
    if let Some(best) = &outcome.best {
        lines.push(format!(
            "{} {}: {:.1} time steps a trial, {} composite and {}",
            first(scenario.evolution.selection),
            best.id,
            best.fitness,
            best.composites,
            counted(best.primitives.len() as u64, "primitive subtask")
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
        lines.push(format!("\n{}", caution(scenario.evolution.selection)));
    }
    Ok(lines.join("\n") + "\n")
}

/// What the individual of rank 1 is.
fn first(selection: Selection) -> &'static str {
    match selection {
        Selection::Fitness => "best individual",
        Selection::Random => "individual that chance ranked first,",
    }
}

/// What to bear in mind about it.
fn caution(selection: Selection) -> &'static str {
    match selection {
        Selection::Fitness => {
            "The best of many is also the luckiest; 'maxq-lab evaluate' tells how good its \
             structure is."
        }
        Selection::Random => {
            "Chance took the place of fitness here: no individual was selected for being good."
        }
    }
}
