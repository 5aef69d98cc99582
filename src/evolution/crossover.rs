//! Typed crossover with Lamarckian inheritance (Thesis 3.2).

use rand::RngExt;

use super::individual::{Individual, Inherited, Origin, Parent};
use crate::hierarchy::{Tree, check};
use crate::learning::{CompositeValues, Hierarchy};
use crate::random::Stream;
use crate::scenario::{Inheritance, Reset, Scenario};
use crate::worlds::Catalogue;

/// Pairs of crossover sites drawn before two parents count as incompatible. A tree has about
/// ten nodes, so parents that fail here have hardly any valid pair.
const MAX_SITE_DRAWS: usize = 200;

/// Crosses two parents at sites drawn uniformly among their non-root nodes.
///
/// Sites are drawn again until both offspring obey the typing rules. Returns `None` if no
/// draw gave a valid pair.
///
/// The first offspring is `a` with a subtree of `b`, the second the reverse. Their ids are
/// `ids[0]` and `ids[1]`.
#[must_use]
pub fn crossover(
    a: &Individual,
    b: &Individual,
    ids: [u64; 2],
    scenario: &Scenario,
    catalogue: &Catalogue,
    rng: &mut Stream,
) -> Option<[Individual; 2]> {
    let depth = scenario.evolution.maximum_depth;
    let (tree_a, tree_b) = (a.hierarchy.tree(), b.hierarchy.tree());
    let (nodes_a, nodes_b) = (tree_a.nodes().len(), tree_b.nodes().len());
    (0..MAX_SITE_DRAWS).find_map(|_| {
        let (site_a, site_b) = (rng.random_range(1..nodes_a), rng.random_range(1..nodes_b));
        let valid = |tree| check(&tree, catalogue, depth).is_ok();
        let both = valid(tree_a.grafted(site_a, tree_b, site_b))
            && valid(tree_b.grafted(site_b, tree_a, site_a));
        both.then(|| {
            [
                offspring((a, site_a), (b, site_b), ids[0], scenario, catalogue),
                offspring((b, site_b), (a, site_a), ids[1], scenario, catalogue),
            ]
        })
    })
}

/// Returns the receiver with the subtree at its site replaced by the donor's.
///
/// Composite subtasks keep their learned values, except those on the path from the parent
/// of the new subtree to the root, which are reset. With `reset: child` only what the parent has
/// learned about the new subtree is reset. Under Darwinian inheritance all are reset.
fn offspring(
    (receiver, site): (&Individual, usize),
    (donor, donor_site): (&Individual, usize),
    id: u64,
    scenario: &Scenario,
    catalogue: &Catalogue,
) -> Individual {
    let (old, given) = (receiver.hierarchy.tree(), donor.hierarchy.tree());
    let tree = old.grafted(site, given, donor_site);
    let graft = site..site + given.subtree(donor_site).len();
    let darwinian = scenario.evolution.inheritance == Inheritance::Darwinian;
    let mut path = Vec::new();
    if scenario.evolution.reset == Reset::Path {
        path.extend(tree.ancestors(site));
    }

    let mut values = receiver.hierarchy.values().to_vec();
    let donated = donor.hierarchy.values()[given.subtree(donor_site)].to_vec();
    values.splice(old.subtree(site), donated);
    if scenario.evolution.reset == Reset::Child {
        reset_new_child(&tree, site, &mut values, scenario, catalogue);
    }

    let (mut inherited, mut reset) = (Vec::new(), Vec::new());
    for (node, value) in values.iter_mut().enumerate() {
        let Some(value) = value else { continue };
        let subtask = tree.subtask(node);
        let name = subtask.name(catalogue).to_owned();
        if darwinian || path.contains(&node) {
            let children: Vec<_> = tree.children(node).map(|c| tree.subtask(c)).collect();
            *value = CompositeValues::new(subtask, &children, catalogue, &scenario.learning);
            reset.push(name);
        } else {
            let from = if graft.contains(&node) {
                donor.id
            } else {
                receiver.id
            };
            inherited.push(Inherited {
                subtask: name,
                from,
            });
        }
    }
    let parent = |individual: &Individual, site: usize| Parent {
        id: individual.id,
        site,
        subtask: individual
            .hierarchy
            .tree()
            .subtask(site)
            .name(catalogue)
            .to_owned(),
    };
    let hierarchy = Hierarchy::from_parts(tree, values);
    let primitives = receiver.primitives.clone().filter(|_| !darwinian);
    Individual {
        id,
        origin: Origin::Crossover {
            receiver: parent(receiver, site),
            donor: parent(donor, donor_site),
            inherited,
            reset,
            mutations: Vec::new(),
        },
        hierarchy: hierarchy.unwrap_or_else(|| unreachable!("values were spliced as the tree was")),
        primitives,
    }
}

/// Resets what the parent of the node `child` has learned about it.
pub(super) fn reset_new_child(
    tree: &Tree,
    child: usize,
    values: &mut [Option<CompositeValues>],
    scenario: &Scenario,
    catalogue: &Catalogue,
) {
    let Some(parent) = tree.nodes()[child].parent else {
        return;
    };
    let place = tree.children(parent).position(|other| other == child);
    let subtask = tree.subtask(parent);
    let children: Vec<_> = tree.children(parent).map(|c| tree.subtask(c)).collect();
    values[parent] = values[parent].as_ref().zip(place).and_then(|(old, place)| {
        old.with_new_child(place, subtask, &children, catalogue, &scenario.learning)
    });
}
