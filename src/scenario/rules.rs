//! The rules that every scenario obeys.
//!
//! The settings of a world are checked by the world. Rules on hierarchies need the world's
//! subtasks and are checked where hierarchies are parsed, in `evolution`.

use super::{
    CompositeReward, EvolutionSettings, LearningSettings, PrimitiveLearning, Scenario, Then,
};
use crate::rules::{Check, Problem};

/// Longest hierarchy, in bytes: it bounds the work that a hostile file can cause.
const MAX_TREE_BYTES: usize = 4096;
/// Longest description, in bytes.
const MAX_DESCRIPTION_BYTES: usize = 2000;

/// Returns every rule that `scenario` breaks.
pub(super) fn problems(scenario: &Scenario) -> Vec<Problem> {
    let mut check = Check::default();
    check.range("format", scenario.format, super::FORMAT..=super::FORMAT);
    check.name("name", &scenario.name);
    let length = scenario.description.len();
    check.range("description (bytes)", length, 0..=MAX_DESCRIPTION_BYTES);
    check.within("world", |c| scenario.world.check(c));
    let trained = scenario.world.trains_primitives();
    check.within("learning", |c| learning(c, &scenario.learning, trained));
    check.within("evolution", |c| evolution(c, &scenario.evolution));
    check.problems()
}

fn learning(check: &mut Check, learning: &LearningSettings, trained: bool) {
    check.rule(
        trained || learning.primitive_learning != PrimitiveLearning::Frozen,
        "primitive_learning",
        "\"frozen\"",
        "\"individual\" or \"shared\": this world does not train its primitive subtasks before evolution",
    );
    let limit = learning.temperature_limit;
    let lowest = limit.clamp(0.001, 1000.0);
    check.ranges([
        ("learning_rate", learning.learning_rate, 0.0..=1.0),
        ("discount", learning.discount, 0.0..=1.0),
        ("temperature_limit", limit, 0.001..=1000.0),
        (
            "initial_temperature",
            learning.initial_temperature,
            lowest..=1000.0,
        ),
        (
            "temperature_decrease",
            learning.temperature_decrease,
            0.0..=1.0,
        ),
        ("probability_limit", learning.probability_limit, 0.0..=1.0),
        ("epsilon", learning.epsilon, 0.0..=1.0),
        ("pseudo_penalty", learning.pseudo_penalty, 0.0..=1000.0),
        (
            "initial_parameter",
            learning.initial_parameter,
            -1000.0..=1000.0,
        ),
    ]);
    if let Some(temperature) = learning.composite_temperature {
        check.range("composite_temperature", temperature, lowest..=1000.0);
    }
    if let CompositeReward::PerStep(reward) = learning.composite_reward {
        let holds = (-1000.0..0.0).contains(&reward);
        check.rule(
            holds,
            "composite_reward.per_step",
            reward,
            "-1000 to less than 0",
        );
    }
    check.range("persistence", learning.persistence, 1..=1000);
    check.range("replay", learning.replay, 0..=100);
}

fn evolution(check: &mut Check, evolution: &EvolutionSettings) {
    let size = evolution.population_size;
    check.range("population_size", size, 4..=1024);
    let reproduced = evolution.reproduced;
    let most = (size / 2).saturating_sub(1).max(1);
    check.range("reproduced", reproduced, 1..=most);
    let survivors = size.saturating_sub(reproduced);
    check.rule(
        survivors.is_multiple_of(2),
        "population_size minus reproduced",
        survivors,
        "an even number, because crossover makes pairs",
    );
    let tournament = evolution.tournament_size;
    check.range("tournament_size", tournament, 1..=survivors.max(1));
    let trials = evolution.trials_per_generation;
    check.range("trials_per_generation", trials, 2..=100_000);
    check.rule(
        trials.is_multiple_of(2),
        "trials_per_generation",
        trials,
        "an even number, because half of them are scored",
    );
    check.range("maximum_depth", evolution.maximum_depth, 2..=8);
    check.range("generation_limit", evolution.generation_limit, 1..=100_000);
    if let Some(limit) = evolution.control_step_limit {
        check.range("control_step_limit", limit, 1..=1_000_000_000_000_u64);
    }
    if let Some(Then::Learn(trials)) = evolution.then {
        check.range("then.learn", trials, 1..=1_000_000);
    }
    check.range("trial_step_limit", evolution.trial_step_limit, 1..=100_000);
    check.ranges([
        ("prune_probability", evolution.prune_probability, 0.0..=1.0),
        ("grow_probability", evolution.grow_probability, 0.0..=1.0),
    ]);
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
