//! The values of a whole hierarchy in one state: Algorithm 2.5 with Eq. 3.2 and 3.7 to 3.9.
//!
//! Each value is computed when it is first needed, and once a state.

use super::features::{Encoder, Features};
use super::hierarchy::CompositeValues;
use super::linear::{self, Row};
use super::plan::{Plan, Situation};
use super::primitives::PrimitiveSet;
use super::selection::{SelectionRule, Softmax};
use crate::scenario::{CompositeChoice, CompositeReward, LearningSettings};
use crate::worlds::StateType;

/// Everything that an agent's values depend on: the learned parameters of its hierarchy and
/// of its primitive subtasks.
#[derive(Clone, Debug)]
pub(super) struct Parameters<'r> {
    pub(super) encoder: &'r Encoder,
    pub(super) settings: &'r LearningSettings,
    pub(super) softmax: Softmax,
    pub(super) plan: Plan,
    /// In the order of the nodes; `None` for primitive subtasks.
    pub(super) values: Vec<Option<CompositeValues>>,
    pub(super) primitives: PrimitiveSet,
}

/// A value with the number of the state in which it was computed.
#[derive(Clone, Copy, Debug, Default)]
struct Cached {
    state: u64,
    value: f32,
}

/// The action values of a primitive subtask.
#[derive(Clone, Debug)]
struct ActionValues {
    state: u64,
    /// In whole rows.
    actions: Vec<Row>,
    count: usize,
    best: f32,
}

/// One state with the values that were computed in it so far.
#[derive(Clone, Debug)]
pub(super) struct StateValues {
    pub(super) situation: Situation,
    pub(super) features: Features,
    /// The number of the state. Cached values with another number are out of date.
    state: u64,
    primitives: Vec<ActionValues>,
    /// For each node but the root: C~ and C of its parent for it.
    completions: Vec<[Cached; 2]>,
    /// V of each composite node.
    projected: Vec<Cached>,
    /// Room for C~ + V of the children among which a node chooses.
    preferences: Vec<f32>,
    /// Room for the probabilities of choosing them.
    probabilities: Vec<f32>,
}

/// Which of the two completion functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Completion {
    /// C~, with pseudo-rewards, by which the subtask chooses.
    Inside = 0,
    /// C, without pseudo-rewards, which its parent sees.
    Outside = 1,
}

impl StateValues {
    pub(super) fn new(parameters: &Parameters<'_>, terminal: StateType) -> Self {
        let nodes = parameters.plan.nodes.len();
        let primitives = parameters.primitives.all().iter();
        Self {
            situation: Situation {
                state_type: terminal,
                remembers: false,
            },
            features: parameters.encoder.features(),
            state: 0,
            primitives: primitives
                .map(|primitive| ActionValues {
                    state: 0,
                    actions: primitive.values(),
                    count: primitive.vectors().count(),
                    best: 0.0,
                })
                .collect(),
            completions: vec![[Cached::default(); 2]; nodes],
            projected: vec![Cached::default(); nodes],
            preferences: Vec::new(),
            probabilities: Vec::new(),
        }
    }

    /// Loads another state.
    #[inline]
    pub(super) fn load(&mut self, situation: Situation, inputs: &[f32]) {
        self.situation = situation;
        self.features.load(inputs);
        self.state += 1;
    }

    /// Forgets all values but not the features, because the primitive subtasks have changed.
    pub(super) fn forget_values(&mut self) {
        self.state += 1;
    }

    /// Returns the probability of one of the choices that [`Parameters::policy`] has weighed.
    pub(super) fn probability(&self, choice: usize) -> f32 {
        self.probabilities[choice]
    }

    /// Forgets what an update of the completion functions for `child` changes: their values,
    /// and V of all nodes above it.
    #[inline]
    pub(super) fn forget(&mut self, plan: &Plan, child: usize) {
        self.completions[child] = [Cached::default(); 2];
        let mut node = child;
        while let Some(parent) = plan.nodes[node].parent {
            self.projected[parent].state = 0;
            node = parent;
        }
    }
}

impl<'r> Parameters<'r> {
    pub(super) fn new(
        encoder: &'r Encoder,
        settings: &'r LearningSettings,
        plan: Plan,
        values: Vec<Option<CompositeValues>>,
        primitives: PrimitiveSet,
    ) -> Self {
        Self {
            encoder,
            settings,
            softmax: Softmax::new(settings),
            plan,
            values,
            primitives,
        }
    }

    /// Returns Q_prim of all actions of a primitive subtask (Thesis Eq. 3.9).
    #[inline]
    pub(super) fn action_values<'s>(
        &self,
        now: &'s mut StateValues,
        primitive: usize,
    ) -> &'s [f32] {
        self.evaluate_primitive(now, primitive);
        let values = &now.primitives[primitive];
        &values.actions.as_flattened()[..values.count]
    }

    #[inline]
    fn evaluate_primitive(&self, now: &mut StateValues, index: usize) {
        let values = &mut now.primitives[index];
        if values.state == now.state {
            return;
        }
        values.state = now.state;
        let primitive = &self.primitives.all()[index];
        let features = self.encoder.encode(primitive.map, &mut now.features);
        let actions = primitive.evaluate(features, &mut values.actions);
        let larger = |a: f32, &b: &f32| if b > a { b } else { a };
        values.best = actions.iter().fold(f32::NEG_INFINITY, larger);
    }

    /// Returns V(i, s) of a node by Algorithm 2.5: chooses the child with C~, returns its
    /// value with C. The node must be able to act in the state.
    pub(super) fn projected_value(&self, now: &mut StateValues, node: usize) -> f32 {
        if self.plan.nodes[node].primitive.is_some() {
            if let CompositeReward::PerStep(reward) = self.settings.composite_reward {
                return reward as f32;
            }
            let primitive = self.plan.acting(node, now.situation);
            self.evaluate_primitive(now, primitive);
            return now.primitives[primitive].best;
        }
        let cached = now.projected[node];
        if cached.state == now.state {
            return cached.value;
        }
        let (best, projected) = self.best_child(now, node);
        let value = projected + self.completion(now, node, best, Completion::Outside);
        now.projected[node] = Cached {
            state: now.state,
            value,
        };
        value
    }

    /// Returns the child with the largest C~ + V, the first of equals, and its V: j* of
    /// Algorithm 2.5, a* of Algorithm 2.4.
    pub(super) fn best_child(&self, now: &mut StateValues, node: usize) -> (usize, f32) {
        let mut best = (node, 0.0);
        let mut highest = f32::NEG_INFINITY;
        for &child in self.plan.choices(node, now.situation.state_type) {
            let projected = self.projected_value(now, child);
            let value = projected + self.completion(now, node, child, Completion::Inside);
            if value > highest {
                highest = value;
                best = (child, projected);
            }
        }
        best
    }

    /// Returns C~(i, s, a) + V(a, s), by which a node chooses among its children.
    #[inline]
    pub(super) fn preference(&self, now: &mut StateValues, node: usize, child: usize) -> f32 {
        self.projected_value(now, child) + self.completion(now, node, child, Completion::Inside)
    }

    /// Returns the probability of choosing each child that can act, and the rule. There must be
    /// such a child.
    #[inline]
    pub(super) fn policy<'s>(
        &self,
        now: &'s mut StateValues,
        node: usize,
    ) -> (SelectionRule, &'s [f32]) {
        let choices = self.plan.choices(node, now.situation.state_type);
        let random = self.settings.composite_choice == CompositeChoice::Random;
        now.probabilities.clear();
        now.probabilities
            .resize(choices.len(), 1.0 / choices.len() as f32);
        let rule = match choices {
            [_] => SelectionRule::OnlyChoice,
            _ if random => SelectionRule::Uniform,
            _ => {
                self.compare(now, node);
                let temperature = self.temperature(node);
                let StateValues {
                    preferences,
                    probabilities,
                    ..
                } = now;
                self.softmax
                    .probabilities(preferences, temperature, probabilities)
            }
        };
        (rule, &now.probabilities)
    }

    /// Returns C~ + V of each child that can act.
    #[inline]
    pub(super) fn compare<'s>(&self, now: &'s mut StateValues, node: usize) -> &'s [f32] {
        now.preferences.clear();
        for &child in self.plan.choices(node, now.situation.state_type) {
            let preference = self.preference(now, node, child);
            now.preferences.push(preference);
        }
        &now.preferences
    }

    /// Returns C~(i, s, a) or C(i, s, a) for a child of a node (Thesis Eq. 3.7, 3.8).
    #[inline]
    pub(super) fn completion(
        &self,
        now: &mut StateValues,
        node: usize,
        child: usize,
        which: Completion,
    ) -> f32 {
        let cached = now.completions[child][which as usize];
        if cached.state == now.state {
            return cached.value;
        }
        let plan = &self.plan.nodes[child].completion;
        let offset = self.plan.block(child, now.situation) + which as usize * plan.vector;
        let parameters = self.parameters(node);
        let features = self.encoder.encode(plan.map, &mut now.features);
        let value = linear::value(&parameters[offset..offset + plan.stride], features);
        now.completions[child][which as usize] = Cached {
            state: now.state,
            value,
        };
        value
    }

    #[inline]
    fn parameters(&self, node: usize) -> &[f32] {
        self.values[node]
            .as_ref()
            .map_or(&[], |values| &values.parameters)
    }

    /// Returns the temperature of a composite node.
    #[inline]
    pub(super) fn temperature(&self, node: usize) -> f32 {
        self.values[node]
            .as_ref()
            .map_or(1.0, |values| values.temperature)
    }
}
