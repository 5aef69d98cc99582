//! What composite subtasks learn from: the right-hand sides of lines 16 and 17 of Algorithm 2.4.
//!
//! Values come in pairs: for C~, with pseudo-rewards, and for C, without.

use super::history::{History, Return};
use super::state_values::{Completion, Parameters, StateValues};
use crate::scenario::{Bootstrap, ExitValue, LearningSettings, PseudoReward};
use crate::worlds::StateType;

/// What a state to which a child has led is worth to its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    pub(super) values: [f32; 2],
    /// The part that is not in the parent's own values there: the pseudo-reward, or what its
    /// exit is worth.
    pub(super) exit: f32,
}

impl Parameters<'_> {
    /// Returns what the state `next`, to which a child of `node` has led, is worth to `node`.
    pub(super) fn outcome(&self, next: &mut StateValues, node: usize) -> Outcome {
        let state_type = next.situation.state_type;
        let terminal = !self.plan.can_act(node, state_type);
        let [inside, outside] = if terminal {
            [0.0; 2]
        } else {
            self.bootstrap(next, node)
        };
        let exit = match self.settings.exit_value {
            ExitValue::PseudoReward => {
                let at_goal = self.plan.nodes[node].goal.contains(state_type);
                pseudo_reward(self.settings, at_goal, terminal)
            }
            ExitValue::Continuation if terminal => self.continuation(next, node),
            ExitValue::Continuation => 0.0,
        };
        Outcome {
            values: [inside + exit, outside],
            exit,
        }
    }

    /// Returns C~ + V and C + V of a state in which a node can act: those of a*, or their means
    /// over the node's own choices.
    fn bootstrap(&self, next: &mut StateValues, node: usize) -> [f32; 2] {
        if self.settings.bootstrap == Bootstrap::Greedy {
            let (a_star, value) = self.best_child(next, node);
            return self.completions(next, node, a_star).map(|c| value + c);
        }
        self.policy(next, node);
        let choices = self.plan.choices(node, next.situation.state_type);
        let mut means = [0.0; 2];
        for (choice, &child) in choices.iter().enumerate() {
            let probability = next.probability(choice);
            let value = self.projected_value(next, child);
            for (mean, c) in means.iter_mut().zip(self.completions(next, node, child)) {
                *mean += probability * (value + c);
            }
        }
        means
    }

    fn completions(&self, next: &mut StateValues, node: usize, child: usize) -> [f32; 2] {
        [Completion::Inside, Completion::Outside]
            .map(|which| self.completion(next, node, child, which))
    }

    /// Returns what follows when a node terminates: the value of the state to the first of its
    /// ancestors that goes on, 0 where the trial is over.
    pub(super) fn continuation(&self, next: &mut StateValues, node: usize) -> f32 {
        let goes_on = self.continues(node, next.situation.state_type);
        goes_on.map_or(0.0, |ancestor| self.bootstrap(next, ancestor)[0])
    }

    /// Returns the first ancestor of a node that can act in a state type.
    pub(super) fn continues(&self, node: usize, state_type: StateType) -> Option<usize> {
        let parent = |&node: &usize| self.plan.nodes[node].parent;
        let mut ancestors = std::iter::successors(parent(&node), parent);
        ancestors.find(|&ancestor| self.plan.can_act(ancestor, state_type))
    }
}

/// The pseudo-reward of a transition (Thesis Definition 2.1): 0 into a goal state and
/// minus the penalty into any other terminal state.
///
/// With `pseudo_reward: all` it is minus the penalty into every state that is no goal.
pub(super) fn pseudo_reward(settings: &LearningSettings, at_goal: bool, terminal: bool) -> f32 {
    if !at_goal && (terminal || settings.pseudo_reward == PseudoReward::All) {
        -settings.pseudo_penalty as f32
    } else {
        0.0
    }
}

/// Writes the targets for a child that acted in several states, the most recent first.
///
/// Of a composite child, V(a, s) covers the rewards until it returned, so the targets are
/// gamma^N times the outcome. Of a primitive child, V(a, s) is the reward of one step: where it
/// acted for more, the rewards of the later steps are part of the target.
pub(super) fn fill(
    targets: &mut Vec<[f32; 2]>,
    outcome: [f32; 2],
    returned: Return,
    is_primitive: bool,
    history: &History,
    discounts: &[f32],
) {
    targets.clear();
    let Return { first, end, .. } = returned;
    if !is_primitive {
        let discounts = &discounts[1..=end - first];
        targets.extend(
            discounts
                .iter()
                .map(|discount| outcome.map(|value| discount * value)),
        );
        return;
    }
    let gamma = discounts[1];
    let mut target = outcome.map(|value| gamma * value);
    targets.push(target);
    for reward in history.rewards[first + 1..end].iter().rev() {
        target = target.map(|value| gamma * (reward + value));
        targets.push(target);
    }
}
