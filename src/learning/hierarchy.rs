//! A hierarchy with what it has learned: the whole of an individual.

use super::linear::padded;
use crate::hierarchy::Tree;
use crate::worlds::{Catalogue, SubtaskId};

/// What a composite subtask has learned: its temperature and, for each child, the
/// parameters of the completion functions C~ and C (Thesis Eq. 3.7, 3.8).
///
/// A parameter vector has one block of features for each state type that the
/// subtask is active in; blocks are padded to whole lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct CompositeValues {
    /// Temperature of softmax selection.
    pub temperature: f32,
    /// For each child C~ and then C.
    pub(super) parameters: Vec<f32>,
    layout: Layout,
}

/// How the parameters of a composite subtask lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    blocks: usize,
    width: usize,
}

impl Layout {
    fn of(subtask: SubtaskId, catalogue: &Catalogue) -> Self {
        let subtask = catalogue.subtask(subtask);
        Self {
            blocks: subtask.active.len(),
            width: catalogue.maps[subtask.map.index()].width(),
        }
    }

    fn stride(self) -> usize {
        padded(self.width)
    }

    /// Length of one padded parameter vector.
    fn vector(self) -> usize {
        self.blocks * self.stride()
    }
}

impl CompositeValues {
    /// A subtask that has learned nothing.
    #[must_use]
    pub fn new(
        subtask: SubtaskId,
        children: usize,
        catalogue: &Catalogue,
        temperature: f32,
        initial: f32,
    ) -> Self {
        let layout = Layout::of(subtask, catalogue);
        let mut block = vec![initial; layout.width];
        block.resize(layout.stride(), 0.0);
        Self {
            temperature,
            parameters: block.repeat(2 * children * layout.blocks),
            layout,
        }
    }

    /// A subtask with the given parameter vectors, C~ and C for each child; `None`
    /// if their lengths are not those of the catalogue.
    #[must_use]
    pub fn from_vectors(
        subtask: SubtaskId,
        catalogue: &Catalogue,
        temperature: f32,
        vectors: &[[Vec<f32>; 2]],
    ) -> Option<Self> {
        let layout = Layout::of(subtask, catalogue);
        let mut parameters = Vec::with_capacity(2 * vectors.len() * layout.vector());
        for vector in vectors.iter().flatten() {
            if vector.len() != layout.blocks * layout.width {
                return None;
            }
            for block in vector.chunks_exact(layout.width) {
                parameters.extend_from_slice(block);
                parameters.resize(parameters.len().next_multiple_of(layout.stride()), 0.0);
            }
        }
        Some(Self {
            temperature,
            parameters,
            layout,
        })
    }

    /// The parameter vectors, C~ and C for each child, without padding.
    #[must_use]
    pub fn vectors(&self) -> Vec<[Vec<f32>; 2]> {
        let unpad = |vector: &[f32]| -> Vec<f32> {
            let blocks = vector.chunks_exact(self.layout.stride());
            blocks
                .flat_map(|block| &block[..self.layout.width])
                .copied()
                .collect()
        };
        self.parameters
            .chunks_exact(2 * self.layout.vector())
            .map(|child| {
                let (c_tilde, c) = child.split_at(self.layout.vector());
                [unpad(c_tilde), unpad(c)]
            })
            .collect()
    }

    /// Number of children.
    #[must_use]
    pub fn children(&self) -> usize {
        self.parameters.len() / (2 * self.layout.vector())
    }
}

/// A tree and the learned values of its composite subtasks.
#[derive(Clone, Debug, PartialEq)]
pub struct Hierarchy {
    tree: Tree,
    /// In the order of the nodes; `None` for primitive subtasks.
    values: Vec<Option<CompositeValues>>,
}

impl Hierarchy {
    /// A hierarchy that has learned nothing.
    #[must_use]
    pub fn new(tree: Tree, catalogue: &Catalogue, temperature: f32, initial: f32) -> Self {
        let value = |node| {
            let subtask = tree.subtask(node);
            let children = tree.children(node).count();
            (children > 0)
                .then(|| CompositeValues::new(subtask, children, catalogue, temperature, initial))
        };
        let values = (0..tree.nodes().len()).map(value).collect();
        Self { tree, values }
    }

    /// A hierarchy with these values in the order of the nodes; `None` if they are
    /// not the values of this tree.
    #[must_use]
    pub fn from_parts(tree: Tree, values: Vec<Option<CompositeValues>>) -> Option<Self> {
        let fits = tree.nodes().len() == values.len()
            && values.iter().enumerate().all(|(node, value)| {
                let children = tree.children(node).count();
                value.as_ref().map_or(0, CompositeValues::children) == children
            });
        fits.then_some(Self { tree, values })
    }

    /// The tree and the values in the order of its nodes.
    #[must_use]
    pub fn into_parts(self) -> (Tree, Vec<Option<CompositeValues>>) {
        (self.tree, self.values)
    }

    /// The structure.
    #[must_use]
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The learned values in the order of the nodes; `None` for primitive subtasks.
    #[must_use]
    pub fn values(&self) -> &[Option<CompositeValues>] {
        &self.values
    }
}
