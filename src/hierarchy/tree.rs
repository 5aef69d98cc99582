//! An ordered tree of subtasks.

use std::ops::Range;

use crate::worlds::SubtaskId;

/// A node of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// Its subtask.
    pub subtask: SubtaskId,
    /// Index of its parent; `None` for the root.
    pub parent: Option<usize>,
    /// Its level, counted from the root, which is at 1.
    pub depth: usize,
    /// Index after its last descendant: its subtree is `index..end`.
    end: usize,
}

/// An ordered tree of subtasks.
///
/// Nodes are numbered in preorder: the root is node 0 and a subtree is a range of nodes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tree {
    nodes: Vec<Node>,
}

impl Tree {
    /// Makes a tree of subtasks and their depths in preorder, the root first at depth 1.
    ///
    /// Returns `None` if these are not the depths of a tree.
    #[must_use]
    pub fn from_preorder(preorder: &[(SubtaskId, usize)]) -> Option<Self> {
        let mut nodes: Vec<Node> = Vec::with_capacity(preorder.len());
        let mut path: Vec<usize> = Vec::new();
        for (index, &(subtask, depth)) in preorder.iter().enumerate() {
            let is_root = index == 0;
            if depth == 0 || depth > path.len() + 1 || (depth == 1) != is_root {
                return None;
            }
            path.truncate(depth - 1);
            nodes.push(Node {
                subtask,
                parent: path.last().copied(),
                depth,
                end: index + 1,
            });
            for &ancestor in &path {
                nodes[ancestor].end = index + 1;
            }
            path.push(index);
        }
        (!nodes.is_empty()).then_some(Self { nodes })
    }

    /// Returns all nodes in preorder. There is at least the root.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Returns the subtask of a node.
    #[must_use]
    pub fn subtask(&self, node: usize) -> SubtaskId {
        self.nodes[node].subtask
    }

    /// Returns the nodes of the subtree at `node`.
    #[must_use]
    pub fn subtree(&self, node: usize) -> Range<usize> {
        node..self.nodes[node].end
    }

    /// Returns the children of a node in order.
    pub fn children(&self, node: usize) -> impl Iterator<Item = usize> + Clone + '_ {
        let end = self.nodes[node].end;
        let first = Some(node + 1).filter(|&child| child < end);
        std::iter::successors(first, move |&child| {
            Some(self.nodes[child].end).filter(|&next| next < end)
        })
    }

    /// Returns the ancestors of a node, its parent first, the root last.
    pub fn ancestors(&self, node: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(self.nodes[node].parent, |&parent| self.nodes[parent].parent)
    }

    /// Returns the number of levels. A root without children has one.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.nodes.iter().map(|node| node.depth).max().unwrap_or(0)
    }

    /// Returns the subtree at `node` as a tree of its own.
    #[must_use]
    pub fn at(&self, node: usize) -> Self {
        Self::of(&self.preorder(self.subtree(node), 1))
    }

    /// Returns this tree without the subtree at `node`, which must not be the root.
    #[must_use]
    pub fn pruned(&self, node: usize) -> Self {
        let mut all = self.preorder(0..self.nodes.len(), 1);
        all.drain(self.subtree(node));
        Self::of(&all)
    }

    /// Returns this tree with `child` as the last child of `parent`.
    #[must_use]
    pub fn grown(&self, parent: usize, child: &Self) -> Self {
        let mut all = self.preorder(0..self.nodes.len(), 1);
        let end = self.nodes[parent].end;
        let depth = self.nodes[parent].depth + 1;
        all.splice(end..end, child.preorder(0..child.nodes.len(), depth));
        Self::of(&all)
    }

    /// Returns this tree with the subtree at `site` replaced by the donor's subtree at
    /// `donor_site`. `site` must not be the root.
    #[must_use]
    pub fn grafted(&self, site: usize, donor: &Self, donor_site: usize) -> Self {
        let graft = donor.preorder(donor.subtree(donor_site), self.nodes[site].depth);
        let mut all = self.preorder(0..self.nodes.len(), 1);
        all.splice(self.subtree(site), graft);
        Self::of(&all)
    }

    /// Returns the subtasks and depths of a subtree whose top is put at `depth`.
    fn preorder(&self, subtree: Range<usize>, depth: usize) -> Vec<(SubtaskId, usize)> {
        let base = self.nodes[subtree.start].depth;
        let nodes = self.nodes[subtree].iter();
        nodes
            .map(|node| (node.subtask, node.depth - base + depth))
            .collect()
    }

    /// Makes a tree of nodes that were taken from trees.
    pub(super) fn of(preorder: &[(SubtaskId, usize)]) -> Self {
        Self::from_preorder(preorder)
            .unwrap_or_else(|| unreachable!("the depths are those of a tree"))
    }
}
