//! A time step, explained: what decided it and what it changed.

use super::agent::Update;
use super::selection::SelectionRule;
use crate::worlds::SubtaskId;

/// A child that a composite node can choose in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The child's node.
    pub node: usize,
    /// V(a, s), the value of the child itself.
    pub value: f32,
    /// C~(i, s, a), with pseudo-rewards. The node chooses by C~ + V.
    pub c_tilde: f32,
    /// C(i, s, a), without pseudo-rewards. The node's own V is C + V of its best child.
    pub c: f32,
    /// The probability of choosing it.
    pub probability: f32,
}

impl Choice {
    /// Returns C~ + V, by which the node chooses.
    #[must_use]
    pub fn preference(&self) -> f32 {
        self.value + self.c_tilde
    }
}

/// An active composite node and the children that it can choose from.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// The node.
    pub node: usize,
    /// Its temperature.
    pub temperature: f32,
    /// Whether its parent chose it in this step. Otherwise it was active before.
    pub invoked: bool,
    /// Whether it chose a child in this step. Otherwise its child was still active.
    pub chose: bool,
    /// How it chooses in this state.
    pub rule: SelectionRule,
    /// The children that can act, in their order.
    pub choices: Vec<Choice>,
    /// The active child.
    pub active: usize,
}

impl Level {
    /// Returns V(i, s) of the node: C + V of the child with the largest C~ + V.
    ///
    /// Returns `None` where no child can act.
    #[must_use]
    pub fn value(&self) -> Option<f32> {
        let best = self.choices.iter().reduce(|best, next| {
            if next.preference() > best.preference() {
                next
            } else {
                best
            }
        })?;
        Some(best.value + best.c)
    }
}

/// A primitive node's choice of an action.
#[derive(Clone, Debug, PartialEq)]
pub struct ActionChoice {
    /// The node.
    pub node: usize,
    /// The subtask whose actions it chooses from: its own, unless it imitates others.
    pub acts_as: SubtaskId,
    /// For how many time steps it has acted since it was chosen, this one included.
    pub step: u32,
    /// The most for which it acts before its parent chooses again.
    pub persistence: u32,
    /// The temperature at which it chooses.
    pub temperature: f32,
    /// How it chooses.
    pub rule: SelectionRule,
    /// Q_prim of every action.
    pub values: Vec<f32>,
    /// The probability of every action.
    pub probabilities: Vec<f32>,
    /// The chosen action.
    pub chosen: usize,
    /// Q_prim of that action, where primitive subtasks learn.
    pub learned: Option<Change>,
}

/// A value before and after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// The value before the step.
    pub before: f32,
    /// The value after the step.
    pub after: f32,
}

/// What a composite node learned when one of its children returned (Thesis Algorithm
/// 2.4, lines 13 to 22).
#[derive(Clone, Debug, PartialEq)]
pub struct UpdateTrace {
    /// The node.
    pub node: usize,
    /// The child that returned.
    pub child: usize,
    /// What the node learned of the next state beyond its own values there.
    pub exit: Exit,
    /// The updates, one for each state visited by the child, the most recent first.
    pub updates: Vec<Update>,
    /// C~ of the child in the state before this step.
    pub c_tilde: Change,
    /// C of the child in the state before this step.
    pub c: Change,
    /// How the node itself terminated; `None` if it is still active or was cut off.
    pub termination: Option<NodeTermination>,
}

/// What a composite node learns of the next state beyond its own values there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exit {
    /// The pseudo-reward of the transition.
    PseudoReward(f32),
    /// The node terminated: the value of the state to the ancestor that goes on.
    Continuation {
        /// The ancestor; `None` where the trial is over.
        ancestor: Option<usize>,
        /// The value, 0 where the trial is over.
        value: f32,
    },
    /// The node goes on, and no pseudo-reward is in use.
    None,
}

/// What a composite node learned about a child when the finished trial was repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replayed {
    /// The node.
    pub node: usize,
    /// The child.
    pub child: usize,
    /// Number of updates.
    pub updates: usize,
    /// Mean size of the error of C~ before each update.
    pub mean_error: f32,
}

/// How a composite node terminated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeTermination {
    /// Whether it reached its goal.
    pub at_goal: bool,
    /// Its temperature.
    pub temperature: Change,
}

/// One time step, explained.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The call stack of composite nodes, the root first.
    pub levels: Vec<Level>,
    /// The action.
    pub action: ActionChoice,
    /// The reward of the action.
    pub reward: f32,
    /// What composite nodes learned, the innermost first.
    pub update_traces: Vec<UpdateTrace>,
    /// What they learned from the repeated trial, after its last step.
    pub replayed: Vec<Replayed>,
}
