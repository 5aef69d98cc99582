//! `maxq-lab evaluate`: how good is a structure?

use std::time::Instant;

use serde::Serialize;

use super::answer::{AnswerArgs, Means};
use super::args::ScenarioArgs;
use super::output::{CommandResult, Failure, counted};
use super::progress::repeats;
use crate::lab::{Protocol, Scored, departures, in_words, with_changes};

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
    scenario: ScenarioArgs,

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

    /// Separately trained sets of primitive subtasks; no more than there are repeats are used.
    #[arg(long, value_name = "B", default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    banks: u64,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// How good a structure is, and how that was found.
#[derive(Serialize)]
pub(super) struct Report {
    scenario: String,
    /// Settings in which it departs from the embedded one of its name.
    changed: Option<String>,
    seed: u64,
    warmup: usize,
    trials: usize,
    banks: usize,
    #[serde(flatten)]
    scored: Scored,
    control_steps_per_second: f64,
}

/// Carries out the command.
pub(super) fn main(args: Args) -> CommandResult {
    let scenario = args.scenario.load()?;
    args.answer
        .answer(scenario, |means| args.compute(&means), describe)
}

impl Args {
    fn compute(&self, means: &Means<'_>) -> Result<Report, Failure> {
        let Means {
            experiment,
            workers,
            gate,
        } = *means;
        let tree = experiment
            .read_tree(&self.tree)
            .map_err(|error| format!("--tree: {error}"))?;
        let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
        let protocol = Protocol {
            warmup: count(self.warmup),
            trials: count(self.trials),
            repeats: count(self.repeats),
            // A set that no repeat uses would be trained for nothing.
            banks: count(self.banks.min(self.repeats)),
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
            changed: in_words(&departures(scenario)),
            seed: self.answer.seed,
            warmup: protocol.warmup,
            trials: protocol.trials,
            banks: protocol.banks,
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
    let unknown = match evaluation.standard_error {
        Some(_) => "",
        None => "; a single repeat has no standard error",
    };
    format!(
        "{}\n{}, seed {}: {} of {}, {} before them, {} of primitive subtasks{unknown}\n\
         {:.1}{} time steps a trial\n\
         {:.2}{} return of a trial, the sum of its rewards\n\
         {:.2} % of the trials delivered\n\
         {} control steps, {:.0} a second with the training of the primitive subtasks\n",
        evaluation.tree,
        with_changes(&report.scenario, report.changed.as_deref()),
        report.seed,
        counted(evaluation.repeats.len() as u64, "repeat"),
        counted(report.trials as u64, "scored trial"),
        report.warmup,
        counted(report.banks as u64, "set"),
        evaluation.mean,
        error(evaluation.standard_error, 1),
        scored.mean_return,
        error(scored.return_standard_error, 2),
        100.0 * evaluation.delivered_share,
        evaluation.control_steps,
        report.control_steps_per_second,
    )
}
