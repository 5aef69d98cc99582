//! `maxq-lab evaluate`: measures the structure of a hierarchy.

use std::time::Instant;

use serde::Serialize;

use super::answer::{AnswerArgs, Resources};
use super::args::ScenarioArgs;
use super::curve::{self, CurveForm};
use super::evaluation::{Report, describe};
use super::output::{CommandResult, Failure};
use super::progress::repeats;
use crate::lab::{AnyExperiment, Protocol, experiment, overrides, summarise};

/// Evaluate the structure of a hierarchy.
///
/// Each repeat creates a new hierarchy with this structure. The hierarchy learns during the
/// warm-up trials and continues to learn while it is scored. Repeats are distributed over
/// separately trained primitive sets (sets of primitive subtasks); the standard error includes
/// the differences between these sets.
///
/// With --curve the answer is a learning curve: the trial length against the trials lived, from
/// the first warm-up trial to the last scored one. Several trees, and settings to compare with,
/// give several lines; all use the same seeds. Without --curve they are evaluated one after the
/// other, and JSON is a list.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab evaluate environment-3 --tree '(Root Avoid Wander ApproachBattery ApproachNest)'
  maxq-lab evaluate environment-4 --tree '(Root Wander Recall ApproachBattery ApproachNest \
Forward Left Right SpinLeft Back)' --warmup 4000 --repeats 8 --curve --against learning.replay=0")]
pub(super) struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,

    /// Hierarchy, as text: '(Root Wander ApproachBattery ApproachNest)'; may be repeated.
    #[arg(long = "tree", value_name = "TREE", required = true)]
    trees: Vec<String>,

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

    /// Show the learning curve: as text, or as the content of a CSV or SVG file.
    #[arg(long, value_name = "FORM", value_enum, num_args = 0..=1, require_equals = true, default_missing_value = "text")]
    curve: Option<CurveForm>,

    /// Evaluate with this setting changed too, for comparison; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    against: Vec<String>,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// One evaluation, or several.
#[derive(Serialize)]
#[serde(untagged)]
enum Reports {
    One(Box<Report>),
    Several(Vec<Report>),
}

impl Reports {
    fn all(&self) -> &[Report] {
        match self {
            Self::One(report) => std::slice::from_ref(report),
            Self::Several(reports) => reports,
        }
    }
}

/// Runs `maxq-lab evaluate`.
pub(super) fn main(args: Args) -> CommandResult {
    let scenario = args.scenario.load()?;
    let form = args.curve;
    let describe = |reports: &Reports| match form {
        Some(form) => curve::drawn(reports.all(), form),
        None => reports
            .all()
            .iter()
            .map(describe)
            .collect::<Vec<_>>()
            .join("\n"),
    };
    args.answer
        .answer(scenario, |resources| args.compute(&resources), describe)
}

impl Args {
    fn compute(&self, resources: &Resources<'_>) -> Result<Reports, Failure> {
        let base = resources.experiment;
        let mut reports = Vec::new();
        let mut add = |experiment: &dyn AnyExperiment, against: Option<&String>| {
            for tree in &self.trees {
                let report = self.report(resources, experiment, tree, against.cloned())?;
                reports.push(report);
            }
            Ok::<_, Failure>(())
        };
        add(base, None)?;
        for setting in &self.against {
            let changed = base.scenario().clone();
            let changed = changed.with_settings(std::slice::from_ref(setting));
            let changed =
                changed.map_err(|error| error.to_string().replace("--set", "--against"))?;
            add(&*experiment(changed, self.answer.seed)?, Some(setting))?;
        }
        Ok(match reports.len() {
            1 => Reports::One(Box::new(reports.remove(0))),
            _ => Reports::Several(reports),
        })
    }

    fn report(
        &self,
        resources: &Resources<'_>,
        experiment: &dyn AnyExperiment,
        tree: &str,
        against: Option<String>,
    ) -> Result<Report, Failure> {
        let tree = experiment
            .read_tree(tree)
            .map_err(|error| format!("--tree: {error}"))?;
        let count = |number: u64| usize::try_from(number).unwrap_or(usize::MAX);
        let protocol = Protocol {
            warmup: count(self.warmup),
            trials: count(self.trials),
            repeats: count(self.repeats),
            // A set that no repeat uses is not trained.
            primitive_sets: count(self.primitive_sets),
        };
        let (workers, gate) = (resources.workers, resources.gate);
        let (started, before) = (Instant::now(), gate.control_steps());
        let bar = repeats(self.repeats);
        let show = |done| bar.set_position(done as u64);
        let mut scored = experiment.evaluate(&tree, &protocol, workers, gate, &show)?;
        bar.finish_and_clear();
        let computed = (gate.control_steps() - before) as f64;
        let scenario = experiment.scenario();
        let curve = std::mem::take(&mut scored.curve);
        Ok(Report {
            scenario: scenario.name.clone(),
            changed: summarise(&overrides(scenario)),
            seed: self.answer.seed,
            warmup: protocol.warmup,
            trials: protocol.trials,
            primitive_sets: protocol.primitive_sets.min(protocol.repeats),
            control_steps_per_second: computed / started.elapsed().as_secs_f64(),
            scored,
            against,
            curve: if self.curve.is_some() {
                curve
            } else {
                Vec::new()
            },
        })
    }
}
