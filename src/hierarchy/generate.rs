//! Hierarchies made from a catalogue alone: complete, flat and random ones.

use rand::RngExt;
use rand::seq::SliceRandom;

use super::tree::Tree;
use super::typing::check;
use crate::random::Stream;
use crate::worlds::{Catalogue, SubtaskId};

/// Attempts to draw a random hierarchy before the flat one is returned instead. In the
/// foraging task about one draw in four obeys the rules.
const MAX_DRAWS: usize = 10_000;

/// Returns the complete hierarchy (Thesis Figure 4.2).
///
/// It has every composite subtask, each below the smallest one that contains its state
/// types. Primitive subtasks stand wherever state types are left that no composite child
/// covers.
#[must_use]
pub fn complete(catalogue: &Catalogue) -> Tree {
    let mut preorder = vec![(SubtaskId::ROOT, 1)];
    complete_below(SubtaskId::ROOT, 2, catalogue, &mut preorder);
    Tree::of(&preorder)
}

fn complete_below(
    parent: SubtaskId,
    depth: usize,
    catalogue: &Catalogue,
    preorder: &mut Vec<(SubtaskId, usize)>,
) {
    let active = |id: SubtaskId| catalogue.subtask(id).active;
    let mut left = active(parent);
    for child in catalogue.composites() {
        if container(child, catalogue) == Some(parent) {
            preorder.push((child, depth));
            complete_below(child, depth + 1, catalogue, preorder);
            left = left.without(active(child));
        }
    }
    let primitives = catalogue.primitives().filter(|&id| active(id).meets(left));
    preorder.extend(primitives.map(|primitive| (primitive, depth)));
}

/// Returns the smallest composite subtask whose state types properly contain those of
/// `composite`, the first of equals.
fn container(composite: SubtaskId, catalogue: &Catalogue) -> Option<SubtaskId> {
    let states = |id: SubtaskId| catalogue.subtask(id).active;
    let own = states(composite);
    let containing = catalogue
        .composites()
        .filter(|&other| own.is_subset_of(states(other)) && own != states(other));
    let smallest = containing.min_by_key(|&other| states(other).len());
    smallest.or_else(|| (composite != SubtaskId::ROOT).then_some(SubtaskId::ROOT))
}

/// Returns the flat hierarchy: a root that chooses among all primitive subtasks.
#[must_use]
pub fn flat(catalogue: &Catalogue) -> Tree {
    let primitives = catalogue.primitives().map(|primitive| (primitive, 2));
    let preorder: Vec<_> = [(SubtaskId::ROOT, 1)]
        .into_iter()
        .chain(primitives)
        .collect();
    Tree::of(&preorder)
}

/// Draws a random hierarchy that obeys the typing rules.
///
/// From the root down, every subtask that is allowed as a child becomes one with
/// probability 1/2. Children stand in random order. A composite subtask is drawn only
/// where its own children still fit into `maximum_depth`. The whole tree is drawn again
/// until it obeys the rules.
#[must_use]
pub fn random_tree(catalogue: &Catalogue, maximum_depth: usize, rng: &mut Stream) -> Tree {
    let drawn = (0..MAX_DRAWS).find_map(|_| {
        let mut growth = Growth::new(SubtaskId::ROOT, catalogue, maximum_depth);
        growth.grow(SubtaskId::ROOT, 2, rng);
        let tree = Tree::from_preorder(&growth.preorder)?;
        check(&tree, catalogue, maximum_depth)
            .is_ok()
            .then_some(tree)
    });
    drawn.unwrap_or_else(|| flat(catalogue))
}

/// Draws a subtree of at most `levels` levels below `subtask`, with children drawn as in
/// [`random_tree`]. Composite subtasks that occur in `tree` are left out.
///
/// The subtree need not obey the rules.
pub(crate) fn random_subtree(
    subtask: SubtaskId,
    tree: &Tree,
    catalogue: &Catalogue,
    levels: usize,
    rng: &mut Stream,
) -> Tree {
    let mut growth = Growth::new(subtask, catalogue, levels);
    for node in tree.nodes() {
        growth.used[node.subtask.index()] = true;
    }
    if catalogue.subtask(subtask).is_composite() {
        growth.grow(subtask, 2, rng);
    }
    Tree::of(&growth.preorder)
}

/// A random tree while it is drawn.
struct Growth<'g> {
    catalogue: &'g Catalogue,
    maximum_depth: usize,
    /// For each subtask whether it may not be drawn again.
    used: Vec<bool>,
    preorder: Vec<(SubtaskId, usize)>,
}

impl<'g> Growth<'g> {
    fn new(top: SubtaskId, catalogue: &'g Catalogue, maximum_depth: usize) -> Self {
        let mut used = vec![false; catalogue.subtasks.len()];
        used[top.index()] = true;
        Self {
            catalogue,
            maximum_depth,
            used,
            preorder: vec![(top, 1)],
        }
    }

    /// Draws the children of `parent`, which stand at `depth`, and all below them.
    fn grow(&mut self, parent: SubtaskId, depth: usize, rng: &mut Stream) {
        let catalogue = self.catalogue;
        let states = catalogue.subtask(parent).active;
        let may_be_child = |id: &SubtaskId| {
            let subtask = catalogue.subtask(*id);
            if subtask.is_composite() {
                let free = *id != SubtaskId::ROOT && !self.used[id.index()];
                depth < self.maximum_depth && free && subtask.active.is_subset_of(states)
            } else {
                subtask.active.meets(states)
            }
        };
        let possible = catalogue.ids().filter(may_be_child);
        let mut children: Vec<_> = possible.filter(|_| rng.random()).collect();
        children.shuffle(rng);
        for child in children {
            if !catalogue.subtask(child).is_composite() {
                self.preorder.push((child, depth));
            } else if !std::mem::replace(&mut self.used[child.index()], true) {
                self.preorder.push((child, depth));
                self.grow(child, depth + 1, rng);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::{canonical, parse};
    use crate::random::{Purpose, stream};
    use crate::scenario::Scenario;
    use crate::worlds::foraging::ForagingWorld;
    use crate::worlds::{World, WorldSettings};
    use std::collections::HashSet;

    fn foraging() -> ForagingWorld {
        let scenario = Scenario::load("environment-1").unwrap();
        let WorldSettings::Foraging(model) = &scenario.world else {
            panic!("environment-1 is a foraging task");
        };
        ForagingWorld::new(model).unwrap()
    }

    #[test]
    fn the_complete_hierarchy_is_that_of_figure_4_2() {
        let world = foraging();
        let catalogue = world.catalogue();
        let figure = "(Root (Capture (FindBattery Avoid Wander) (VisibleBattery Avoid Wander \
                      ApproachBattery Turn)) (Deliver (FindNest Avoid Wander) (VisibleNest Avoid \
                      Wander ApproachNest Turn)))";
        let figure = parse(figure, catalogue).unwrap();
        assert_eq!(
            canonical(&complete(catalogue), catalogue),
            canonical(&figure, catalogue)
        );
        assert!(check(&complete(catalogue), catalogue, 4).is_ok());
        assert!(check(&flat(catalogue), catalogue, 2).is_ok());
    }

    #[test]
    fn random_hierarchies_obey_the_rules_and_reach_every_subtask() {
        let world = foraging();
        let catalogue = world.catalogue();
        let mut rng = stream(1, 0, 0, Purpose::Breeding);
        let trees: Vec<_> = (0..500)
            .map(|_| random_tree(catalogue, 4, &mut rng))
            .collect();
        assert!(trees.iter().all(|tree| check(tree, catalogue, 4).is_ok()));
        let structures: HashSet<_> = trees.iter().map(|t| canonical(t, catalogue)).collect();
        assert!(structures.len() > 450, "{} structures", structures.len());
        for id in catalogue.ids() {
            let with = |tree: &&Tree| tree.nodes().iter().any(|node| node.subtask == id);
            assert!(
                trees.iter().filter(with).count() > 50,
                "{}",
                id.name(catalogue)
            );
        }
        assert!(check(&random_tree(catalogue, 2, &mut rng), catalogue, 2).is_ok());
    }
}
