//! One time step with everything that decided it and everything that it changed.
//!
//! Explaining never changes what an agent does: the agent takes the very step that it
//! would have taken, and what it knew before is read off a copy. Every value is
//! computed by the code, and from the numbers, that the agent itself used.

use super::agent::{Agent, Trial};
use super::lessons::pseudo_reward;
use super::observe::{Observer, Update};
use super::selection::{SelectionRule, Softmax};
use super::state_values::{Completion, Parameters, StateValues};
use crate::random::Stream;
use crate::scenario::{CompositeChoice, LearningSettings, PrimitiveLearning};
use crate::worlds::{StateType, World};

/// A child that a composite node can choose in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The child's node.
    pub node: usize,
    /// V(a, s), what the child itself is worth.
    pub value: f32,
    /// C~(i, s, a), with pseudo-rewards: the node chooses by C~ + V.
    pub c_tilde: f32,
    /// C(i, s, a), without: the node's own V is C + V of its best child.
    pub c: f32,
    /// With which it is chosen.
    pub probability: f32,
}

impl Choice {
    /// C~ + V, what the node chooses by.
    #[must_use]
    pub fn preference(&self) -> f32 {
        self.value + self.c_tilde
    }
}

/// An active composite node and what it can choose among.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// The node.
    pub node: usize,
    /// Its temperature.
    pub temperature: f32,
    /// Whether its parent chose it in this very step; else it was active before.
    pub invoked: bool,
    /// Whether it chose in this very step; else its active child goes on.
    pub chose: bool,
    /// How it chooses in this state.
    pub rule: SelectionRule,
    /// The children that can act, in order.
    pub choices: Vec<Choice>,
    /// The child that is active.
    pub active: usize,
}

impl Level {
    /// V(i, s) of the node itself: C + V of the child that it prefers, the first of equals;
    /// `None` where none can act.
    #[must_use]
    pub fn value(&self) -> Option<f32> {
        let best = self.choices.iter().reduce(|best, next| {
            match next.preference() > best.preference() {
                true => next,
                false => best,
            }
        })?;
        Some(best.value + best.c)
    }
}

/// The action of a primitive node.
#[derive(Clone, Debug, PartialEq)]
pub struct ActionChoice {
    /// The node.
    pub node: usize,
    /// The temperature that actions are chosen at.
    pub temperature: f32,
    /// How it chooses.
    pub rule: SelectionRule,
    /// Q_prim of every action.
    pub values: Vec<f32>,
    /// The probability of every action.
    pub probabilities: Vec<f32>,
    /// The action chosen.
    pub chosen: usize,
    /// Q_prim of that action before and after, where primitive subtasks go on learning.
    pub learned: Option<Change>,
}

/// A value before and after a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Before.
    pub before: f32,
    /// After.
    pub after: f32,
}

/// What a composite node learned when a child of it returned (Algorithm 2.4, lines 13
/// to 22).
#[derive(Clone, Debug, PartialEq)]
pub struct UpdateTrace {
    /// The node.
    pub node: usize,
    /// The child that returned.
    pub child: usize,
    /// The node's pseudo-reward for the transition.
    pub pseudo_reward: f32,
    /// The updates, the most recent state first: one for each state visited since the
    /// child was invoked.
    pub updates: Vec<Update>,
    /// C~ of the child in the last state visited, the one before this step.
    pub c_tilde: Change,
    /// C of the child in that state.
    pub c: Change,
    /// How the node itself terminated; `None` if it goes on or was cut off.
    pub termination: Option<NodeTermination>,
}

/// How a composite node terminated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeTermination {
    /// Whether at its goal.
    pub at_goal: bool,
    /// Its temperature.
    pub temperature: Change,
}

/// One time step, explained.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The call stack of composite nodes, the root first.
    pub levels: Vec<Level>,
    /// What was done.
    pub action: ActionChoice,
    /// The primitive subtask's reward for it.
    pub reward: f32,
    /// What was learned, from the innermost node outwards.
    pub update_traces: Vec<UpdateTrace>,
}

/// What an agent was seen doing in one step.
#[derive(Default)]
struct Witness {
    /// Nodes that chose, with the child chosen, from the outermost inwards.
    chosen: Vec<(usize, usize)>,
    action: Option<(usize, usize, f32)>,
    updates: Vec<Update>,
    terminated: Vec<(usize, bool)>,
}

impl<W: World> Observer<W> for Witness {
    fn chose(&mut self, node: usize, child: usize) {
        self.chosen.push((node, child));
    }

    fn acted(&mut self, node: usize, action: usize, reward: f32, _state: &W::State) {
        self.action = Some((node, action, reward));
    }

    fn updated(&mut self, update: Update) {
        self.updates.push(update);
    }

    fn terminated(&mut self, node: usize, at_goal: bool) {
        self.terminated.push((node, at_goal));
    }
}

impl<W: World> Agent<'_, W> {
    /// Temperature of a composite node.
    #[must_use]
    pub fn temperature(&self, node: usize) -> f32 {
        self.parameters.temperature(node)
    }

    /// One time step as [`Agent::advance`] takes it, explained; `None` if the trial is
    /// over.
    pub fn advance_explained(
        &mut self,
        trial: &mut Trial<W::State>,
        step_limit: u32,
        rng: &mut Stream,
    ) -> Option<Explanation> {
        let percept = self.world.percept(&trial.state);
        let mut past = Past {
            parameters: self.parameters.clone(),
            now: self.now.clone(),
            frames: self
                .stack
                .iter()
                .map(|frame| (frame.node, frame.child))
                .collect(),
            softmax: self.softmax,
            settings: self.settings,
        };
        let mut witness = Witness::default();
        self.advance(trial, step_limit, rng, &mut witness);
        let (node, action, reward) = witness.action?;
        let mut again = StateValues::new(&self.parameters, past.now.state_type);
        again.load(past.now.state_type, percept.as_ref());
        Some(Explanation {
            levels: past.levels(&witness),
            action: past.action(&self.parameters, node, action, &mut again),
            reward,
            update_traces: past.update_traces(
                &self.parameters,
                self.now.state_type,
                &witness,
                &mut again,
            ),
        })
    }
}

/// What an agent knew before a step.
struct Past<'r> {
    parameters: Parameters<'r>,
    now: StateValues,
    /// Active nodes, each with the child invoked last.
    frames: Vec<(usize, usize)>,
    softmax: Softmax,
    settings: &'r LearningSettings,
}

impl Past<'_> {
    /// The call stack as it was when the action was executed.
    fn levels(&mut self, witness: &Witness) -> Vec<Level> {
        let mut path = self.frames.clone();
        let outermost = witness.chosen.first().map(|&(node, _)| node);
        path.retain(|&(node, _)| Some(node) != outermost);
        path.extend(&witness.chosen);
        let chose = |node| witness.chosen.iter().any(|&(chooser, _)| chooser == node);
        let invoked = |node| witness.chosen.iter().any(|&(_, child)| child == node);
        path.into_iter()
            .map(|(node, active)| {
                let (rule, choices) =
                    self.parameters
                        .choices(&mut self.now, node, self.softmax, self.settings);
                Level {
                    node,
                    temperature: self.parameters.temperature(node),
                    invoked: invoked(node),
                    chose: chose(node),
                    rule,
                    choices,
                    active,
                }
            })
            .collect()
    }

    fn action(
        &mut self,
        after: &Parameters<'_>,
        node: usize,
        chosen: usize,
        again: &mut StateValues,
    ) -> ActionChoice {
        let primitive = self.parameters.plan.nodes[node]
            .primitive
            .unwrap_or_default();
        let values = self
            .parameters
            .action_values(&mut self.now, primitive)
            .to_vec();
        let temperature = self.settings.temperature_limit as f32;
        let mut probabilities = vec![0.0; values.len()];
        let rule = self
            .softmax
            .probabilities(&values, temperature, &mut probabilities);
        let learns = self.settings.primitive_learning != PrimitiveLearning::Frozen;
        let learned = learns.then(|| Change {
            before: values[chosen],
            after: after.action_values(again, primitive)[chosen],
        });
        ActionChoice {
            node,
            temperature,
            rule,
            values,
            probabilities,
            chosen,
            learned,
        }
    }

    fn update_traces(
        &mut self,
        after: &Parameters<'_>,
        reached: StateType,
        witness: &Witness,
        again: &mut StateValues,
    ) -> Vec<UpdateTrace> {
        let taught = witness
            .updates
            .chunk_by(|one, next| (one.node, one.child) == (next.node, next.child));
        let mut update_traces = Vec::new();
        for updates in taught {
            let (node, child) = (updates[0].node, updates[0].child);
            let terminated = witness.terminated.iter().find(|&&(who, _)| who == node);
            let now = &mut self.now;
            let mut change = |which| Change {
                before: self.parameters.completion(now, node, child, which),
                after: after.completion(again, node, child, which),
            };
            let (c_tilde, c) = (change(Completion::Inside), change(Completion::Outside));
            let goal = self.parameters.plan.nodes[node].goal;
            update_traces.push(UpdateTrace {
                node,
                child,
                pseudo_reward: pseudo_reward(
                    self.settings,
                    goal.contains(reached),
                    terminated.is_some(),
                ),
                updates: updates.to_vec(),
                c_tilde,
                c,
                termination: terminated.map(|&(_, at_goal)| NodeTermination {
                    at_goal,
                    temperature: Change {
                        before: self.parameters.temperature(node),
                        after: after.temperature(node),
                    },
                }),
            });
        }
        update_traces
    }
}

impl Parameters<'_> {
    /// The children that a composite node can choose among in a state, and how it does.
    pub(super) fn choices(
        &self,
        now: &mut StateValues,
        node: usize,
        softmax: Softmax,
        settings: &LearningSettings,
    ) -> (SelectionRule, Vec<Choice>) {
        let children = self.plan.choices(node, now.state_type);
        let mut choices: Vec<_> = children
            .iter()
            .map(|&child| Choice {
                node: child,
                value: self.projected_value(now, child),
                c_tilde: self.completion(now, node, child, Completion::Inside),
                c: self.completion(now, node, child, Completion::Outside),
                probability: 1.0 / children.len() as f32,
            })
            .collect();
        if choices.len() < 2 {
            return (SelectionRule::OnlyChoice, choices);
        }
        if settings.composite_choice == CompositeChoice::Random {
            return (SelectionRule::Uniform, choices);
        }
        let values: Vec<_> = choices.iter().map(Choice::preference).collect();
        let mut probabilities = vec![0.0; values.len()];
        let rule = softmax.probabilities(&values, self.temperature(node), &mut probabilities);
        for (choice, probability) in choices.iter_mut().zip(probabilities) {
            choice.probability = probability;
        }
        (rule, choices)
    }
}
