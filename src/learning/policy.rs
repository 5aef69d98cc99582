//! What a hierarchy would do in a state, whatever led there.

use super::agent::Agent;
use super::explain::Choice;
use super::features::Encoder;
use super::hierarchy::Hierarchy;
use super::plan::Plan;
use super::primitives::PrimitiveSet;
use super::selection::{SelectionRule, Softmax};
use super::state_values::{Completion, Parameters, StateValues};
use crate::scenario::{CompositeChoice, LearningSettings};
use crate::worlds::{Catalogue, StateType, SubtaskId, World};

/// The policy of a hierarchy, to be asked about any state.
#[derive(Clone, Debug)]
pub struct Policy<'r> {
    parameters: Parameters<'r>,
    now: StateValues,
    softmax: Softmax,
    settings: &'r LearningSettings,
    walk: Walk,
}

/// The walk down a hierarchy, along all its choices.
#[derive(Clone, Debug)]
struct Walk {
    /// The probability of each primitive subtask so far.
    totals: Vec<f64>,
    /// The probabilities of the choices of all nodes from the root to where the walk is.
    shares: Vec<f64>,
    /// The values of one node's choices.
    values: Vec<f32>,
    /// Their probabilities.
    chances: Vec<f32>,
}

impl Walk {
    fn among(primitives: usize) -> Self {
        Self {
            totals: vec![0.0; primitives],
            shares: Vec::new(),
            values: Vec::new(),
            chances: Vec::new(),
        }
    }
}

impl<'r, W: World> Agent<'r, W> {
    /// The agent's policy as it is now.
    #[must_use]
    pub fn policy(&self) -> Policy<'r> {
        let parameters = self.parameters.clone();
        Policy {
            now: StateValues::new(&parameters, self.world.catalogue().terminal()),
            walk: Walk::among(parameters.primitives.all().len()),
            softmax: self.softmax,
            settings: self.settings,
            parameters,
        }
    }
}

impl<'r> Policy<'r> {
    /// The policy of a hierarchy with these primitive subtasks.
    #[must_use]
    pub fn new(
        catalogue: &Catalogue,
        encoder: &'r Encoder,
        settings: &'r LearningSettings,
        hierarchy: &Hierarchy,
        primitives: &PrimitiveSet,
    ) -> Self {
        let (tree, values) = hierarchy.clone().into_parts();
        let parameters = Parameters {
            encoder,
            plan: Plan::new(&tree, catalogue, |map| encoder.width(map)),
            values,
            primitives: primitives.clone(),
        };
        Self {
            now: StateValues::new(&parameters, catalogue.terminal()),
            walk: Walk::among(primitives.all().len()),
            softmax: Softmax::new(settings),
            settings,
            parameters,
        }
    }

    /// The action that the hierarchy would choose without exploring, by the largest
    /// C~ + V from the root down and the largest Q_prim at its end: the primitive subtask
    /// and the index of the action; `None` where the root cannot act.
    pub fn greedy(&mut self) -> Option<(SubtaskId, usize)> {
        let mut node = 0;
        while self.parameters.plan.nodes[node].primitive.is_none() {
            if !self.parameters.plan.can_act(node, self.now.state_type) {
                return None;
            }
            (node, _) = self.parameters.best_child(&mut self.now, node);
        }
        let primitive = self.parameters.plan.nodes[node].primitive?;
        let values = self.parameters.action_values(&mut self.now, primitive);
        let first = values.iter().copied().reduce(f32::max)?;
        let action = values.iter().position(|&value| value == first)?;
        Some((self.parameters.plan.nodes[node].subtask, action))
    }

    /// Looks at another state from now on.
    pub fn look(&mut self, state_type: StateType, inputs: &[f32]) {
        self.now.load(state_type, inputs);
    }

    /// Adds to `totals` the probability with which the policy, followed from the root
    /// down, ends in each primitive subtask, in the catalogue's order.
    pub fn add_probabilities(&mut self, totals: &mut [f64]) {
        self.walk.totals.copy_from_slice(totals);
        self.descend(0, 1.0);
        totals.copy_from_slice(&self.walk.totals);
    }

    /// V(root, s); 0 in a state in which the root cannot act.
    pub fn value(&mut self) -> f32 {
        match self.parameters.plan.can_act(0, self.now.state_type) {
            true => self.parameters.projected_value(&mut self.now, 0),
            false => 0.0,
        }
    }

    /// The children that a composite node can choose among, and how it does; none where
    /// it cannot act.
    pub fn choices(&mut self, node: usize) -> (SelectionRule, Vec<Choice>) {
        self.parameters
            .choices(&mut self.now, node, self.softmax, self.settings)
    }

    /// Q_prim of every action of the primitive subtask at a place in the catalogue's
    /// order.
    pub fn action_values(&mut self, primitive: usize) -> &[f32] {
        self.parameters.action_values(&mut self.now, primitive)
    }

    fn descend(&mut self, node: usize, probability: f64) {
        if let Some(primitive) = self.parameters.plan.nodes[node].primitive {
            self.walk.totals[primitive] += probability;
            return;
        }
        let state_type = self.now.state_type;
        let count = self.parameters.plan.choices(node, state_type).len();
        let first = self.walk.shares.len();
        self.push_shares(node);
        for choice in 0..count {
            let child = self.parameters.plan.choices(node, state_type)[choice];
            let share = self.walk.shares[first + choice];
            self.descend(child, probability * share);
        }
        self.walk.shares.truncate(first);
    }

    /// Puts the probabilities of a node's choices on top of those of the nodes above it.
    fn push_shares(&mut self, node: usize) {
        let choices = self.parameters.plan.choices(node, self.now.state_type);
        let random = self.settings.composite_choice == CompositeChoice::Random;
        let Walk {
            shares,
            values,
            chances,
            ..
        } = &mut self.walk;
        let count = choices.len();
        if count == 1 || random || self.parameters.plan.leads_to_one_primitive(choices) {
            shares.resize(shares.len() + count, 1.0 / count as f64);
            return;
        }
        values.clear();
        for &child in choices {
            let projected = self.parameters.projected_value(&mut self.now, child);
            let inside = self
                .parameters
                .completion(&mut self.now, node, child, Completion::Inside);
            values.push(projected + inside);
        }
        chances.resize(count, 0.0);
        self.softmax
            .probabilities(values, self.parameters.temperature(node), chances);
        shares.extend(chances.iter().copied().map(f64::from));
    }
}
