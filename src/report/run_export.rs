//! Exports a run as tables and text.

use serde::Serialize;

use super::figures::RunSource;
use super::table::{Table, short};
use crate::evolution::{GenerationRecord, Origin};
use crate::hierarchy::to_dot;
use crate::lab::{SetupError, experiment};
use crate::scenario::Scenario;

/// Returns a table with one row for each individual of each generation.
#[must_use]
pub fn individuals(run: &RunSource) -> Table {
    let mut table = Table::new(&[
        "scenario",
        "seed",
        "generation",
        "rank",
        "id",
        "origin",
        "mutations",
        "fitness_steps",
        "mean_trial_steps",
        "delivered_trials",
        "scored_trials",
        "composites",
        "primitives",
        "structural_difference_to_best",
        "tree",
    ]);
    table.provenance = run.provenance("--format csv");
    for record in &run.records {
        for individual in &record.individuals {
            table.rows.push(vec![
                run.scenario.name.clone(),
                run.seed.to_string(),
                record.generation.to_string(),
                individual.rank.to_string(),
                individual.id.to_string(),
                origin(&individual.origin).to_owned(),
                mutations(&individual.origin),
                individual.fitness_steps.to_string(),
                individual.mean_steps().to_string(),
                individual.delivered().to_string(),
                individual.scored().to_string(),
                individual.composites.to_string(),
                individual.primitives.len().to_string(),
                individual.difference_to_best.to_string(),
                individual.tree.clone(),
            ]);
        }
    }
    table
}

fn origin(origin: &Origin) -> &'static str {
    match origin {
        Origin::HandCoded => "hand_coded",
        Origin::Random => "random",
        Origin::Reproduced => "reproduced",
        Origin::Crossover { .. } => "crossover",
        Origin::Copied { .. } => "copied",
    }
}

fn mutations(origin: &Origin) -> String {
    let words: Vec<_> = origin.mutations().iter().map(ToString::to_string).collect();
    words.join("; ")
}

/// Returns the generations of the run and its provenance as JSON.
///
/// # Errors
/// When serialisation fails.
pub fn json(run: &RunSource) -> Result<String, serde_json::Error> {
    #[derive(Serialize)]
    struct Whole<'r> {
        made_by: String,
        scenario: &'r crate::scenario::Scenario,
        seed: u64,
        generations: &'r [GenerationRecord],
    }
    let whole = Whole {
        made_by: run.provenance("--format json"),
        scenario: &run.scenario,
        seed: run.seed,
        generations: &run.records,
    };
    Ok(serde_json::to_string_pretty(&whole)? + "\n")
}

/// Returns a summary of the run as Markdown.
#[must_use]
pub fn markdown(run: &RunSource) -> String {
    let mut table = Table::new(&[
        "generation",
        "best (time steps a trial)",
        "middle (time steps a trial)",
        "structural difference",
        "best hierarchy",
    ]);
    for record in &run.records {
        let steps = |rank| {
            record
                .mean_trial_steps(rank)
                .map_or_else(String::new, short)
        };
        let best = record.individuals.first();
        table.rows.push(vec![
            record.generation.to_string(),
            steps(1),
            steps((record.individuals.len() / 2).max(1)),
            short(record.mean_difference),
            best.map_or_else(String::new, |best| format!("`{}`", best.tree)),
        ]);
    }
    let heading = format!("# {}, seed {}\n\n", run.scenario.name, run.seed);
    let provenance = run.provenance("--format markdown");
    format!("{heading}{provenance}.\n\n{}\n", table.markdown())
}

/// Returns the best hierarchy of the last generation as DOT, for Graphviz.
///
/// # Errors
/// When the experiment of the scenario cannot be built.
pub fn dot(run: &RunSource) -> Result<String, SetupError> {
    let best = run
        .records
        .last()
        .and_then(|record| record.individuals.first());
    let tree = best.map(|best| best.tree.clone()).unwrap_or_default();
    let dot = tree_dot(&run.scenario, &tree)?;
    Ok(format!("// {}\n{dot}", run.provenance("--format dot")))
}

/// Returns a hierarchy as DOT; nothing if the text is not a hierarchy.
///
/// # Errors
/// When the experiment of the scenario cannot be built.
pub(super) fn tree_dot(scenario: &Scenario, tree: &str) -> Result<String, SetupError> {
    let experiment = experiment(scenario.clone(), 0)?;
    let tree = experiment.read_tree(tree);
    Ok(tree.map_or_else(
        |_| String::new(),
        |tree| to_dot(&tree, experiment.catalogue()),
    ))
}
