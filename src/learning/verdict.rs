//! What a hierarchy would do in a state, whatever led there.

use super::agent::Agent;
use super::explain::Choice;
use super::features::Encoder;
use super::hierarchy::Hierarchy;
use super::plan::Plan;
use super::selection::{Rule, Softmax};
use super::situation::{Completion, Mind, Situation};
use super::skills::Skills;
use crate::scenario::{CompositeChoice, LearningModel};
use crate::worlds::{Catalogue, StateType, SubtaskId, World};

/// The policy of a hierarchy, to be asked about any state.
#[derive(Clone, Debug)]
pub struct Policy<'r> {
    mind: Mind<'r>,
    now: Situation,
    softmax: Softmax,
    model: &'r LearningModel,
    /// What the walk down the hierarchy has found so far.
    totals: Vec<f64>,
}

impl<'r, W: World> Agent<'r, W> {
    /// The agent's policy as it is now.
    #[must_use]
    pub fn policy(&self) -> Policy<'r> {
        let mind = self.mind.clone();
        Policy {
            now: Situation::new(&mind, self.world.catalogue().terminal()),
            totals: vec![0.0; mind.skills.all().len()],
            softmax: self.softmax,
            model: self.model,
            mind,
        }
    }
}

impl<'r> Policy<'r> {
    /// The policy of a hierarchy with these primitive subtasks.
    #[must_use]
    pub fn new(
        catalogue: &Catalogue,
        encoder: &'r Encoder,
        model: &'r LearningModel,
        hierarchy: &Hierarchy,
        skills: &Skills,
    ) -> Self {
        let (tree, values) = hierarchy.clone().into_parts();
        let mind = Mind {
            encoder,
            plan: Plan::new(&tree, catalogue, |map| encoder.width(map)),
            values,
            skills: skills.clone(),
        };
        Self {
            now: Situation::new(&mind, catalogue.terminal()),
            totals: vec![0.0; skills.all().len()],
            softmax: Softmax::new(model),
            model,
            mind,
        }
    }

    /// The action that the hierarchy would choose without exploring, by the largest
    /// C~ + V from the root down and the largest Q_prim at its end: the primitive subtask
    /// and the index of the action; `None` where the root cannot act.
    pub fn greedy(&mut self) -> Option<(SubtaskId, usize)> {
        let mut node = 0;
        while self.mind.plan.nodes[node].skill.is_none() {
            if !self.mind.plan.can_act(node, self.now.state_type) {
                return None;
            }
            (node, _) = self.mind.best_child(&mut self.now, node);
        }
        let skill = self.mind.plan.nodes[node].skill?;
        let values = self.mind.action_values(&mut self.now, skill);
        let first = values.iter().copied().reduce(f32::max)?;
        let action = values.iter().position(|&value| value == first)?;
        Some((self.mind.plan.nodes[node].subtask, action))
    }

    /// Looks at another state from now on.
    pub fn look(&mut self, state_type: StateType, inputs: &[f32]) {
        self.now.load(state_type, inputs);
    }

    /// Adds to `totals` the probability with which the policy, followed from the root
    /// down, ends in each primitive subtask, in the catalogue's order.
    pub fn add_probabilities(&mut self, totals: &mut [f64]) {
        self.totals.copy_from_slice(totals);
        self.descend(0, 1.0);
        totals.copy_from_slice(&self.totals);
    }

    /// V(root, s); 0 in a state in which the root cannot act.
    pub fn value(&mut self) -> f32 {
        match self.mind.plan.can_act(0, self.now.state_type) {
            true => self.mind.projected_value(&mut self.now, 0),
            false => 0.0,
        }
    }

    /// The children that a composite node can choose among, and how it does; none where
    /// it cannot act.
    pub fn choices(&mut self, node: usize) -> (Rule, Vec<Choice>) {
        self.mind
            .choices(&mut self.now, node, self.softmax, self.model)
    }

    /// Q_prim of every action of the primitive subtask at a place in the catalogue's
    /// order.
    pub fn action_values(&mut self, skill: usize) -> &[f32] {
        self.mind.action_values(&mut self.now, skill)
    }

    fn descend(&mut self, node: usize, probability: f64) {
        if let Some(skill) = self.mind.plan.nodes[node].skill {
            self.totals[skill] += probability;
            return;
        }
        let choices = self.mind.plan.choices(node, self.now.state_type).to_vec();
        let shares = self.shares(node, &choices);
        for (child, share) in choices.into_iter().zip(shares) {
            self.descend(child, probability * share);
        }
    }

    fn shares(&mut self, node: usize, choices: &[usize]) -> Vec<f64> {
        let random = self.model.composite_choice == CompositeChoice::Random;
        if choices.len() == 1 || random || self.leads_to_one_skill(choices) {
            return vec![1.0 / choices.len() as f64; choices.len()];
        }
        let mut values = Vec::with_capacity(choices.len());
        for &child in choices {
            let projected = self.mind.projected_value(&mut self.now, child);
            let inside = self
                .mind
                .completion(&mut self.now, node, child, Completion::Inside);
            values.push(projected + inside);
        }
        let mut out = vec![0.0; values.len()];
        self.softmax
            .probabilities(&values, self.mind.temperature(node), &mut out);
        out.into_iter().map(f64::from).collect()
    }

    /// Whether all choices are the same primitive subtask: then no share matters.
    fn leads_to_one_skill(&self, choices: &[usize]) -> bool {
        let skill = |child: &usize| self.mind.plan.nodes[*child].skill;
        let first = choices.first().and_then(skill);
        first.is_some() && choices.iter().all(|child| skill(child) == first)
    }
}
