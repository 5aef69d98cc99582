//! A hierarchy with its learned values.

use super::linear::padded;
use crate::hierarchy::Tree;
use crate::scenario::LearningSettings;
use crate::worlds::{Catalogue, SubtaskId};

/// The learned values of a composite subtask: its temperature and, for each child, the
/// parameters of the completion functions C~ and C (Thesis Eq. 3.7, 3.8).
///
/// A parameter vector consists of the blocks that the catalogue gives the subtask
/// ([`Blocks`](crate::worlds::Blocks)), each padded to whole lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct CompositeValues {
    /// Temperature of softmax selection.
    pub temperature: f32,
    /// For each child the vector of C~, then that of C.
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

    /// Returns the length of one padded parameter vector.
    fn vector(self) -> usize {
        self.blocks * self.stride()
    }
}

impl CompositeValues {
    /// Makes the values of a subtask that has learned nothing.
    #[must_use]
    pub fn new(
        subtask: SubtaskId,
        children: &[SubtaskId],
        catalogue: &Catalogue,
        learning: &LearningSettings,
    ) -> Self {
        let mut values = Self {
            temperature: learning.initial_composite_temperature() as f32,
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

    /// Makes the values of a subtask from parameter vectors, C~ and C for each child.
    ///
    /// Returns `None` if their number or lengths do not fit the catalogue.
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

    /// Returns the parameter vectors, C~ and C for each child, without padding.
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

    /// Returns these values for a subtask whose child at `place` is new: another one than before,
    /// or one more. The new child's completion functions start from initial values; the others
    /// and the temperature stay.
    ///
    /// Returns `None` if `children`, those of the subtask now, do not fit.
    #[must_use]
    pub fn with_new_child(
        &self,
        place: usize,
        subtask: SubtaskId,
        children: &[SubtaskId],
        catalogue: &Catalogue,
        learning: &LearningSettings,
    ) -> Option<Self> {
        let mut vectors = self.vectors();
        vectors.resize(children.len(), Default::default());
        let initial = Self::new(subtask, children, catalogue, learning);
        *vectors.get_mut(place)? = initial.vectors().swap_remove(place);
        Self::from_vectors(subtask, children, catalogue, self.temperature, &vectors)
    }

    fn is_finite(&self) -> bool {
        // No early return, so that the loop vectorises.
        let parameters = self.parameters.iter();
        parameters.fold(true, |finite, parameter| finite & parameter.is_finite())
    }

    /// Returns the number of children.
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
    /// Makes a hierarchy that has learned nothing.
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

    /// Makes a hierarchy from values in the order of the nodes.
    ///
    /// Returns `None` if the values do not fit the tree.
    #[must_use]
    pub fn from_parts(tree: Tree, values: Vec<Option<CompositeValues>>) -> Option<Self> {
        let fits = tree.nodes().len() == values.len()
            && values.iter().enumerate().all(|(node, value)| {
                let children = tree.children(node).count();
                value.as_ref().map_or(0, CompositeValues::children) == children
            });
        fits.then_some(Self { tree, values })
    }

    /// Returns the tree and the values in the order of its nodes.
    #[must_use]
    pub fn into_parts(self) -> (Tree, Vec<Option<CompositeValues>>) {
        (self.tree, self.values)
    }

    /// Returns the tree.
    #[must_use]
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Returns whether every learned value is finite. Otherwise learning has diverged.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let mut values = self.values.iter().flatten();
        values.all(CompositeValues::is_finite)
    }

    /// Returns the learned values in the order of the nodes, `None` for primitive subtasks.
    #[must_use]
    pub fn values(&self) -> &[Option<CompositeValues>] {
        &self.values
    }
}
