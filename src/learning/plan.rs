//! What an agent needs to know of its tree at every step, computed once.

use crate::hierarchy::{Tree, able};
use crate::worlds::{Catalogue, MapId, StateType, StateTypes, SubtaskId};

/// A node of the tree, prepared for execution.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanNode {
    pub(super) subtask: SubtaskId,
    pub(super) map: MapId,
    active: StateTypes,
    pub(super) goal: StateTypes,
    pub(super) parent: Option<usize>,
    /// Its parent's completion functions for it.
    pub(super) completion: CompletionPlan,
    /// Its place in the primitive set; `None` for a composite subtask.
    pub(super) primitive: Option<usize>,
}

/// How the completion functions of a parent for a child lie in memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct CompletionPlan {
    pub(super) map: MapId,
    /// Padded length of one block of features.
    pub(super) stride: usize,
    /// Padded length of one parameter vector.
    pub(super) vector: usize,
}

/// A tree prepared for execution.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) nodes: Vec<PlanNode>,
    /// For each node and state type, with the terminal one: the end of its choices.
    ends: Vec<usize>,
    /// For each node and state type: where the C~ of the node lies in its parent's
    /// parameters.
    blocks: Vec<usize>,
    /// The lists of children that can act, one after the other.
    children: Vec<usize>,
    types: usize,
}

impl Plan {
    pub(super) fn new(tree: &Tree, catalogue: &Catalogue, width: impl Fn(MapId) -> usize) -> Self {
        let able = able(tree, catalogue);
        let types = catalogue.state_types.len() + 1;
        let mut plan = Self {
            nodes: Vec::new(),
            ends: vec![0],
            blocks: Vec::new(),
            children: Vec::new(),
            types,
        };
        let mut free = vec![0; tree.nodes().len()];
        for (index, node) in tree.nodes().iter().enumerate() {
            let subtask = catalogue.subtask(node.subtask);
            let parent = node.parent.unwrap_or(index);
            let over = catalogue.subtask(tree.subtask(parent));
            let map = catalogue.completion_map(tree.subtask(parent), node.subtask);
            let stride = width(map);
            let vector = over.blocks() * stride;
            // C~ and C of the children lie one after the other.
            let at = free[parent];
            free[parent] += node.parent.map_or(0, |_| 2 * vector);
            plan.nodes.push(PlanNode {
                subtask: node.subtask,
                map: subtask.map,
                active: subtask.active,
                goal: subtask.goal(),
                parent: node.parent,
                completion: CompletionPlan {
                    map,
                    stride,
                    vector,
                },
                primitive: catalogue.primitives().position(|p| p == node.subtask),
            });
            for state_type in (0..types).map(|t| StateType(t as u8)) {
                let acts = able[index].contains(state_type);
                let choices = tree.children(index).filter(|_| acts);
                plan.children
                    .extend(choices.filter(|&child| able[child].contains(state_type)));
                plan.ends.push(plan.children.len());
                plan.blocks.push(at + over.block(state_type) * stride);
            }
        }
        plan
    }

    /// Returns the children among which a composite subtask chooses in a state type. There
    /// are none where the subtask terminates.
    #[inline(always)]
    pub(super) fn choices(&self, node: usize, state_type: StateType) -> &[usize] {
        let list = node * self.types + usize::from(state_type.0);
        &self.children[self.ends[list]..self.ends[list + 1]]
    }

    /// Returns whether all these nodes are the same primitive subtask, so that it does not
    /// matter which one is chosen.
    pub(super) fn leads_to_one_primitive(&self, nodes: &[usize]) -> bool {
        let primitive = |node: &usize| self.nodes[*node].primitive;
        let first = nodes.first().and_then(primitive);
        first.is_some() && nodes.iter().all(|node| primitive(node) == first)
    }

    /// Returns whether a subtask can act in a state type.
    pub(super) fn can_act(&self, node: usize, state_type: StateType) -> bool {
        if self.nodes[node].primitive.is_some() {
            self.nodes[node].active.contains(state_type)
        } else {
            !self.choices(node, state_type).is_empty()
        }
    }

    /// Returns where the C~ of `child` lies in its parent's parameters for a state type. Its
    /// C lies one parameter vector further on.
    #[inline(always)]
    pub(super) fn block(&self, child: usize, state_type: StateType) -> usize {
        self.blocks[child * self.types + usize::from(state_type.0)]
    }
}
