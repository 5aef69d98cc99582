//! The next generation: reproduction, death, tournaments, crossover and mutation.

use rand::RngExt;

use super::crossover::crossover;
use super::individual::{Individual, Origin};
use super::mutation::mutated;
use crate::hierarchy::random_tree;
use crate::learning::{Gate, Hierarchy, Stopped};
use crate::random::Stream;
use crate::scenario::{Inheritance, Scenario, Variation};
use crate::worlds::Catalogue;

/// Pairs of parents drawn before two places are filled by copies.
const MAX_PARENT_DRAWS: usize = 20;

/// Returns the population that follows `ranked`, which is sorted from best to worst
/// (Algorithm 3.1, lines 8 and 9).
///
/// The best are reproduced and as many of the worst die. The other places are filled as the
/// scenario's `variation` says: by default with crossover of parents that win tournaments
/// among the survivors, followed by mutation where the scenario has any.
///
/// `next_id` is the id of the next new individual; it is advanced.
///
/// # Errors
/// When the gate is stopped.
pub(super) fn breed(
    ranked: &[Individual],
    next_id: &mut u64,
    scenario: &Scenario,
    catalogue: &Catalogue,
    rng: &mut Stream,
    gate: &Gate,
) -> Result<Vec<Individual>, Stopped> {
    let evolution = &scenario.evolution;
    if evolution.variation == Variation::None {
        let mut population = ranked.to_vec();
        population.sort_by_key(|individual| individual.id);
        return Ok(population);
    }
    let reproduced = ranked[..evolution.reproduced]
        .iter()
        .map(|best| Individual {
            origin: Origin::Reproduced,
            ..best.clone()
        });
    let mut population: Vec<_> = reproduced.collect();
    if evolution.variation == Variation::RandomTrees {
        let places = ranked.len() - population.len();
        population.extend(random_individuals(
            places, next_id, scenario, catalogue, rng,
        ));
        return Ok(population);
    }
    let survivors = &ranked[..ranked.len() - evolution.reproduced];
    while population.len() < ranked.len() {
        gate.pass(0)?;
        let ids = [*next_id, *next_id + 1];
        *next_id += 2;
        let mut last = [0, 0];
        let crossed = (0..MAX_PARENT_DRAWS).find_map(|_| {
            last = parents(survivors.len(), evolution.tournament_size, rng);
            let [a, b] = last.map(|rank| &survivors[rank]);
            crossover(a, b, ids, scenario, catalogue, rng)
        });
        let copies = || [0, 1].map(|i| copy(&survivors[last[i]], ids[i], scenario, catalogue));
        let offspring = crossed.unwrap_or_else(copies);
        population.extend(offspring.map(|child| mutated(child, scenario, catalogue, rng)));
    }
    population.truncate(ranked.len());
    Ok(population)
}

/// Makes new individuals with random hierarchies.
pub(super) fn random_individuals(
    count: usize,
    next_id: &mut u64,
    scenario: &Scenario,
    catalogue: &Catalogue,
    rng: &mut Stream,
) -> Vec<Individual> {
    let draw = |_| {
        let tree = random_tree(catalogue, scenario.evolution.maximum_depth, rng);
        let id = *next_id;
        *next_id += 1;
        Individual {
            id,
            origin: Origin::Random,
            hierarchy: Hierarchy::new(tree, catalogue, &scenario.learning),
            primitives: None,
        }
    };
    (0..count).map(draw).collect()
}

/// Returns the ranks of two different parents, each the winner of a tournament.
fn parents(survivors: usize, tournament_size: usize, rng: &mut Stream) -> [usize; 2] {
    let all: Vec<_> = (0..survivors).collect();
    let first = tournament(&all, tournament_size, rng);
    let others: Vec<_> = all.into_iter().filter(|&rank| rank != first).collect();
    [first, tournament(&others, tournament_size, rng)]
}

/// Draws `size` different candidates and returns the best (Thesis 2.3.1).
fn tournament(candidates: &[usize], size: usize, rng: &mut Stream) -> usize {
    let mut left = candidates.to_vec();
    let drawn = (0..size.min(candidates.len())).map(|_| {
        let index = rng.random_range(0..left.len());
        left.swap_remove(index)
    });
    drawn.min().unwrap_or(0)
}

/// Makes a new individual with the structure of another, and with its learned values unless
/// inheritance is Darwinian.
fn copy(from: &Individual, id: u64, scenario: &Scenario, catalogue: &Catalogue) -> Individual {
    let (hierarchy, primitives) = match scenario.evolution.inheritance {
        Inheritance::Lamarckian => (from.hierarchy.clone(), from.primitives.clone()),
        Inheritance::Darwinian => {
            let tree = from.hierarchy.tree().clone();
            (Hierarchy::new(tree, catalogue, &scenario.learning), None)
        }
    };
    Individual {
        id,
        origin: Origin::Copied {
            from: from.id,
            mutations: Vec::new(),
        },
        hierarchy,
        primitives,
    }
}
