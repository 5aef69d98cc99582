//! Which individuals are reproduced, die and become parents.

use std::collections::{BTreeMap, BTreeSet};

use maxq_lab::evolution::{EvolutionState, Individual, Origin};

use super::trees::chance;
use super::{assert_frequencies, experiment, individuals, state, step, still_scenario};

/// A tree in which all pairs of sites are valid, so that crossover never fails.
const SWAPPABLE: &str = "(Root Wander Wander)";

fn ids(state: &EvolutionState) -> Vec<u64> {
    state
        .individuals
        .iter()
        .map(|individual| individual.id)
        .collect()
}

fn parents(individual: &Individual) -> Option<[u64; 2]> {
    match &individual.origin {
        Origin::Crossover {
            receiver, donor, ..
        } => Some([receiver.id, donor.id]),
        _ => None,
    }
}

#[test]
fn the_best_are_reproduced_with_their_learned_values_and_the_worst_have_no_offspring() {
    let experiment = experiment(still_scenario());
    let catalogue = experiment.catalogue();
    let trees = experiment.scenario.evolution.initial_population.clone();
    for seed in 0..100 {
        let mut rng = chance(seed);
        let old = individuals(trees.iter().map(String::as_str), catalogue, &mut rng);
        let (record, new) = step(&experiment, seed, state(old.clone(), catalogue, 3));
        assert_eq!(new.individuals.len(), old.len());
        assert_eq!(record.individuals.len(), old.len());

        let find = |id| {
            new.individuals
                .iter()
                .find(|individual| individual.id == id)
        };
        for best in &old[..2] {
            let survivor = find(best.id).expect("the best two are reproduced");
            assert_eq!(survivor.origin, Origin::Reproduced);
            // Nothing is learned in this scenario, so the values have not changed.
            assert_eq!(survivor.hierarchy, best.hierarchy);
        }
        assert!(old[2..].iter().all(|dead| find(dead.id).is_none()));
        let reproduced = |individual: &&Individual| individual.origin == Origin::Reproduced;
        assert_eq!(new.individuals.iter().filter(reproduced).count(), 2);

        let worst: BTreeSet<_> = old[6..].iter().map(|individual| individual.id).collect();
        for child in new.individuals.iter().filter(|i| !reproduced(i)) {
            let parents = parents(child).expect("these trees can always be crossed");
            assert!(parents.iter().all(|parent| !worst.contains(parent)));
            assert_ne!(parents[0], parents[1], "two different parents");
        }
        let unique: BTreeSet<_> = ids(&new).into_iter().collect();
        assert_eq!(unique.len(), old.len());
        assert!(unique.iter().all(|&id| id < new.next_id));
    }
}

#[test]
fn ids_are_never_used_again_and_the_population_keeps_its_size() {
    let experiment = experiment(still_scenario());
    let mut rng = chance(1);
    let trees = experiment.scenario.evolution.initial_population.clone();
    let catalogue = experiment.catalogue();
    let first = individuals(trees.iter().map(String::as_str), catalogue, &mut rng);
    let mut now = state(first, catalogue, 0);
    let mut seen: BTreeSet<u64> = ids(&now).into_iter().collect();
    for generation in 1..=20 {
        let before: BTreeSet<u64> = ids(&now).into_iter().collect();
        now = step(&experiment, 1, now).1;
        assert_eq!((now.generation, now.individuals.len()), (generation, 8));
        for id in ids(&now) {
            assert!(
                before.contains(&id) || seen.insert(id),
                "{id} was used again"
            );
        }
    }
    assert_eq!(seen.len(), 8 + 19 * 6, "six new individuals a generation");
}

/// Tournaments of two among the six survivors; for the second parent among the other five.
#[test]
fn parents_are_winners_of_tournaments() {
    let experiment = experiment(still_scenario());
    let catalogue = experiment.catalogue();
    let mut rng = chance(2);
    let old = individuals([SWAPPABLE; 8], catalogue, &mut rng);
    let mut counts: BTreeMap<[u64; 2], u32> = BTreeMap::new();
    for seed in 0..1500 {
        let (_, new) = step(&experiment, seed, state(old.clone(), catalogue, 1));
        // The first of each pair of offspring has an even id: next_id was 108.
        for child in new
            .individuals
            .iter()
            .filter(|i| i.id >= 108 && i.id % 2 == 0)
        {
            let ranks = parents(child).unwrap().map(|id| id - 100);
            *counts.entry(ranks).or_default() += 1;
        }
    }
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    for first in 0..6 {
        for second in (0..6).filter(|&second| second != first) {
            found.push(counts.get(&[first, second]).copied().unwrap_or(0));
            expected.push(wins(first, &[]) * wins(second, &[first]));
        }
    }
    assert_eq!(found.iter().sum::<u32>(), 4500);
    assert_frequencies(&found, &expected);
}

/// The probability that a rank among the first six wins a tournament of two different
/// candidates when the ranks `out` are left out.
fn wins(rank: u64, out: &[u64]) -> f64 {
    let candidates: Vec<u64> = (0..6).filter(|rank| !out.contains(rank)).collect();
    let count = candidates.len() as f64;
    let worse = candidates.iter().filter(|&&other| other > rank).count() as f64;
    worse / (count * (count - 1.0) / 2.0)
}

/// In the foraging task there is always a valid pair of sites, because every tree needs Avoid
/// or Wander. A depth limit that no tree obeys stands in for other worlds.
#[test]
fn where_no_crossover_is_valid_parents_are_copied() {
    let mut experiment = experiment(still_scenario());
    experiment.scenario.evolution.maximum_depth = 1;
    let catalogue = experiment.catalogue();
    let mut rng = chance(3);
    let trees = experiment.scenario.evolution.initial_population.clone();
    let old = individuals(trees.iter().map(String::as_str), catalogue, &mut rng);
    let (record, new) = step(&experiment, 1, state(old.clone(), catalogue, 1));
    let mut copies = 0;
    for individual in &new.individuals {
        let from = match individual.origin {
            Origin::Copied { from, .. } => from,
            _ => continue,
        };
        copies += 1;
        assert!(individual.id >= 108, "a copy is a new individual");
        let parent = old[..6].iter().find(|parent| parent.id == from).unwrap();
        assert_eq!(individual.hierarchy, parent.hierarchy);
    }
    assert_eq!((copies, new.individuals.len()), (6, 8));
    let unique: BTreeSet<_> = ids(&new).into_iter().collect();
    assert_eq!(unique.len(), 8);
    // Two trials of two steps; the two reproduced individuals run one of them.
    assert_eq!(record.control_steps, 1000 + 6 * 4 + 2 * 2);
}
