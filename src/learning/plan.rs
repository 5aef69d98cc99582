//! What an agent needs to know of its tree at every step, computed once.

use crate::hierarchy::{Tree, able};
use crate::worlds::{Catalogue, MapId, StateType, StateTypes, SubtaskId};

/// What the place of parameters and the children that can act depend on in a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Situation {
    pub(super) state_type: StateType,
    /// Whether the agent remembers the place that its task needs.
    pub(super) remembers: bool,
}

/// A node of the tree, prepared for execution.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanNode {
    pub(super) subtask: SubtaskId,
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
    /// For each node and situation: where the C~ of the node lies in its parent's parameters.
    blocks: Vec<usize>,
    /// For each node and situation: the place in the primitive set of the subtask that a
    /// primitive node acts as.
    acting: Vec<usize>,
    /// The lists of children that can act, one after the other.
    children: Vec<usize>,
    types: usize,
    /// The input that tells whether the agent remembers ([`Catalogue::memory`]).
    memory: Option<usize>,
}

impl Plan {
    pub(super) fn new(tree: &Tree, catalogue: &Catalogue, width: impl Fn(MapId) -> usize) -> Self {
        let able = able(tree, catalogue);
        let types = catalogue.state_types.len() + 1;
        let mut plan = Self {
            nodes: Vec::new(),
            ends: vec![0],
            blocks: Vec::new(),
            acting: Vec::new(),
            children: Vec::new(),
            types,
            memory: catalogue.memory,
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
                active: subtask.active,
                goal: subtask.goal(),
                parent: node.parent,
                completion: CompletionPlan {
                    map,
                    stride,
                    vector,
                },
                primitive: place(catalogue, node.subtask),
            });
            for situation in plan.situations() {
                let Situation {
                    state_type,
                    remembers,
                } = situation;
                let block = over.block(state_type, remembers);
                plan.blocks.push(at + block * stride);
                let acts_as = catalogue.acts_as(node.subtask, state_type, remembers);
                plan.acting.push(place(catalogue, acts_as).unwrap_or(0));
            }
            for state_type in plan.state_types() {
                let acts = able[index].contains(state_type);
                let choices = tree.children(index).filter(|_| acts);
                plan.children
                    .extend(choices.filter(|&child| able[child].contains(state_type)));
                plan.ends.push(plan.children.len());
            }
        }
        plan
    }

    /// Returns the situation in a state of this type with these inputs.
    #[inline(always)]
    pub(super) fn situation(&self, state_type: StateType, inputs: &[f32]) -> Situation {
        Situation {
            state_type,
            remembers: self.memory.is_some_and(|input| inputs[input] > 0.5),
        }
    }

    /// Returns the number of state types, with the terminal one.
    pub(super) fn types(&self) -> usize {
        self.types
    }

    /// Returns the state types, the terminal one last.
    pub(super) fn state_types(&self) -> impl Iterator<Item = StateType> + use<> {
        (0..self.types).map(|t| StateType(t as u8))
    }

    /// Returns the situations in the order of their lists.
    fn situations(&self) -> impl Iterator<Item = Situation> + use<> {
        let types = self.types;
        [false, true].into_iter().flat_map(move |remembers| {
            (0..types).map(move |t| Situation {
                state_type: StateType(t as u8),
                remembers,
            })
        })
    }

    #[inline(always)]
    fn list(&self, node: usize, situation: Situation) -> usize {
        let list = 2 * node + usize::from(situation.remembers);
        list * self.types + usize::from(situation.state_type.0)
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

    /// Returns where the C~ of `child` lies in its parent's parameters in a situation. Its C
    /// lies one parameter vector further on.
    #[inline(always)]
    pub(super) fn block(&self, child: usize, situation: Situation) -> usize {
        self.blocks[self.list(child, situation)]
    }

    /// Returns the place in the primitive set of the subtask that a primitive node acts as.
    #[inline(always)]
    pub(super) fn acting(&self, node: usize, situation: Situation) -> usize {
        self.acting[self.list(node, situation)]
    }
}

/// Returns the place of a subtask in the primitive set; `None` for a composite one.
fn place(catalogue: &Catalogue, subtask: SubtaskId) -> Option<usize> {
    catalogue.primitives().position(|other| other == subtask)
}
