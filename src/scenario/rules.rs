//! The rules that a scenario obeys, one small function for each part of it.
//!
//! Those of the world's settings are the world's own. Rules on hierarchies need the
//! world's subtasks and are checked where the hierarchies are read (`evolution`).

use super::{EvolutionSettings, LearningSettings, PrimitiveLearning, Scenario};
use crate::rules::{Check, Problem};

/// Bounds what a hostile file can make the program compute.
const MAX_TREE_BYTES: usize = 4096;
const MAX_DESCRIPTION_BYTES: usize = 2000;

/// Every rule that `scenario` breaks.
pub(super) fn problems(scenario: &Scenario) -> Vec<Problem> {
    let mut check = Check::default();
    check.range("format", scenario.format, super::FORMAT..=super::FORMAT);
    name(&mut check, &scenario.name);
    check.range(
        "description (bytes)",
        scenario.description.len(),
        0..=MAX_DESCRIPTION_BYTES,
    );
    check.within("world", |c| scenario.world.check(c));
    let trained = scenario.world.trains_primitives();
    check.within("learning", |c| learning(c, &scenario.learning, trained));
    check.within("evolution", |c| evolution(c, &scenario.evolution));
    check.problems()
}

fn name(check: &mut Check, name: &str) {
    let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_.".contains(c);
    let holds =
        (1..=64).contains(&name.len()) && name.chars().all(letter) && !name.starts_with(['.', '-']);
    check.rule(
        holds,
        "name",
        format!("{name:?}"),
        "1 to 64 of a-z, 0-9, '-', '_' and '.', not starting with '.' or '-'",
    );
}

fn learning(check: &mut Check, learning: &LearningSettings, trained: bool) {
    let learns = trained || learning.primitive_learning != PrimitiveLearning::Frozen;
    check.rule(
        learns,
        "primitive_learning",
        "\"frozen\"",
        "\"individual\" or \"shared\": the primitive subtasks of this world are not trained beforehand",
    );
    check.range("learning_rate", learning.learning_rate, 0.0..=1.0);
    check.range("discount", learning.discount, 0.0..=1.0);
    check.range(
        "temperature_limit",
        learning.temperature_limit,
        0.001..=1000.0,
    );
    let limit = learning.temperature_limit.clamp(0.001, 1000.0);
    check.range(
        "initial_temperature",
        learning.initial_temperature,
        limit..=1000.0,
    );
    check.range(
        "temperature_decrease",
        learning.temperature_decrease,
        0.0..=1.0,
    );
    check.range("probability_limit", learning.probability_limit, 0.0..=1.0);
    check.range("epsilon", learning.epsilon, 0.0..=1.0);
    check.range("pseudo_penalty", learning.pseudo_penalty, 0.0..=1000.0);
    check.range(
        "initial_parameter",
        learning.initial_parameter,
        -1000.0..=1000.0,
    );
}

fn evolution(check: &mut Check, evolution: &EvolutionSettings) {
    let size = evolution.population_size;
    check.range("population_size", size, 4..=1024);
    let reproduced = evolution.reproduced;
    let survivors = size.saturating_sub(reproduced);
    check.range(
        "reproduced",
        reproduced,
        1..=(size / 2).saturating_sub(1).max(1),
    );
    check.rule(
        survivors.is_multiple_of(2),
        "population_size minus reproduced",
        survivors,
        "an even number, because crossover makes pairs",
    );
    check.range(
        "tournament_size",
        evolution.tournament_size,
        1..=survivors.max(1),
    );
    let trials = evolution.trials_per_generation;
    check.range("trials_per_generation", trials, 2..=1024);
    check.rule(
        trials.is_multiple_of(2),
        "trials_per_generation",
        trials,
        "an even number, because half of them is scored",
    );
    check.range("maximum_depth", evolution.maximum_depth, 2..=8);
    check.range("generation_limit", evolution.generation_limit, 1..=100_000);
    check.range("trial_step_limit", evolution.trial_step_limit, 1..=100_000);
    check.range("prune_probability", evolution.prune_probability, 0.0..=1.0);
    check.range("grow_probability", evolution.grow_probability, 0.0..=1.0);
    check.range("policy_samples", evolution.policy_samples, 1..=10_000);
    let trees = evolution.initial_population.len();
    check.rule(
        trees == size,
        "initial_population (number)",
        trees,
        format!("{size}, the population_size"),
    );
    for (i, tree) in evolution.initial_population.iter().enumerate() {
        let part = format!("initial_population[{i}] (bytes)");
        check.range(&part, tree.len(), 1..=MAX_TREE_BYTES);
    }
}
