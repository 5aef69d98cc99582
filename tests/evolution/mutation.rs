//! Pruning and growth: one subtree more or less, and learned values in the right places.

use std::collections::BTreeSet;

use maxq_lab::evolution::{Individual, Mutation, Origin, crossover, mutated};
use maxq_lab::hierarchy::parse;
use maxq_lab::learning::CompositeValues;
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::{LearningSettings, Reset, Scenario};
use maxq_lab::worlds::{Catalogue, World};
use proptest::prelude::*;
use rand::Rng;

use super::crossover::{WORLD, assert_only_new, nested, parent_of, path, values};
use super::trees::{Nested, chance, is_composite, valid_tree};
use super::{assert_frequencies, experiment, individuals, learned, state, step, still_scenario};

/// Environment 1 with these probabilities of mutation.
fn scenario(prune: f64, grow: f64) -> Scenario {
    let mut scenario = Scenario::load("environment-1").unwrap();
    scenario.evolution.prune_probability = prune;
    scenario.evolution.grow_probability = grow;
    scenario
}

/// The tree without the node at a place in preorder.
fn without(tree: &Nested, place: usize) -> Nested {
    fn walk(node: &mut Nested, place: usize, at: &mut usize) {
        node.children.retain_mut(|child| {
            *at += 1;
            let keep = *at != place;
            if keep {
                walk(child, place, at);
            } else {
                *at += child.nodes().len() - 1;
            }
            keep
        });
    }
    let mut left = tree.clone();
    walk(&mut left, place, &mut 0);
    left
}

/// The trees that pruning can give, one for each node without which the tree is valid.
fn prunings(tree: &Nested) -> Vec<Nested> {
    let places = 1..tree.nodes().len();
    let all = places.map(|place| without(tree, place));
    all.filter(Nested::obeys_the_rules).collect()
}

fn copied(individual: Individual) -> Individual {
    Individual {
        origin: Origin::Copied {
            from: individual.id,
            mutations: Vec::new(),
        },
        ..individual
    }
}

/// An individual with a random tree.
fn any_individual(seed: u64, catalogue: &Catalogue) -> Individual {
    let mut rng = chance(seed);
    let tree = valid_tree(&mut rng).tree(catalogue);
    copied(learned(7, tree, catalogue, &mut rng))
}

fn fresh(subtask: &str, children: &[Nested], catalogue: &Catalogue) -> CompositeValues {
    let id = |name: &str| catalogue.find(name).unwrap();
    let children: Vec<_> = children.iter().map(|child| id(child.name)).collect();
    CompositeValues::new(
        id(subtask),
        &children,
        catalogue,
        &LearningSettings::default(),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn pruning_takes_one_subtree_and_nothing_else(seed in any::<u64>()) {
        let catalogue = WORLD.catalogue();
        let old = any_individual(seed, catalogue);
        let before = nested(&old, catalogue);
        let mut draws = stream(seed, 0, 0, Purpose::Breeding);
        let new = mutated(old.clone(), &scenario(1.0, 0.0), catalogue, &mut draws);
        let after = nested(&new, catalogue);
        let possible = prunings(&before);
        let [Mutation::Pruned { parent, subtree }] = new.origin.mutations() else {
            // 200 draws found nothing, so there is little to find.
            prop_assert!(possible.len() * 10 < before.nodes().len(), "{}", before.text());
            prop_assert_eq!(new, old);
            return Ok(());
        };
        prop_assert!(possible.contains(&after), "{} of {}", after.text(), before.text());
        prop_assert!(before.nodes().iter().any(|node| node.text() == *subtree));
        let (kept, known) = (values(&new, catalogue), values(&old, catalogue));
        for (name, value) in kept {
            if name == parent {
                let gone: Vec<_> = known[name].vectors();
                let left = value.vectors();
                prop_assert_eq!(left.len() + 1, gone.len());
                prop_assert_eq!(value.temperature, known[name].temperature);
                let place = (0..gone.len()).find(|&i| left.get(i) != Some(&gone[i])).unwrap();
                let rest: Vec<_> = [&gone[..place], &gone[place + 1..]].concat();
                prop_assert_eq!(left, rest, "all but one are unchanged");
            } else {
                prop_assert_eq!(value, known[name]);
            }
        }
    }

    #[test]
    fn growth_adds_one_subtree_and_resets_the_path_to_it_or_the_child(
        seed in any::<u64>(),
        only_child in any::<bool>(),
    ) {
        let catalogue = WORLD.catalogue();
        let old = any_individual(seed, catalogue);
        let before = nested(&old, catalogue);
        let mut draws = stream(seed, 0, 0, Purpose::Breeding);
        let mut settings = scenario(0.0, 1.0);
        if only_child {
            settings.evolution.reset = Reset::Child;
        }
        let new = mutated(old.clone(), &settings, catalogue, &mut draws);
        let after = nested(&new, catalogue);
        prop_assert!(after.obeys_the_rules(), "{}", after.text());
        let [Mutation::Grown { parent, subtree }] = new.origin.mutations() else {
            prop_assert_eq!(new, old);
            return Ok(());
        };
        let nodes = after.nodes();
        let mut places = 1..nodes.len();
        let place = places.find(|&place| {
            nodes[place].text() == *subtree && without(&after, place) == before
        });
        let place = place.expect("what has grown is there, and nothing else has changed");
        let on_path = path(&after, place);
        prop_assert!(on_path.contains(parent.as_str()));
        let above = nodes.iter().find(|node| node.name == parent).unwrap();
        let grown = nodes[place].name;
        prop_assert_eq!(above.children.iter().filter(|child| child.name == grown).count(), 1);
        let (kept, known) = (values(&new, catalogue), values(&old, catalogue));
        let (_, place) = parent_of(&after, place);
        for node in nodes.iter().filter(|node| is_composite(node.name)) {
            let inherits = only_child || !on_path.contains(node.name);
            match known.get(node.name).filter(|_| inherits) {
                Some(value) if only_child && node.name == parent => {
                    let new = fresh(node.name, &node.children, catalogue);
                    assert_only_new(kept[node.name], value, &new, place)?;
                }
                Some(value) => prop_assert_eq!(kept[node.name], *value),
                None => {
                    let new = fresh(node.name, &node.children, catalogue);
                    prop_assert_eq!(kept[node.name], &new);
                }
            }
        }
    }

    /// The origin of an offspring stays true when it is mutated.
    #[test]
    fn the_origin_says_of_every_composite_subtask_whether_it_was_inherited(seed in any::<u64>()) {
        let catalogue = WORLD.catalogue();
        let (a, b) = (any_individual(seed, catalogue), any_individual(seed ^ 1, catalogue));
        let mut draws = stream(seed, 0, 0, Purpose::Breeding);
        let settings = scenario(0.7, 0.7);
        let Some([child, _]) = crossover(&a, &b, [20, 21], &settings, catalogue, &mut draws) else {
            return Ok(());
        };
        let crossed = values(&child, catalogue).into_iter().map(|(n, v)| (n.to_owned(), v.clone()));
        let crossed: std::collections::BTreeMap<_, _> = crossed.collect();
        let mutant = mutated(child, &settings, catalogue, &mut draws);
        let Origin::Crossover { inherited, reset, mutations, .. } = &mutant.origin else {
            panic!("{:?}", mutant.origin);
        };
        let told = inherited.iter().map(|part| &part.subtask).chain(reset);
        let composites: BTreeSet<_> = values(&mutant, catalogue).into_keys().collect();
        let told: Vec<_> = told.map(String::as_str).collect();
        prop_assert_eq!(told.len(), composites.len(), "each is listed once");
        prop_assert_eq!(told.into_iter().collect::<BTreeSet<_>>(), composites);
        let pruned = |name: &str| mutations.iter().any(|mutation| {
            matches!(mutation, Mutation::Pruned { parent, .. } if parent == name)
        });
        for part in inherited.iter().filter(|part| !pruned(&part.subtask)) {
            let value = values(&mutant, catalogue)[part.subtask.as_str()].clone();
            prop_assert_eq!(&value, &crossed[part.subtask.as_str()]);
        }
    }
}

#[test]
fn every_node_that_can_be_pruned_is_equally_likely() {
    let catalogue = WORLD.catalogue();
    let text =
        "(Root Avoid Wander (Capture (FindBattery Avoid Wander) ApproachBattery) ApproachNest)";
    let tree = parse(text, catalogue).unwrap();
    let old = copied(learned(1, tree, catalogue, &mut chance(1)));
    let possible = prunings(&nested(&old, catalogue));
    assert_eq!(possible.len(), 8, "{possible:?}");
    let mut counts = vec![0; possible.len()];
    let mut draws = stream(1, 0, 0, Purpose::Breeding);
    for _ in 0..8000 {
        let new = mutated(old.clone(), &scenario(1.0, 0.0), catalogue, &mut draws);
        let found = nested(&new, catalogue);
        counts[possible.iter().position(|tree| *tree == found).unwrap()] += 1;
    }
    assert_frequencies(&counts, &[1.0 / 8.0; 8]);
}

/// Even where a composite child needs many draws until its subtree is valid.
#[test]
fn every_child_that_can_grow_is_equally_likely() {
    let catalogue = WORLD.catalogue();
    let tree = parse(
        "(Root Avoid Wander ApproachBattery ApproachNest)",
        catalogue,
    )
    .unwrap();
    let old = copied(learned(1, tree, catalogue, &mut chance(1)));
    let possible = [
        "Capture",
        "Deliver",
        "FindBattery",
        "VisibleBattery",
        "FindNest",
        "VisibleNest",
        "Turn",
    ];
    let mut counts = [0; 7];
    let mut draws = stream(1, 0, 0, Purpose::Breeding);
    for _ in 0..20_000 {
        let new = mutated(old.clone(), &scenario(0.0, 1.0), catalogue, &mut draws);
        let grown = nested(&new, catalogue).children.pop().unwrap().name;
        counts[possible.iter().position(|name| *name == grown).unwrap()] += 1;
    }
    assert_frequencies(&counts, &[1.0 / 7.0; 7]);
}

/// Runs without mutation are the same as before mutation existed.
#[test]
fn without_mutation_no_random_number_is_drawn() {
    let catalogue = WORLD.catalogue();
    let old = any_individual(5, catalogue);
    let mut draws = stream(1, 0, 0, Purpose::Breeding);
    let new = mutated(old.clone(), &scenario(0.0, 0.0), catalogue, &mut draws);
    assert_eq!(new, old);
    let mut untouched = stream(1, 0, 0, Purpose::Breeding);
    assert_eq!(draws.next_u64(), untouched.next_u64());
}

#[test]
fn offspring_are_mutated_with_the_given_probabilities_and_the_best_never() {
    let mut settings = still_scenario();
    settings.evolution.prune_probability = 0.25;
    settings.evolution.grow_probability = 0.5;
    let experiment = experiment(settings);
    let catalogue = experiment.catalogue();
    let trees = experiment.scenario.evolution.initial_population.clone();
    let old = individuals(trees.iter().map(String::as_str), catalogue, &mut chance(1));
    let (mut offspring, mut pruned, mut grown) = (0, 0, 0);
    for seed in 0..400 {
        let (_, new) = step(&experiment, seed, state(old.clone(), catalogue, 1));
        for individual in &new.individuals {
            if individual.origin == Origin::Reproduced {
                continue;
            }
            offspring += 1;
            for mutation in individual.origin.mutations() {
                match mutation {
                    Mutation::Pruned { .. } => pruned += 1,
                    Mutation::Grown { .. } => grown += 1,
                }
            }
        }
    }
    assert_eq!(offspring, 2400);
    // These trees can nearly always grow, but some have no node that can be pruned.
    assert_frequencies(&[grown, offspring - grown], &[0.5, 0.5]);
    assert!((400..=600 + 110).contains(&pruned), "{pruned}");
}
