//! `maxq-lab evaluate`: how good is a structure?

use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;

use super::answer::answer;
use super::output::{Done, Failure, Format};
use super::progress::bar;
use super::source::Source;
use crate::evolution::{Experiment, Workers, read_tree};
use crate::lab::{Protocol, Scored, WorldTask, evaluate};
use crate::learning::Gate;
use crate::worlds::World;

/// Tell how good a hierarchy's structure is.
///
/// Each repeat is a fresh hierarchy of the structure that learns for the warm-up trials and
/// is then scored, learning on. The repeats are spread over separately trained sets of
/// primitive subtasks (banks), whose differences are part of the standard error.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab evaluate environment-3 --tree '(Root Avoid Wander ApproachBattery ApproachNest)'")]
pub(super) struct Args {
    #[command(flatten)]
    source: Source,

    /// The hierarchy, as text: '(Root Wander ApproachBattery ApproachNest)'.
    #[arg(long)]
    tree: String,

    /// Trials of each repeat before scoring starts.
    #[arg(long, value_name = "W", default_value_t = 8, value_parser = clap::value_parser!(u64).range(0..=100_000))]
    warmup: u64,

    /// Scored trials of each repeat.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    trials: u64,

    /// Fresh hierarchies.
    #[arg(long, value_name = "R", default_value_t = 64, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    repeats: u64,

    /// Separately trained sets of primitive subtasks.
    #[arg(long, value_name = "B", default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    banks: u64,

    /// Seed of all random streams.
    #[arg(long, default_value_t = 1)]
    seed: u64,

    /// Computing threads; 0 means one for each processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,

    /// How to report.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

#[derive(Serialize)]
struct Report {
    #[serde(flatten)]
    scored: Scored,
    control_steps_per_second: f64,
}

/// Carries out the command.
pub(super) fn main(args: Args) -> Done {
    let (scenario, format) = (args.source.load()?, args.format);
    answer(scenario, format, |gate| Task { args, gate }, describe)
}

struct Task {
    args: Args,
    gate: Arc<Gate>,
}

impl WorldTask for Task {
    type Output = Result<Report, Failure>;

    fn carry_out<W: World + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        let depth = experiment.scenario.evolution.maximum_depth;
        let tree = read_tree(&self.args.tree, experiment.catalogue(), depth)
            .map_err(|error| format!("--tree: {error}"))?;
        let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
        let protocol = Protocol {
            warmup: count(self.args.warmup),
            trials: count(self.args.trials),
            repeats: count(self.args.repeats),
            banks: count(self.args.banks),
            seed: self.args.seed,
        };
        let workers = Workers::new(usize::from(self.args.threads))?;
        let started = Instant::now();
        let bar = bar(self.args.repeats, true);
        bar.set_message("repeats");
        let show = |done| bar.set_position(done as u64);
        let scored = evaluate(&experiment, &tree, &protocol, &workers, &self.gate, show)?;
        bar.finish_and_clear();
        let computed = self.gate.control_steps() as f64;
        Ok(Report {
            control_steps_per_second: computed / started.elapsed().as_secs_f64(),
            scored,
        })
    }
}

fn describe(report: &Report) -> String {
    let scored = &report.scored;
    let evaluation = &scored.evaluation;
    let error = |error: Option<f64>, digits: usize| match error {
        Some(error) => format!("{error:.digits$} (standard error)"),
        None => String::from("unknown, from a single repeat"),
    };
    format!(
        "{}\n{:.1} +- {} time steps a trial, {} repeats of {} scored trials\n\
         {:.2} +- {} return of a trial, the sum of its rewards\n\
         {:.2} % of the trials delivered\n{} control steps, {:.0} a second with the training of \
         the primitive subtasks\n",
        evaluation.tree,
        evaluation.mean,
        error(evaluation.standard_error, 1),
        evaluation.repeats.len(),
        evaluation
            .repeats
            .first()
            .map_or(0, |repeat| repeat.steps.len()),
        scored.mean_return,
        error(scored.return_standard_error, 2),
        100.0 * evaluation.delivered_share,
        evaluation.control_steps,
        report.control_steps_per_second,
    )
}
