//! Explains one time step: everything that decided it and everything that it changed.
//!
//! An explained agent does exactly what an unexplained one does. Values from before the step
//! are read off a copy, by the same code and from the same numbers that the agent uses.

use std::collections::BTreeMap;

use super::agent::{Agent, Observer, Trial, Update};
use super::explanation::{
    ActionChoice, Change, Choice, Exit, Explanation, Level, NodeTermination, Replayed, UpdateTrace,
};
use super::plan::Situation;
use super::selection::SelectionRule;
use super::state_values::{Completion, Parameters, StateValues};
use crate::random::Stream;
use crate::scenario::{ExitValue, PrimitiveLearning};
use crate::worlds::{StateType, World};

/// Records what an agent does in one step.
#[derive(Default)]
struct StepRecorder {
    /// Nodes that chose, each with the child chosen, the outermost first.
    chosen: Vec<(usize, usize)>,
    action: Option<(usize, usize, f32)>,
    updates: Vec<Update>,
    terminated: Vec<(usize, bool)>,
    /// Whether the trial is over and its updates are repeated.
    replays: bool,
    replayed: Vec<Update>,
}

impl<W: World> Observer<W> for StepRecorder {
    fn chose(&mut self, node: usize, child: usize) {
        self.chosen.push((node, child));
    }

    fn acted(&mut self, node: usize, action: usize, reward: f32, _state: &W::State) {
        self.action = Some((node, action, reward));
    }

    fn updated(&mut self, update: Update) {
        if self.replays {
            self.replayed.push(update);
        } else {
            self.updates.push(update);
        }
    }

    fn terminated(&mut self, node: usize, at_goal: bool) {
        self.terminated.push((node, at_goal));
    }

    fn replays(&mut self) {
        self.replays = true;
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
            step: match self.persists {
                0 => 1,
                left => self.settings.persistence - left + 1,
            },
        };
        let mut recorder = StepRecorder::default();
        self.advance(trial, step_limit, rng, &mut recorder);
        let (node, action, reward) = recorder.action?;
        let Situation { state_type, .. } = past.now.situation;
        let mut again = StateValues::new(&self.parameters, state_type);
        again.load(past.now.situation, percept.as_ref());
        Some(Explanation {
            levels: past.levels(&recorder),
            action: past.action(&self.parameters, node, action, &mut again),
            reward,
            update_traces: past.update_traces(
                &self.parameters,
                self.now.situation.state_type,
                &recorder,
                &mut again,
            ),
            replayed: replayed(&recorder.replayed),
        })
    }
}

/// An agent's values before a step.
struct Before<'r> {
    parameters: Parameters<'r>,
    now: StateValues,
    /// Active nodes, each with the child invoked last.
    frames: Vec<(usize, usize)>,
    /// For how many time steps the primitive subtask will have acted with this one.
    step: u32,
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
                let (rule, choices) = self.parameters.choices(&mut self.now, node);
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
        let primitive = self.parameters.plan.acting(node, self.now.situation);
        let values = self
            .parameters
            .action_values(&mut self.now, primitive)
            .to_vec();
        let settings = self.parameters.settings;
        let temperature = settings.temperature_limit as f32;
        let mut probabilities = vec![0.0; values.len()];
        let rule = self
            .parameters
            .softmax
            .probabilities(&values, temperature, &mut probabilities);
        let learns = settings.primitive_learning != PrimitiveLearning::Frozen;
        let learned = learns.then(|| Change {
            before: values[chosen],
            after: after.action_values(again, primitive)[chosen],
        });
        ActionChoice {
            node,
            acts_as: self.parameters.primitives.all()[primitive].subtask,
            step: self.step,
            persistence: settings.persistence,
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
            update_traces.push(UpdateTrace {
                node,
                child,
                exit: self.exit(node, reached, updates[0].exit),
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

    /// Returns what a node learned of the state `reached` beyond its own values there.
    fn exit(&self, node: usize, reached: StateType, value: f32) -> Exit {
        let parameters = &self.parameters;
        let terminal = !parameters.plan.can_act(node, reached);
        match parameters.settings.exit_value {
            ExitValue::PseudoReward => Exit::PseudoReward(value),
            ExitValue::Continuation if terminal => Exit::Continuation {
                ancestor: parameters.continues(node, reached),
                value,
            },
            ExitValue::Continuation => Exit::None,
        }
    }
}

/// Sums up the updates of a repeated trial for each node and child, in the order of the nodes.
fn replayed(updates: &[Update]) -> Vec<Replayed> {
    let mut sums: BTreeMap<(usize, usize), (usize, f32)> = BTreeMap::new();
    for update in updates {
        let (count, sum) = sums.entry((update.node, update.child)).or_default();
        *count += 1;
        *sum += update.error_inside.abs();
    }
    let replayed = sums
        .into_iter()
        .map(|((node, child), (updates, sum))| Replayed {
            node,
            child,
            updates,
            mean_error: sum / updates as f32,
        });
    replayed.collect()
}

impl Parameters<'_> {
    /// Returns how a composite node chooses in a state, and the children to choose from.
    pub(super) fn choices(
        &self,
        now: &mut StateValues,
        node: usize,
    ) -> (SelectionRule, Vec<Choice>) {
        let children = self.plan.choices(node, now.situation.state_type);
        if children.is_empty() {
            return (SelectionRule::OnlyChoice, Vec::new());
        }
        let (rule, probabilities) = self.policy(now, node);
        let probabilities = probabilities.to_vec();
        let choices = children.iter().zip(probabilities);
        let choices = choices.map(|(&child, probability)| Choice {
            node: child,
            value: self.projected_value(now, child),
            c_tilde: self.completion(now, node, child, Completion::Inside),
            c: self.completion(now, node, child, Completion::Outside),
            probability,
        });
        (rule, choices.collect())
    }
}
