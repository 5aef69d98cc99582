//! The policy of a hierarchy: what it would do in a given state.

use super::agent::Agent;
use super::explanation::Choice;
use super::features::Encoder;
use super::hierarchy::Hierarchy;
use super::plan::Plan;
use super::primitives::PrimitiveSet;
use super::selection::SelectionRule;
use super::state_values::{Parameters, StateValues};
use crate::scenario::{CompositeChoice, LearningSettings};
use crate::worlds::{Catalogue, StateType, SubtaskId, World};

/// The policy of a hierarchy, which can be queried in any state.
#[derive(Clone, Debug)]
pub struct Policy<'r> {
    parameters: Parameters<'r>,
    now: StateValues,
    walk: Walk,
}

/// A walk down a hierarchy along all its choices.
#[derive(Clone, Debug, Default)]
struct Walk {
    /// The probability of each primitive subtask so far.
    totals: Vec<f64>,
    /// The probabilities of the choices of all nodes from the root to the present one.
    shares: Vec<f64>,
}

impl<'r, W: World> Agent<'r, W> {
    /// Returns the agent's present policy.
    #[must_use]
    pub fn policy(&self) -> Policy<'r> {
        Policy::of(self.parameters.clone(), self.world.catalogue())
    }
}

impl<'r> Policy<'r> {
    /// Makes the policy of a hierarchy with the given primitive set.
    #[must_use]
    pub fn new(
        catalogue: &Catalogue,
        encoder: &'r Encoder,
        settings: &'r LearningSettings,
        hierarchy: &Hierarchy,
        primitives: &PrimitiveSet,
    ) -> Self {
        let (tree, values) = hierarchy.clone().into_parts();
        let plan = Plan::new(&tree, catalogue, |map| encoder.width(map));
        let parameters = Parameters::new(encoder, settings, plan, values, primitives.clone());
        Self::of(parameters, catalogue)
    }

    fn of(parameters: Parameters<'r>, catalogue: &Catalogue) -> Self {
        Self {
            now: StateValues::new(&parameters, catalogue.terminal()),
            walk: Walk {
                totals: vec![0.0; parameters.primitives.all().len()],
                ..Walk::default()
            },
            parameters,
        }
    }

    /// Returns the primitive subtask and the action that the hierarchy would choose without
    /// exploring: the largest C~ + V from the root down, then the largest Q_prim.
    ///
    /// Returns `None` where the root cannot act.
    pub fn greedy(&mut self) -> Option<(SubtaskId, usize)> {
        let mut node = 0;
        let situation = self.now.situation;
        while self.parameters.plan.nodes[node].primitive.is_none() {
            if !self.parameters.plan.can_act(node, situation.state_type) {
                return None;
            }
            (node, _) = self.parameters.best_child(&mut self.now, node);
        }
        let primitive = self.parameters.plan.acting(node, situation);
        let values = self.parameters.action_values(&mut self.now, primitive);
        let first = values.iter().copied().reduce(f32::max)?;
        let action = values.iter().position(|&value| value == first)?;
        Some((self.parameters.plan.nodes[node].subtask, action))
    }

    /// Moves to another state, to which all further queries refer.
    pub fn look(&mut self, state_type: StateType, inputs: &[f32]) {
        let situation = self.parameters.plan.situation(state_type, inputs);
        self.now.load(situation, inputs);
    }

    /// Adds to `totals` the probability of ending in each primitive subtask, in the
    /// catalogue's order, when the policy is followed from the root down.
    pub fn add_probabilities(&mut self, totals: &mut [f64]) {
        self.walk.totals.copy_from_slice(totals);
        self.descend(0, 1.0);
        totals.copy_from_slice(&self.walk.totals);
    }

    /// Returns V(root, s), or 0 where the root cannot act.
    pub fn value(&mut self) -> f32 {
        if self
            .parameters
            .plan
            .can_act(0, self.now.situation.state_type)
        {
            self.parameters.projected_value(&mut self.now, 0)
        } else {
            0.0
        }
    }

    /// Returns how a composite node chooses, and the children to choose from. There are none
    /// where it cannot act.
    pub fn choices(&mut self, node: usize) -> (SelectionRule, Vec<Choice>) {
        self.parameters.choices(&mut self.now, node)
    }

    /// Returns Q_prim of every action of a primitive subtask, given by its place in the
    /// catalogue's order.
    pub fn action_values(&mut self, primitive: usize) -> &[f32] {
        self.parameters.action_values(&mut self.now, primitive)
    }

    fn descend(&mut self, node: usize, probability: f64) {
        if let Some(primitive) = self.parameters.plan.nodes[node].primitive {
            self.walk.totals[primitive] += probability;
            return;
        }
        let state_type = self.now.situation.state_type;
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

    /// Appends the probabilities of a node's choices to those of the nodes above it.
    fn push_shares(&mut self, node: usize) {
        let Self {
            parameters,
            now,
            walk,
            ..
        } = self;
        let choices = parameters.plan.choices(node, now.situation.state_type);
        let count = choices.len();
        let random = parameters.settings.composite_choice == CompositeChoice::Random;
        if count == 1 || random || parameters.plan.leads_to_one_primitive(choices) {
            walk.shares
                .resize(walk.shares.len() + count, 1.0 / count as f64);
            return;
        }
        let (_, probabilities) = parameters.policy(now, node);
        walk.shares
            .extend(probabilities.iter().copied().map(f64::from));
    }
}
