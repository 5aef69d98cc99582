//! The lines of a drawn hierarchy, and how to fold them where there is little room.

use super::draw::{Glyphs, draw};
use super::tree::Tree;
use crate::worlds::Catalogue;

/// Columns between nodes on one line.
const GAP: usize = 2;

/// A line of a drawn hierarchy: a node, or primitive children of one composite side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TreeLine {
    /// The branches that lead to the nodes.
    pub branches: String,
    /// The nodes: each with the column where its text begins, and its text.
    pub nodes: Vec<TreeText>,
}

/// A node on a line of a drawn hierarchy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TreeText {
    /// The node.
    pub node: usize,
    /// The column of its text.
    pub column: usize,
    /// Its text.
    pub text: String,
}

impl TreeLine {
    /// Returns whether a node is on this line.
    #[must_use]
    pub fn has(&self, node: usize) -> bool {
        self.nodes.iter().any(|text| text.node == node)
    }

    /// Returns the number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        let last = self.nodes.last();
        last.map_or(0, |last| last.column + last.text.chars().count())
    }

    /// Returns the node whose text is at a column, or the first node if there is none.
    #[must_use]
    pub fn at(&self, column: usize) -> Option<usize> {
        let before = self.nodes.iter().rev().find(|text| text.column <= column);
        before.or(self.nodes.first()).map(|text| text.node)
    }
}

/// Returns the lines of a hierarchy, one for each node in preorder.
#[must_use]
pub fn lines(tree: &Tree, catalogue: &Catalogue, glyphs: Glyphs) -> Vec<TreeLine> {
    let drawn = draw(tree, catalogue, glyphs).into_iter().enumerate();
    drawn
        .map(|(node, line)| {
            let name = tree.subtask(node).name(catalogue);
            let branches = line.strip_suffix(name).unwrap_or("").to_owned();
            one(branches, node, name.to_owned())
        })
        .collect()
}

fn one(branches: String, node: usize, text: String) -> TreeLine {
    let column = branches.chars().count();
    TreeLine {
        branches,
        nodes: vec![TreeText { node, column, text }],
    }
}

/// Returns the lines of a hierarchy in which primitive subtasks that are next to each other
/// below the same composite share lines of at most `columns` columns. `text` is what a primitive
/// node is written as.
#[must_use]
pub fn folded_lines(
    tree: &Tree,
    catalogue: &Catalogue,
    glyphs: Glyphs,
    columns: usize,
    text: impl Fn(usize) -> String,
) -> Vec<TreeLine> {
    let mut folded = Vec::new();
    let mut run: Vec<usize> = Vec::new();
    for (node, line) in lines(tree, catalogue, glyphs).into_iter().enumerate() {
        if tree.children(node).next().is_some() {
            folded.push(line);
            continue;
        }
        run.push(node);
        if !goes_on(tree, node) {
            let [first, next] = branches(tree, node, line.branches, glyphs);
            let texts = run.drain(..).map(|node| (node, text(node)));
            folded.extend(side_by_side(texts, [first, next], columns));
        }
    }
    folded
}

/// Returns whether the next node is a primitive child of the same composite.
fn goes_on(tree: &Tree, node: usize) -> bool {
    let next = node + 1;
    let nodes = tree.nodes();
    next < nodes.len()
        && nodes[next].parent == nodes[node].parent
        && tree.children(next).next().is_none()
}

/// Returns the branches before the first line and before the other lines of primitive nodes of
/// which `last`, drawn with `first`, is the last.
fn branches(tree: &Tree, last: usize, first: String, glyphs: Glyphs) -> [String; 2] {
    let parent = tree.nodes()[last].parent;
    let ends = parent.is_none_or(|parent| tree.children(parent).last() == Some(last));
    let [branch, _, pass] = glyphs.signs();
    let above = first.chars().count().saturating_sub(branch.chars().count());
    let mut next: String = first.chars().take(above).collect();
    next.push_str(if ends { "   " } else { pass });
    [first, next]
}

/// Writes texts side by side, in lines of at most `columns` columns.
fn side_by_side(
    texts: impl Iterator<Item = (usize, String)>,
    [first, next]: [String; 2],
    columns: usize,
) -> Vec<TreeLine> {
    let mut lines: Vec<TreeLine> = Vec::new();
    for (node, text) in texts {
        match lines.last_mut() {
            Some(line) if line.width() + GAP + text.chars().count() <= columns => {
                let column = line.width() + GAP;
                line.nodes.push(TreeText { node, column, text });
            }
            Some(_) => lines.push(one(next.clone(), node, text)),
            None => lines.push(one(first.clone(), node, text)),
        }
    }
    lines
}
