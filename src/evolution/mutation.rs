//! Mutation: pruning and growth of hierarchies (Thesis chapter 5).
//!
//! Crossover swaps subtrees, so every composite subtask keeps its number of children. Pruning
//! removes a child, growth adds one.

use rand::RngExt;

use super::crossover::reset_new_child;
use super::individual::{Individual, Mutation, Origin};
use crate::hierarchy::{Tree, check, random_subtree, to_text};
use crate::learning::{CompositeValues, Hierarchy};
use crate::random::Stream;
use crate::scenario::{Reset, Scenario};
use crate::worlds::{Catalogue, SubtaskId};

/// Draws of a node after which a hierarchy counts as impossible to mutate.
const MAX_DRAWS: usize = 200;
/// Draws of a subtree for a new composite child before the child counts as impossible at
/// its place. In the foraging task about one draw in four has no children and is invalid.
const MAX_SUBTREE_DRAWS: usize = 50;

/// Returns the individual after mutation: first pruning, then growth, each with its own
/// probability.
///
/// Where a probability is 0, no random number is drawn.
#[must_use]
pub fn mutated(
    individual: Individual,
    scenario: &Scenario,
    catalogue: &Catalogue,
    rng: &mut Stream,
) -> Individual {
    let evolution = &scenario.evolution;
    let mut mutant = individual;
    if happens(evolution.prune_probability, rng) {
        mutant = pruned(mutant, scenario, catalogue, rng);
    }
    if happens(evolution.grow_probability, rng) {
        mutant = grown(mutant, scenario, catalogue, rng);
    }
    mutant
}

fn happens(probability: f64, rng: &mut Stream) -> bool {
    probability > 0.0 && rng.random_bool(probability)
}

/// Removes one subtree, drawn uniformly among those without which the hierarchy still obeys
/// the rules. The rest keeps its learned values.
fn pruned(
    individual: Individual,
    scenario: &Scenario,
    catalogue: &Catalogue,
    rng: &mut Stream,
) -> Individual {
    let tree = individual.hierarchy.tree();
    let drawn = (0..MAX_DRAWS).find_map(|_| {
        let node = rng.random_range(1..tree.nodes().len());
        let left = tree.pruned(node);
        is_valid(&left, scenario, catalogue).then_some((node, left))
    });
    let Some((node, left)) = drawn else {
        return individual;
    };
    let Some(parent) = tree.nodes()[node].parent else {
        return individual;
    };
    let mutation = Mutation::Pruned {
        parent: tree.subtask(parent).name(catalogue).to_owned(),
        subtree: to_text(&tree.at(node), catalogue),
    };
    let place = tree.children(parent).position(|child| child == node);
    let mut values = individual.hierarchy.values().to_vec();
    values.drain(tree.subtree(node));
    // The parent precedes its child, so its index is the same in both trees.
    values[parent] = values[parent].as_ref().and_then(|value| {
        let mut vectors = value.vectors();
        vectors.remove(place?);
        let (subtask, children) = (left.subtask(parent), children(&left, parent));
        CompositeValues::from_vectors(subtask, &children, catalogue, value.temperature, &vectors)
    });
    let hierarchy = Hierarchy::from_parts(left, values)
        .unwrap_or_else(|| unreachable!("values were removed as the nodes were"));
    with(individual, hierarchy, mutation, &[], catalogue)
}

/// Adds a child to a composite subtask, drawn uniformly among the children that it lacks and
/// the rules allow. A composite child gets a random subtree.
///
/// As in crossover, the composite subtasks on the path to the root are reset, or only what the
/// parent has learned about the new child.
fn grown(
    individual: Individual,
    scenario: &Scenario,
    catalogue: &Catalogue,
    rng: &mut Stream,
) -> Individual {
    let tree = individual.hierarchy.tree();
    let depth = scenario.evolution.maximum_depth;
    let drawn = (0..MAX_DRAWS).find_map(|_| {
        let parent = rng.random_range(0..tree.nodes().len());
        let child = SubtaskId(rng.random_range(1..catalogue.subtasks.len()) as u8);
        if children(tree, parent).contains(&child) {
            return None;
        }
        let room = depth.checked_sub(tree.nodes()[parent].depth)?;
        let (subtree, more) = (0..MAX_SUBTREE_DRAWS).find_map(|_| {
            let subtree = random_subtree(child, tree, catalogue, room, rng);
            let more = tree.grown(parent, &subtree);
            is_valid(&more, scenario, catalogue).then_some((subtree, more))
        })?;
        Some((parent, subtree, more))
    });
    let Some((parent, subtree, more)) = drawn else {
        return individual;
    };
    let mutation = Mutation::Grown {
        parent: tree.subtask(parent).name(catalogue).to_owned(),
        subtree: to_text(&subtree, catalogue),
    };
    let end = tree.subtree(parent).end;
    let mut path = Vec::new();
    if scenario.evolution.reset == Reset::Path {
        path.push(parent);
        path.extend(tree.ancestors(parent));
    }
    let mut values = individual.hierarchy.values().to_vec();
    let (_, new) = Hierarchy::new(subtree, catalogue, &scenario.learning).into_parts();
    values.splice(end..end, new);
    if scenario.evolution.reset == Reset::Child {
        reset_new_child(&more, end, &mut values, scenario, catalogue);
    }
    for &node in &path {
        let children = children(&more, node);
        let subtask = more.subtask(node);
        values[node] = Some(CompositeValues::new(
            subtask,
            &children,
            catalogue,
            &scenario.learning,
        ));
    }
    let hierarchy = Hierarchy::from_parts(more, values)
        .unwrap_or_else(|| unreachable!("values were added as the nodes were"));
    with(individual, hierarchy, mutation, &path, catalogue)
}

fn is_valid(tree: &Tree, scenario: &Scenario, catalogue: &Catalogue) -> bool {
    check(tree, catalogue, scenario.evolution.maximum_depth).is_ok()
}

fn children(tree: &Tree, node: usize) -> Vec<SubtaskId> {
    tree.children(node)
        .map(|child| tree.subtask(child))
        .collect()
}

/// Returns the individual with another hierarchy, in which the composite subtasks at `path`
/// were reset, and notes the mutation in its origin.
fn with(
    mut individual: Individual,
    hierarchy: Hierarchy,
    mutation: Mutation,
    path: &[usize],
    catalogue: &Catalogue,
) -> Individual {
    let tree = hierarchy.tree();
    let composites = (0..tree.nodes().len()).filter(|&node| hierarchy.values()[node].is_some());
    let name = |node| tree.subtask(node).name(catalogue);
    match &mut individual.origin {
        Origin::Crossover {
            inherited,
            reset,
            mutations,
            ..
        } => {
            let kept: Vec<_> = composites
                .clone()
                .filter(|node| !path.contains(node))
                .collect();
            inherited.retain(|part| kept.iter().any(|&node| name(node) == part.subtask));
            let is_inherited =
                |node: &usize| inherited.iter().any(|part| name(*node) == part.subtask);
            *reset = composites
                .filter(|node| !is_inherited(node))
                .map(|node| name(node).to_owned())
                .collect();
            mutations.push(mutation);
        }
        Origin::Copied { mutations, .. } => mutations.push(mutation),
        Origin::HandCoded | Origin::Random | Origin::Reproduced => {}
    }
    Individual {
        hierarchy,
        ..individual
    }
}
