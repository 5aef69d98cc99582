//! `maxq-lab tree`: draws, checks, compares and exports hierarchies.

use std::borrow::Borrow;
use std::process::ExitCode;

use clap::{Args, Subcommand};
use serde::Serialize;
use serde_json::json;

use super::names;
use super::output::{self, CommandResult, Failure, Format, counted};
use crate::hierarchy::{Glyphs, Summary, Tree, draw, structural_difference, to_dot, to_text};
use crate::lab::experiment;
use crate::scenario::Scenario;
use crate::words::quoted;
use crate::worlds::Catalogue;

/// The examples in the help of `maxq-lab tree`.
pub(super) const EXAMPLES: &str = "\
Examples:
  maxq-lab tree show '(Root Wander (Capture Avoid ApproachBattery) ApproachNest)'
  maxq-lab tree check --scenario taxi '(Root North South East West Pickup Putdown)'
  maxq-lab tree diff '(Root Wander ApproachBattery ApproachNest)' \\
           '(Root Avoid ApproachBattery ApproachNest)'
  maxq-lab tree dot '(Root Wander ApproachBattery ApproachNest)' | dot -Tsvg > tree.svg";

/// Draw, check, compare or export hierarchies.
///
/// A hierarchy is written as text: '(Root (Capture (FindBattery Wander) ApproachBattery) Wander
/// ApproachNest)'. The scenario defines its subtasks and typing rules.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Draw a hierarchy and count its subtasks.
    Show(TreeArgs),
    /// Check a hierarchy against the typing rules.
    Check(TreeArgs),
    /// Measure the structural difference between two hierarchies (Thesis 4.5.2).
    ///
    /// The difference is 0 for equal hierarchies and negative otherwise. Each composite subtask
    /// that only one of them has costs its weight, and each primitive child that only one of
    /// them has at a place costs 1. The order of children does not matter.
    Diff {
        /// First hierarchy.
        a: String,
        /// Second hierarchy.
        b: String,
        #[command(flatten)]
        options: TreeFormat,
    },
    /// Print a hierarchy in Graphviz DOT format.
    Dot {
        /// Hierarchy, as text.
        tree: String,
        /// Scenario that defines the subtasks and typing rules.
        #[arg(long, default_value = "environment-1", value_parser = names::scenarios(), hide_possible_values = true)]
        scenario: String,
    },
}

#[derive(Debug, Args)]
pub(super) struct TreeArgs {
    /// Hierarchy, as text.
    tree: String,
    #[command(flatten)]
    options: TreeFormat,
}

#[derive(Debug, Args)]
pub(super) struct TreeFormat {
    /// Scenario that defines the subtasks and typing rules.
    #[arg(long, default_value = "environment-1", value_parser = names::scenarios(), hide_possible_values = true)]
    scenario: String,
    /// Output format.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Runs `maxq-lab tree`.
pub(super) fn main(command: Command) -> CommandResult {
    match command {
        Command::Show(TreeArgs { tree, options }) => show(&tree, &options)?,
        Command::Check(TreeArgs { tree, options }) => check(&tree, &options)?,
        Command::Diff { a, b, options } => difference(&a, &b, &options)?,
        Command::Dot { tree, scenario } => {
            let scenario = Scenario::load(&scenario)?;
            output::text(&with_tree(&scenario, &tree, to_dot)?)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn show(text: &str, options: &TreeFormat) -> Result<(), Failure> {
    let scenario = Scenario::load(&options.scenario)?;
    let (summary, drawing) = with_tree(&scenario, text, |tree, catalogue| {
        (
            Summary::of(tree, catalogue),
            draw(tree, catalogue, Glyphs::of_locale()),
        )
    })?;
    options.format.print(&summary, |summary| {
        format!(
            "{}\n\ndepth {}, {} composite and {}\n{}",
            drawing.join("\n"),
            summary.depth,
            summary.composites,
            counted(summary.primitives.len() as u64, "primitive subtask"),
            by_state_type(&summary.primitives_by_state_type)
        )
    })
}

/// The primitive subtasks of every state type, a line each.
pub(super) fn by_state_type<N: Borrow<str>>(primitives: &[Vec<N>]) -> String {
    let lines = primitives.iter().enumerate();
    let lines = lines.map(|(i, names)| format!("state type {}: {}\n", i + 1, names.join(", ")));
    lines.collect()
}

fn check(text: &str, options: &TreeFormat) -> Result<(), Failure> {
    let scenario = Scenario::load(&options.scenario)?;
    let tree = with_tree(&scenario, text, to_text)?;
    let report = json!({ "valid": true, "tree": tree });
    let text = |_: &_| format!("valid: {tree}\n");
    options.format.print(&report, text)
}

#[derive(Serialize)]
struct Difference {
    a: String,
    b: String,
    difference: i64,
}

fn difference(a: &str, b: &str, options: &TreeFormat) -> Result<(), Failure> {
    let scenario = Scenario::load(&options.scenario)?;
    let first = with_tree(&scenario, a, |tree, _| tree.clone())?;
    let report = with_tree(&scenario, b, |second, catalogue| Difference {
        a: to_text(&first, catalogue),
        b: to_text(second, catalogue),
        difference: structural_difference(&first, second, catalogue),
    })?;
    let text = |report: &Difference| format!("{}\n", report.difference);
    options.format.print(&report, text)
}

/// Reads a hierarchy by the rules of `scenario` and passes it to `what`, with the subtasks.
pub(super) fn with_tree<T>(
    scenario: &Scenario,
    text: &str,
    what: impl FnOnce(&Tree, &Catalogue) -> T,
) -> Result<T, Failure> {
    let experiment = experiment(scenario.clone(), 0)?;
    let tree = experiment.read_tree(text);
    let tree = tree.map_err(|error| format!("{}: {error}", quoted(text)))?;
    Ok(what(&tree, experiment.catalogue()))
}
