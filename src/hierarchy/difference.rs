//! How far apart two hierarchies are.

use super::tree::Tree;
use crate::worlds::{Catalogue, Kind, SubtaskId};

/// Structural difference of two hierarchies (Thesis 4.5.2, Figure 4.6): a negative
/// number, 0 for none.
///
/// Each composite that only one of them has costs its weight. For each composite,
/// each primitive child that the one has there and the other has not costs 1,
/// repeated children counted as often as they occur.
#[must_use]
pub fn structural_difference(a: &Tree, b: &Tree, catalogue: &Catalogue) -> i64 {
    let cost: u64 = catalogue
        .composites()
        .map(|composite| {
            let (in_a, in_b) = (position(a, composite), position(b, composite));
            let missing = u64::from(in_a.is_some() != in_b.is_some());
            let weight = match catalogue.subtask(composite).kind {
                Kind::Composite { weight, .. } => u64::from(weight),
                Kind::Primitive { .. } => 0,
            };
            let primitives = catalogue.primitives().map(|primitive| {
                let count = |tree, at| count_children(tree, at, primitive);
                count(a, in_a).abs_diff(count(b, in_b))
            });
            missing * weight + primitives.sum::<u64>()
        })
        .sum();
    -(cost as i64)
}

fn position(tree: &Tree, subtask: SubtaskId) -> Option<usize> {
    tree.nodes().iter().position(|node| node.subtask == subtask)
}

fn count_children(tree: &Tree, parent: Option<usize>, subtask: SubtaskId) -> u64 {
    let children = parent.into_iter().flat_map(|parent| tree.children(parent));
    children
        .filter(|&child| tree.subtask(child) == subtask)
        .count() as u64
}
