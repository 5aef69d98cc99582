//! What hierarchies consist of, and how far apart two of them are.

use serde::Serialize;

use super::text::to_text;
use super::tree::Tree;
use super::typing::able;
use crate::worlds::{Catalogue, Kind, StateType, SubtaskId};

/// Returns the structural difference of two hierarchies (Thesis 4.5.2, Figure 4.6): a
/// negative number, 0 for no difference.
///
/// Each composite subtask that only one of them has costs its weight. For each composite
/// subtask, each primitive child that one has there and the other has not costs 1;
/// repeated children count as often as they occur.
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

/// Returns the hierarchy without primitive children that repeat a sibling. It offers the
/// same choices.
#[must_use]
pub fn without_repeats(tree: &Tree, catalogue: &Catalogue) -> Tree {
    let repeats = |node: usize| {
        let subtask = tree.subtask(node);
        let siblings = tree.nodes()[node].parent.into_iter();
        let mut siblings = siblings.flat_map(|parent| tree.children(parent));
        !catalogue.subtask(subtask).is_composite()
            && siblings.any(|other| other < node && tree.subtask(other) == subtask)
    };
    let kept = (0..tree.nodes().len()).filter(|&node| !repeats(node));
    let preorder: Vec<_> = kept
        .map(|node| (tree.subtask(node), tree.nodes()[node].depth))
        .collect();
    Tree::from_preorder(&preorder).unwrap_or_else(|| tree.clone())
}

/// What a hierarchy consists of (Thesis 4.3 compares these numbers).
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// The text form.
    pub tree: String,
    /// Number of levels.
    pub depth: usize,
    /// Number of composite subtasks, the root counted.
    pub composites: usize,
    /// The different primitive subtasks, in the catalogue's order.
    pub primitives: Vec<String>,
    /// For each state type the primitive subtasks that can be selected in it.
    pub primitives_by_state_type: Vec<Vec<String>>,
}

impl Summary {
    /// Summarises a hierarchy.
    #[must_use]
    pub fn of(tree: &Tree, catalogue: &Catalogue) -> Self {
        let nodes = tree.nodes().iter();
        let composites = nodes.filter(|node| catalogue.subtask(node.subtask).is_composite());
        let has = |primitive| position(tree, primitive).is_some();
        Self {
            tree: to_text(tree, catalogue),
            depth: tree.depth(),
            composites: composites.count(),
            primitives: names(catalogue, has),
            primitives_by_state_type: catalogue
                .types()
                .map(|state_type| selectable(tree, catalogue, state_type))
                .collect(),
        }
    }
}

fn selectable(tree: &Tree, catalogue: &Catalogue, state_type: StateType) -> Vec<String> {
    let able = able(tree, catalogue);
    let acts = |node: usize| able[node].contains(state_type);
    names(catalogue, |primitive| {
        (0..tree.nodes().len()).any(|node| {
            tree.subtask(node) == primitive && acts(node) && tree.ancestors(node).all(acts)
        })
    })
}

fn names(catalogue: &Catalogue, wanted: impl Fn(SubtaskId) -> bool) -> Vec<String> {
    let primitives = catalogue
        .primitives()
        .filter(|&primitive| wanted(primitive));
    primitives
        .map(|primitive| primitive.name(catalogue).to_owned())
        .collect()
}
