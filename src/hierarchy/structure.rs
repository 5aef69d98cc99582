//! Structures as they are compared between runs.

use super::tree::Tree;
use crate::worlds::{Catalogue, SubtaskId};

/// The hierarchy without primitive children that repeat a sibling: it offers the same
/// choices.
#[must_use]
pub fn without_repeats(tree: &Tree, catalogue: &Catalogue) -> Tree {
    let repeats = |node: usize| {
        let entry = tree.nodes()[node];
        let primitive = !catalogue.subtask(entry.subtask).is_composite();
        primitive
            && entry.parent.is_some_and(|parent| {
                tree.children(parent)
                    .any(|other| other < node && tree.subtask(other) == entry.subtask)
            })
    };
    let kept = (0..tree.nodes().len()).filter(|&node| !repeats(node));
    let preorder: Vec<(SubtaskId, usize)> = kept
        .map(|node| (tree.subtask(node), tree.nodes()[node].depth))
        .collect();
    Tree::from_preorder(&preorder).unwrap_or_else(|| tree.clone())
}
