//! `maxq-lab evaluate`: measures the structure of a hierarchy.

use std::time::Instant;

use serde::Serialize;

use super::answer::{AnswerArgs, Resources};
use super::args::ScenarioArgs;
use super::output::{CommandResult, Failure, counted};
use super::progress::repeats;
use crate::lab::{Protocol, Scored, overrides, summarise, with_changes};

/// Evaluate the structure of a hierarchy.
///
/// Each repeat creates a new hierarchy with this structure. The hierarchy learns during the
/// warm-up trials and continues to learn while it is scored. Repeats are distributed over
/// separately trained primitive sets (sets of primitive subtasks); the standard error includes
/// the differences between these sets.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab evaluate environment-3 --tree '(Root Avoid Wander ApproachBattery ApproachNest)'")]
pub(super) struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,

    /// Hierarchy, as text: '(Root Wander ApproachBattery ApproachNest)'.
    #[arg(long)]
    tree: String,

    /// Number of trials in each repeat before scoring starts.
    #[arg(long, value_name = "W", default_value_t = 8, value_parser = clap::value_parser!(u64).range(0..=100_000))]
    warmup: u64,

    /// Number of scored trials in each repeat.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    trials: u64,

    /// Number of repeats.
    #[arg(long, value_name = "R", default_value_t = 64, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    repeats: u64,

    /// Number of separately trained primitive sets; at most one per repeat is used.
    #[arg(long, alias = "banks", value_name = "B", default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    primitive_sets: u64,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// The evaluation of a structure.
#[derive(Serialize)]
pub(super) struct Report {
    scenario: String,
    /// Settings that differ from the built-in scenario of this name.
    changed: Option<String>,
    seed: u64,
    warmup: usize,
    trials: usize,
    #[serde(rename = "banks")]
    primitive_sets: usize,
    #[serde(flatten)]
    scored: Scored,
    control_steps_per_second: f64,
}

/// Runs `maxq-lab evaluate`.
pub(super) fn main(args: Args) -> CommandResult {
    let scenario = args.scenario.load()?;
    args.answer
        .answer(scenario, |resources| args.compute(&resources), describe)
}

impl Args {
    fn compute(&self, resources: &Resources<'_>) -> Result<Report, Failure> {
        let Resources {
            experiment,
            workers,
            gate,
        } = *resources;
        let tree = experiment
            .read_tree(&self.tree)
            .map_err(|error| format!("--tree: {error}"))?;
        let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
        let protocol = Protocol {
            warmup: count(self.warmup),
            trials: count(self.trials),
            repeats: count(self.repeats),
            // A set that no repeat uses is not trained.
            primitive_sets: count(self.primitive_sets),
        };
        let started = Instant::now();
        let bar = repeats(self.repeats);
        let show = |done| bar.set_position(done as u64);
        let scored = experiment.evaluate(&tree, &protocol, workers, gate, &show)?;
        bar.finish_and_clear();
        let computed = gate.control_steps() as f64;
        let scenario = experiment.scenario();
        Ok(Report {
            scenario: scenario.name.clone(),
            changed: summarise(&overrides(scenario)),
            seed: self.answer.seed,
            warmup: protocol.warmup,
            trials: protocol.trials,
            primitive_sets: protocol.primitive_sets.min(protocol.repeats),
            control_steps_per_second: computed / started.elapsed().as_secs_f64(),
            scored,
        })
    }
}

fn describe(report: &Report) -> String {
    let scored = &report.scored;
    let evaluation = &scored.evaluation;
    let error = |error: Option<f64>, digits: usize| match error {
        Some(error) => format!(" +- {error:.digits$} (standard error)"),
        None => String::new(),
    };
    let single = if evaluation.standard_error.is_none() {
        " (no standard error from a single repeat)"
    } else {
        ""
    };
    format!(
        "{}\n{}, seed {}: {} of {} after {}, {}{single}\n\
         {:.1}{} time steps per trial\n\
         {:.2}{} return per trial (sum of rewards)\n\
         {:.2} % of trials delivered\n\
         {} control steps, {:.0} per second including the training of the primitive subtasks\n",
        evaluation.tree,
        with_changes(&report.scenario, report.changed.as_deref()),
        report.seed,
        counted(evaluation.repeats.len() as u64, "repeat"),
        counted(report.trials as u64, "scored trial"),
        counted(report.warmup as u64, "warm-up trial"),
        counted(report.primitive_sets as u64, "primitive set"),
        evaluation.mean,
        error(evaluation.standard_error, 1),
        scored.mean_return,
        error(scored.return_standard_error, 2),
        100.0 * evaluation.delivered_share,
        evaluation.control_steps,
        report.control_steps_per_second,
    )
}
