//! Contract: evolution is Thesis Algorithm 3.1 with the operators of `src/evolution/README.md`.
//!
//! Selection works on a noisy fitness, so even a wrong evolution "finds" something. Only its
//! parts can be tested. Crossover: valid trees, no lost subtrees, learned values in the right
//! places, unbiased sites. Breeding: which individuals are reproduced, die and become parents.
//! A generation: which trials run, which are scored, what is recorded, and when evolution ends.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "evolution/breeding.rs"]
mod breeding;
#[path = "evolution/crossover.rs"]
mod crossover;
#[path = "evolution/generation.rs"]
mod generation;
#[path = "evolution/mutation.rs"]
mod mutation;
#[path = "evolution/policy.rs"]
mod policy;
mod trees;

use maxq_lab::evolution::{
    Evolution, EvolutionState, Experiment, GenerationRecord, Individual, Origin, Workers,
};
use maxq_lab::hierarchy::{Tree, parse};
use maxq_lab::learning::{CompositeValues, Gate, Hierarchy, PrimitiveSet, PrimitiveValues};
use maxq_lab::scenario::{LearningSettings, Scenario};
use maxq_lab::worlds::WorldSettings;
use maxq_lab::worlds::foraging::ForagingWorld;
use maxq_lab::worlds::{Catalogue, World};
use rand::RngExt;
use rand::rngs::SmallRng;

/// The smoke scenario with short trials and without learning: after a generation individuals
/// have the values that they inherited.
fn still_scenario() -> Scenario {
    let mut scenario = Scenario::load("smoke").unwrap();
    scenario.learning.learning_rate = 0.0;
    scenario.learning.temperature_decrease = 1.0;
    scenario.evolution.trial_step_limit = 2;
    scenario.evolution.trials_per_generation = 2;
    scenario.evolution.policy_samples = 1;
    scenario
}

fn foraging(scenario: &Scenario) -> ForagingWorld {
    let WorldSettings::Foraging(model) = &scenario.world else {
        panic!("a foraging scenario")
    };
    ForagingWorld::new(model).unwrap()
}

fn experiment(scenario: Scenario) -> Experiment<ForagingWorld> {
    let world = foraging(&scenario);
    Experiment::new(scenario, world).unwrap()
}

/// A primitive set that has learned nothing.
fn untrained(catalogue: &Catalogue) -> PrimitiveSet {
    let primitives = catalogue.primitives();
    let primitives = primitives.map(|primitive| PrimitiveValues::new(primitive, catalogue, 0.0));
    PrimitiveSet::new(primitives.collect(), catalogue).unwrap()
}

/// An individual with random learned values, no two of them equal.
fn learned(id: u64, tree: Tree, catalogue: &Catalogue, rng: &mut SmallRng) -> Individual {
    let (tree, mut values) =
        Hierarchy::new(tree, catalogue, &LearningSettings::default()).into_parts();
    for (node, value) in values.iter_mut().enumerate() {
        let Some(value) = value else { continue };
        let mut vectors = value.vectors();
        for parameter in vectors.iter_mut().flatten().flatten() {
            *parameter = -rng.random::<f32>();
        }
        let temperature = rng.random_range(0.1..1.9);
        let subtask = tree.subtask(node);
        let children: Vec<_> = tree.children(node).map(|c| tree.subtask(c)).collect();
        let random =
            CompositeValues::from_vectors(subtask, &children, catalogue, temperature, &vectors);
        *value = random.unwrap();
    }
    Individual {
        id,
        origin: Origin::HandCoded,
        hierarchy: Hierarchy::from_parts(tree, values).unwrap(),
        primitives: None,
    }
}

/// The state of an evolution after generation `generation`, with these ranked individuals; 0
/// means that they have not run yet.
fn state(individuals: Vec<Individual>, catalogue: &Catalogue, generation: u64) -> EvolutionState {
    EvolutionState {
        generation,
        next_id: individuals
            .iter()
            .map(|individual| individual.id)
            .max()
            .unwrap_or(0)
            + 1,
        individuals,
        primitives: untrained(catalogue),
        control_steps: 1000,
        converged: false,
    }
}

/// Individuals with these trees and random learned values, with ids from 100.
fn individuals<'t>(
    trees: impl IntoIterator<Item = &'t str>,
    catalogue: &Catalogue,
    rng: &mut SmallRng,
) -> Vec<Individual> {
    let trees = (100..).zip(trees);
    trees
        .map(|(id, text)| learned(id, parse(text, catalogue).unwrap(), catalogue, rng))
        .collect()
}

/// Runs one generation from a state: its record, and the state after it.
fn step<W: World>(
    experiment: &Experiment<W>,
    seed: u64,
    state: EvolutionState,
) -> (GenerationRecord, EvolutionState) {
    let workers = Workers::new(1).unwrap();
    let gate = Gate::default();
    let evolution = Evolution::resume(experiment, &workers, seed, state, &gate);
    let mut evolution = evolution.unwrap();
    let record = evolution.step(&gate, |_| ()).unwrap();
    let after = evolution.state().as_ref().clone();
    (record, after)
}

/// Asserts that counts fit draws with these probabilities: each is within five standard
/// deviations.
fn assert_frequencies(counts: &[u32], probabilities: &[f64]) {
    let all = f64::from(counts.iter().sum::<u32>());
    assert!((probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    for (count, p) in counts.iter().zip(probabilities) {
        let allowed = 5.0 * (all * p * (1.0 - p)).sqrt() + 1e-9;
        let off = (f64::from(*count) - all * p).abs();
        assert!(off <= allowed, "{counts:?} for {probabilities:?}");
    }
}
