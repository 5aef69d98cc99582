//! Explains one time step: everything that decided it and everything that it changed.
//!
//! An explained agent does exactly what an unexplained one does. Values from before the step
//! are read off a copy, by the same code and from the same numbers that the agent uses.

use super::agent::{Agent, Observer, Trial, Update};
use super::explanation::{
    ActionChoice, Change, Choice, Explanation, Level, NodeTermination, UpdateTrace,
};
use super::maxq_q::pseudo_reward;
use super::selection::{SelectionRule, Softmax};
use super::state_values::{Completion, Parameters, StateValues};
use crate::random::Stream;
use crate::scenario::{CompositeChoice, LearningSettings, PrimitiveLearning};
use crate::worlds::{StateType, World};

/// Records what an agent does in one step.
#[derive(Default)]
struct StepRecorder {
    /// Nodes that chose, each with the child chosen, the outermost first.
    chosen: Vec<(usize, usize)>,
    action: Option<(usize, usize, f32)>,
    updates: Vec<Update>,
    terminated: Vec<(usize, bool)>,
}

impl<W: World> Observer<W> for StepRecorder {
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
    /// Returns the temperature of a composite node.
    #[must_use]
    pub fn temperature(&self, node: usize) -> f32 {
        self.parameters.temperature(node)
    }

    /// Advances a trial as [`Agent::advance`] does, and explains the time step.
    ///
    /// Returns `None` if the trial has ended.
    pub fn advance_explained(
        &mut self,
        trial: &mut Trial<W::State>,
        step_limit: u32,
        rng: &mut Stream,
    ) -> Option<Explanation> {
        let percept = self.world.percept(&trial.state);
        let mut past = Before {
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
        let mut recorder = StepRecorder::default();
        self.advance(trial, step_limit, rng, &mut recorder);
        let (node, action, reward) = recorder.action?;
        let mut again = StateValues::new(&self.parameters, past.now.state_type);
        again.load(past.now.state_type, percept.as_ref());
        Some(Explanation {
            levels: past.levels(&recorder),
            action: past.action(&self.parameters, node, action, &mut again),
            reward,
            update_traces: past.update_traces(
                &self.parameters,
                self.now.state_type,
                &recorder,
                &mut again,
            ),
        })
    }
}

/// An agent's values before a step.
struct Before<'r> {
    parameters: Parameters<'r>,
    now: StateValues,
    /// Active nodes, each with the child invoked last.
    frames: Vec<(usize, usize)>,
    softmax: Softmax,
    settings: &'r LearningSettings,
}

impl Before<'_> {
    /// Returns the call stack at the moment when the action was executed.
    fn levels(&mut self, recorder: &StepRecorder) -> Vec<Level> {
        let mut path = self.frames.clone();
        let outermost = recorder.chosen.first().map(|&(node, _)| node);
        path.retain(|&(node, _)| Some(node) != outermost);
        path.extend(&recorder.chosen);
        let chose = |node| recorder.chosen.iter().any(|&(chooser, _)| chooser == node);
        let invoked = |node| recorder.chosen.iter().any(|&(_, child)| child == node);
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
        recorder: &StepRecorder,
        again: &mut StateValues,
    ) -> Vec<UpdateTrace> {
        let taught = recorder
            .updates
            .chunk_by(|one, next| (one.node, one.child) == (next.node, next.child));
        let mut update_traces = Vec::new();
        for updates in taught {
            let (node, child) = (updates[0].node, updates[0].child);
            let terminated = recorder.terminated.iter().find(|&&(who, _)| who == node);
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
    /// Returns how a composite node chooses in a state, and the children to choose from.
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
