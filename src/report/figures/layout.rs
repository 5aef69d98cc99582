//! The layout of hierarchies in figures.

use serde::Serialize;

use crate::hierarchy::{Glyphs, Tree, draw, to_text};
use crate::worlds::Catalogue;

/// A hierarchy with its layout.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sketch {
    /// Its caption.
    pub caption: String,
    /// The hierarchy as text.
    pub text: String,
    /// Its nodes in preorder.
    #[serde(skip)]
    pub nodes: Vec<SketchNode>,
    /// The hierarchy drawn with box-drawing characters, and drawn in ASCII.
    #[serde(skip)]
    pub lines: [Vec<String>; 2],
}

/// A node of a hierarchy with its position.
#[derive(Clone, Debug, PartialEq)]
pub struct SketchNode {
    /// Name of the subtask.
    pub name: String,
    /// Whether it is composite.
    pub composite: bool,
    /// Its horizontal position, in widths of a leaf.
    pub column: f64,
    /// Its level. The root is at 0.
    pub row: usize,
    /// Index of its parent; `None` for the root.
    pub parent: Option<usize>,
}

impl Sketch {
    /// Lays out a hierarchy: leaves side by side, and parents centred above their children.
    #[must_use]
    pub fn of(caption: String, tree: &Tree, catalogue: &Catalogue) -> Self {
        let mut nodes: Vec<SketchNode> = tree
            .nodes()
            .iter()
            .map(|node| SketchNode {
                name: node.subtask.name(catalogue).to_owned(),
                composite: catalogue.subtask(node.subtask).is_composite(),
                column: 0.0,
                row: node.depth - 1,
                parent: node.parent,
            })
            .collect();
        let mut leaves = 0.0;
        for (node, place) in nodes.iter_mut().enumerate() {
            if tree.children(node).next().is_none() {
                place.column = leaves;
                leaves += 1.0;
            }
        }
        for node in (0..nodes.len()).rev() {
            let children: Vec<_> = tree
                .children(node)
                .map(|child| nodes[child].column)
                .collect();
            if let (Some(first), Some(last)) = (children.first(), children.last()) {
                nodes[node].column = (first + last) / 2.0;
            }
        }
        Self {
            caption,
            text: to_text(tree, catalogue),
            lines: [Glyphs::Unicode, Glyphs::Ascii].map(|glyphs| draw(tree, catalogue, glyphs)),
            nodes,
        }
    }

    /// Returns the width in leaves.
    #[must_use]
    pub fn columns(&self) -> f64 {
        self.nodes
            .iter()
            .map(|node| node.column + 1.0)
            .fold(1.0, f64::max)
    }

    /// Returns the number of levels.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.nodes
            .iter()
            .map(|node| node.row + 1)
            .max()
            .unwrap_or(1)
    }
}
