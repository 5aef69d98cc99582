//! `maxq-lab primitives`: trains the primitive subtasks and prints their action values.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::Serialize;

use super::answer::{AnswerArgs, Resources};
use super::args::ScenarioArgs;
use super::output::{CommandResult, Failure};
use crate::worlds::Kind;

/// Train the primitive subtasks and print their action values.
///
/// Prints the greedy action and the value of every action for typical inputs (Thesis Figure
/// 4.3). Actions are numbered as in Thesis Table 4.4. A command has only one action, and
/// Recall acts as others do: they learn nothing.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab primitives environment-1
  maxq-lab primitives environment-1 --set world.foraging.features.rbf_width=variance
  maxq-lab primitives environment-3 --seed 7 --format json | jq .primitives[0]")]
pub(super) struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,

    #[command(flatten)]
    answer: AnswerArgs,
}

/// The trained primitive subtasks.
#[derive(Serialize)]
pub(super) struct Report {
    scenario: String,
    seed: u64,
    primitives: Vec<Primitive>,
}

#[derive(Serialize)]
struct Primitive {
    subtask: String,
    actions: Vec<String>,
    rows: Vec<Row>,
    /// Why it has learned nothing of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    nothing_learned: Option<String>,
}

/// The values of one input.
#[derive(Serialize)]
struct Row {
    #[serde(skip)]
    label: String,
    input: BTreeMap<String, f64>,
    /// Numbered from 1.
    greedy_action: usize,
    q: Vec<f32>,
}

/// Runs `maxq-lab primitives`.
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
        if !experiment.scenario().world.trains_primitives() {
            let name = &experiment.scenario().name;
            return Err(format!(
                "{name}: found primitive subtasks that are not trained in advance (each individual \
                 learns its own); allowed: a world that trains them, such as foraging"
            )
            .into());
        }
        let primitives = experiment.train(0, workers, gate)?;
        let catalogue = experiment.catalogue();
        let primitives = primitives.all().iter().map(|primitive| {
            let nothing_learned = experiment.nothing_learned(primitive.subtask);
            let probes = match nothing_learned {
                Some(_) => Vec::new(),
                None => experiment.probes(primitive.subtask),
            };
            let rows = probes.into_iter().map(|probe| {
                let q = primitive.action_values(experiment.encoder(), &probe.percept);
                Row {
                    label: probe.label,
                    input: probe.readings.into_iter().collect(),
                    greedy_action: greedy(&q) + 1,
                    q,
                }
            });
            let subtask = catalogue.subtask(primitive.subtask);
            Primitive {
                subtask: subtask.name.clone(),
                actions: match &subtask.kind {
                    Kind::Primitive { actions, .. } => actions.clone(),
                    Kind::Composite { .. } => Vec::new(),
                },
                rows: rows.collect(),
                nothing_learned,
            }
        });
        Ok(Report {
            scenario: experiment.scenario().name.clone(),
            seed: self.answer.seed,
            primitives: primitives.collect(),
        })
    }
}

fn describe(report: &Report) -> String {
    let mut text = format!("{}, seed {}\n", report.scenario, report.seed);
    for primitive in &report.primitives {
        // Writing to a string cannot fail.
        if let Some(why) = &primitive.nothing_learned {
            let _ = writeln!(text, "\n{} {why}", primitive.subtask);
            continue;
        }
        let _ = writeln!(text, "\n{}", primitive.subtask);
        let labels = primitive.rows.iter().map(|row| row.label.len());
        let width = labels.max().unwrap_or(0);
        let columns = primitive.actions.iter().enumerate();
        let header = columns.map(|(i, action)| format!("{:>14}", format!("{} {action}", i + 1)));
        let header: String = header.collect();
        let _ = writeln!(text, "  {:width$}  greedy{header}", "");
        for row in &primitive.rows {
            let values: String = row.q.iter().map(|q| format!("{q:>14.3}")).collect();
            let (label, greedy) = (&row.label, row.greedy_action);
            let _ = writeln!(text, "  {label:width$}  {greedy:>6}{values}");
        }
    }
    text
}

/// The index of the first largest value.
fn greedy(values: &[f32]) -> usize {
    let mut best = 0;
    for (index, value) in values.iter().enumerate() {
        if *value > values[best] {
            best = index;
        }
    }
    best
}
