//! A hierarchy with what it has learned: the whole of an individual.

use super::linear::padded;
use crate::hierarchy::Tree;
use crate::scenario::LearningSettings;
use crate::worlds::{Catalogue, SubtaskId};

/// What a composite subtask has learned: its temperature and, for each child, the
/// parameters of the completion functions C~ and C (Thesis Eq. 3.7, 3.8).
///
/// A parameter vector has the blocks of features that the catalogue says
/// ([`Blocks`](crate::worlds::Blocks)), each padded to whole lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct CompositeValues {
    /// Temperature of softmax selection.
    pub temperature: f32,
    /// For each child C~ and then C.
    pub(super) parameters: Vec<f32>,
    /// For each child.
    layouts: Vec<Layout>,
}

/// How the parameters of a completion function lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    blocks: usize,
    width: usize,
}

impl Layout {
    fn of(parent: SubtaskId, child: SubtaskId, catalogue: &Catalogue) -> Self {
        let map = catalogue.completion_map(parent, child);
        Self {
            blocks: catalogue.subtask(parent).blocks(),
            width: catalogue.maps[map.index()].width(),
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
    /// A subtask with these children that has learned nothing.
    #[must_use]
    pub fn new(
        subtask: SubtaskId,
        children: &[SubtaskId],
        catalogue: &Catalogue,
        learning: &LearningSettings,
    ) -> Self {
        let mut values = Self {
            temperature: learning.initial_temperature as f32,
            parameters: Vec::new(),
            layouts: Vec::with_capacity(children.len()),
        };
        for &child in children {
            let layout = Layout::of(subtask, child, catalogue);
            let mut block = vec![learning.initial_parameter as f32; layout.width];
            block.resize(layout.stride(), 0.0);
            let both = block.repeat(2 * layout.blocks);
            values.parameters.extend(both);
            values.layouts.push(layout);
        }
        values
    }

    /// A subtask with the given parameter vectors, C~ and C for each of these children;
    /// `None` if their number or lengths are not those of the catalogue.
    #[must_use]
    pub fn from_vectors(
        subtask: SubtaskId,
        children: &[SubtaskId],
        catalogue: &Catalogue,
        temperature: f32,
        vectors: &[[Vec<f32>; 2]],
    ) -> Option<Self> {
        let layouts = children
            .iter()
            .map(|&child| Layout::of(subtask, child, catalogue));
        let layouts: Vec<_> = layouts.collect();
        let mut parameters = Vec::new();
        for (layout, vectors) in layouts.iter().zip(vectors) {
            for vector in vectors {
                if vector.len() != layout.blocks * layout.width {
                    return None;
                }
                for block in vector.chunks_exact(layout.width) {
                    parameters.extend_from_slice(block);
                    let padding = layout.stride() - layout.width;
                    parameters.resize(parameters.len() + padding, 0.0);
                }
            }
        }
        (vectors.len() == children.len()).then_some(Self {
            temperature,
            parameters,
            layouts,
        })
    }

    /// The parameter vectors, C~ and C for each child, without padding.
    #[must_use]
    pub fn vectors(&self) -> Vec<[Vec<f32>; 2]> {
        let mut rest = &*self.parameters;
        let mut next = |layout: &Layout| -> Vec<f32> {
            let (vector, others) = rest.split_at(layout.vector());
            rest = others;
            let mut unpadded = Vec::with_capacity(layout.blocks * layout.width);
            for block in vector.chunks_exact(layout.stride()) {
                unpadded.extend_from_slice(&block[..layout.width]);
            }
            unpadded
        };
        let layouts = self.layouts.iter();
        layouts.map(|layout| [next(layout), next(layout)]).collect()
    }

    fn is_finite(&self) -> bool {
        // Without a way out in the middle, so that it runs on vectors.
        let parameters = self.parameters.iter();
        parameters.fold(true, |finite, parameter| finite & parameter.is_finite())
    }

    /// Number of children.
    #[must_use]
    pub fn children(&self) -> usize {
        self.layouts.len()
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
    pub fn new(tree: Tree, catalogue: &Catalogue, learning: &LearningSettings) -> Self {
        let value = |node| {
            let subtask = tree.subtask(node);
            let children: Vec<_> = tree.children(node).map(|c| tree.subtask(c)).collect();
            (!children.is_empty())
                .then(|| CompositeValues::new(subtask, &children, catalogue, learning))
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

    /// Whether every learned value is a finite number; otherwise learning has diverged.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let mut values = self.values.iter().flatten();
        values.all(CompositeValues::is_finite)
    }

    /// The learned values in the order of the nodes; `None` for primitive subtasks.
    #[must_use]
    pub fn values(&self) -> &[Option<CompositeValues>] {
        &self.values
    }
}
