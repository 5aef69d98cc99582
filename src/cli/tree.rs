//! `maxq-lab tree`: look at hierarchies.

use std::process::ExitCode;

use clap::{Args, Subcommand};
use serde::Serialize;
use serde_json::json;

use super::output::{self, CommandResult, Failure, Format, counted};
use crate::hierarchy::{Glyphs, Summary, Tree, draw, structural_difference, to_dot, to_text};
use crate::lab::experiment;
use crate::scenario::Scenario;
use crate::worlds::Catalogue;

/// Examples for its help.
pub(super) const EXAMPLES: &str = "\
Examples:
  maxq-lab tree show '(Root Wander (Capture Avoid ApproachBattery) ApproachNest)'
  maxq-lab tree check --scenario taxi '(Root North South East West Pickup Putdown)'
  maxq-lab tree diff '(Root Wander ApproachBattery ApproachNest)' \\
           '(Root Avoid ApproachBattery ApproachNest)'
  maxq-lab tree dot '(Root Wander ApproachBattery ApproachNest)' | dot -Tsvg > tree.svg";

/// Look at hierarchies: draw, check, compare, export.
///
/// A hierarchy is text: '(Root (Capture (FindBattery Wander) ApproachBattery) Wander
/// ApproachNest)'. Its subtasks and rules are those of the scenario.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Draw a hierarchy and count what it is made of.
    Show(One),
    /// Check a hierarchy against the typing rules.
    Check(One),
    /// Measure the structural difference of two hierarchies (Thesis 4.5.2).
    ///
    /// It is 0 where they are alike, and the further below the more differs: each composite
    /// subtask that only one of them has costs its weight, each primitive child that only one
    /// of them has at a place costs 1. Their order does not matter.
    Diff {
        /// The one hierarchy.
        a: String,
        /// The other hierarchy.
        b: String,
        #[command(flatten)]
        format: TreeFormat,
    },
    /// Write a hierarchy as Graphviz DOT.
    Dot {
        /// The hierarchy.
        tree: String,
        /// The scenario whose subtasks and rules apply.
        #[arg(long, default_value = "environment-1")]
        scenario: String,
    },
}

#[derive(Debug, Args)]
pub(super) struct One {
    /// The hierarchy.
    tree: String,
    #[command(flatten)]
    format: TreeFormat,
}

#[derive(Debug, Args)]
pub(super) struct TreeFormat {
    /// The scenario whose subtasks and rules apply.
    #[arg(long, default_value = "environment-1")]
    scenario: String,
    /// TreeFormat to report.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Carries out the command.
pub(super) fn main(command: Command) -> CommandResult {
    match command {
        Command::Show(One { tree, format }) => show(&tree, &format)?,
        Command::Check(One { tree, format }) => check(&tree, &format)?,
        Command::Diff { a, b, format } => difference(&a, &b, &format)?,
        Command::Dot { tree, scenario } => {
            let scenario = Scenario::load(&scenario)?;
            output::text(&with_tree(&scenario, &tree, to_dot)?)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn show(text: &str, format: &TreeFormat) -> Result<(), Failure> {
    let scenario = Scenario::load(&format.scenario)?;
    let (summary, drawing) = with_tree(&scenario, text, |tree, catalogue| {
        (
            Summary::of(tree, catalogue),
            draw(tree, catalogue, Glyphs::of_locale()),
        )
    })?;
    if format.format == Format::Json {
        return output::json(&summary);
    }
    let by_type = summary.primitives_by_state_type.iter().enumerate();
    let by_type: Vec<_> = by_type
        .map(|(index, names)| format!("state type {}: {}", index + 1, names.join(", ")))
        .collect();
    output::text(&format!(
        "{}\n\ndepth {}, {} composite and {}\n{}\n",
        drawing.join("\n"),
        summary.depth,
        summary.composites,
        counted(summary.primitives.len() as u64, "primitive subtask"),
        by_type.join("\n")
    ))
}

fn check(text: &str, format: &TreeFormat) -> Result<(), Failure> {
    let scenario = Scenario::load(&format.scenario)?;
    let tree = with_tree(&scenario, text, to_text)?;
    match format.format {
        Format::Json => output::json(&json!({ "valid": true, "tree": tree })),
        Format::Text => output::text(&format!("valid: {tree}\n")),
    }
}

#[derive(Serialize)]
struct Difference {
    a: String,
    b: String,
    difference: i64,
}

fn difference(a: &str, b: &str, format: &TreeFormat) -> Result<(), Failure> {
    let scenario = Scenario::load(&format.scenario)?;
    let first = with_tree(&scenario, a, |tree, _| tree.clone())?;
    let report = with_tree(&scenario, b, |second, catalogue| Difference {
        a: to_text(&first, catalogue),
        b: to_text(second, catalogue),
        difference: structural_difference(&first, second, catalogue),
    })?;
    match format.format {
        Format::Json => output::json(&report),
        Format::Text => output::text(&format!("{}\n", report.difference)),
    }
}

/// Reads a hierarchy by the rules of a scenario and does something with it.
pub(super) fn with_tree<T>(
    scenario: &Scenario,
    text: &str,
    what: impl FnOnce(&Tree, &Catalogue) -> T,
) -> Result<T, Failure> {
    let experiment = experiment(scenario.clone(), 0)?;
    let tree = experiment.read_tree(text);
    let tree = tree.map_err(|error| format!("{text:?}: {error}"))?;
    Ok(what(&tree, experiment.catalogue()))
}
