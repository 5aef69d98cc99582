//! What a hierarchy is made of, counted.

use serde::Serialize;

use super::text::to_text;
use super::tree::Tree;
use super::typing::able;
use crate::worlds::{Catalogue, StateType, SubtaskId};

/// The make-up of a hierarchy (Thesis 4.3 compares these numbers).
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Its text form.
    pub tree: String,
    /// Number of levels.
    pub depth: usize,
    /// Composite subtasks, the root counted.
    pub composites: usize,
    /// Distinct primitive subtasks, in the catalogue's order.
    pub primitives: Vec<String>,
    /// For each state type the primitive subtasks that can be selected in it.
    pub primitives_by_state_type: Vec<Vec<String>>,
}

impl Summary {
    /// Counts what `tree` is made of.
    #[must_use]
    pub fn of(tree: &Tree, catalogue: &Catalogue) -> Self {
        let nodes = tree.nodes().iter();
        let composites = nodes
            .filter(|node| catalogue.subtask(node.subtask).is_composite())
            .count();
        let has = |primitive| tree.nodes().iter().any(|node| node.subtask == primitive);
        Self {
            tree: to_text(tree, catalogue),
            depth: tree.depth(),
            composites,
            primitives: names(catalogue, has),
            primitives_by_state_type: catalogue
                .types()
                .map(|state_type| selectable(tree, catalogue, state_type))
                .collect(),
        }
    }
}

/// The primitive subtasks that the root can reach in a state type.
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
