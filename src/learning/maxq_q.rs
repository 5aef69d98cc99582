//! MAXQ-Q: one time step of Algorithm 2.4, with the line numbers of this room's page.
//!
//! The recursion is an explicit stack of the active composite subtasks, so that a trial
//! can be paused, watched and ended after any time step.

use rand::RngExt;

use super::agent::{Agent, Frame, Observer, Trial, Update};
use super::linear::Replay;
use super::selection::uniform;
use super::state_values::{Completion, Parameters};
use crate::random::Stream;
use crate::scenario::{CompositeChoice, CoolOn, LearningSettings, PrimitiveLearning, PseudoReward};
use crate::worlds::{StateType, World};

impl<W: World> Agent<'_, W> {
    /// Advances a trial by one time step: choose down to an action, execute it, learn.
    ///
    /// When the trial reaches `step_limit`, or the limit given to [`Agent::new`], all
    /// active subtasks return. That is a truncation, not a terminal state.
    pub fn advance(
        &mut self,
        trial: &mut Trial<W::State>,
        step_limit: u32,
        rng: &mut Stream,
        observer: &mut impl Observer<W>,
    ) {
        let Some((node, primitive)) = self.descend(rng, observer) else {
            return;
        };
        self.execute(node, primitive, trial, rng, observer);
        let limit = step_limit.min(self.step_limit);
        self.ascend(trial.steps >= limit, observer);
    }

    /// Lines 9 to 11: from the innermost active subtask down to a primitive subtask.
    /// Returns its node and its place in the primitive set.
    fn descend(
        &mut self,
        rng: &mut Stream,
        observer: &mut impl Observer<W>,
    ) -> Option<(usize, usize)> {
        loop {
            let node = self.stack.last()?.node;
            let child = self.choose(node, rng)?;
            observer.chose(node, child);
            let started = self.visited.types.len();
            let frame = self.stack.last_mut()?;
            frame.child = child;
            frame.started = started;
            if let Some(primitive) = self.parameters.plan.nodes[child].primitive {
                return Some((child, primitive));
            }
            self.stack.push(Frame {
                node: child,
                child,
                started,
            });
        }
    }

    /// Line 10: chooses a child of a composite node; `None` where none can act.
    fn choose(&mut self, node: usize, rng: &mut Stream) -> Option<usize> {
        let choices = self.parameters.plan.choices(node, self.now.state_type);
        if let [] | [_] = choices {
            return choices.first().copied();
        }
        if self.settings.composite_choice == CompositeChoice::Random {
            return Some(choices[uniform(rng.random(), choices.len())]);
        }
        self.preferences.clear();
        for &child in choices {
            let preference = self.parameters.preference(&mut self.now, node, child);
            self.preferences.push(preference);
        }
        let temperature = self.parameters.temperature(node);
        let index = self.softmax.choose(&self.preferences, temperature, rng);
        Some(choices[index])
    }

    /// Lines 4 to 6: executes an action of a primitive subtask and learns its value.
    fn execute(
        &mut self,
        node: usize,
        primitive: usize,
        trial: &mut Trial<W::State>,
        rng: &mut Stream,
        observer: &mut impl Observer<W>,
    ) {
        // Where only the root is active, the one state before the step is enough.
        if self.stack.len() > 1 {
            self.visited.push(self.parameters.encoder, &mut self.now);
        }
        let values = self.parameters.action_values(&mut self.now, primitive);
        let limit = self.settings.temperature_limit as f32;
        let action = self.softmax.choose(values, limit, rng);
        let value = values[action];
        let subtask = self.parameters.plan.nodes[node].subtask;
        let reward = self.world.step(&mut trial.state, subtask, action, rng);
        trial.steps += 1;
        trial.reward += f64::from(reward);
        observer.acted(node, action, reward, &trial.state);
        std::mem::swap(&mut self.now, &mut self.before);
        self.perceive(&trial.state);
        trial.done = self.now.state_type == self.world.catalogue().terminal();
        if self.settings.primitive_learning != PrimitiveLearning::Frozen {
            let Parameters {
                encoder,
                plan,
                primitives,
                ..
            } = &mut self.parameters;
            let features = encoder.encode(plan.nodes[node].map, &mut self.before.features);
            let step = self.settings.learning_rate as f32 * (reward - value);
            primitives.at_mut(primitive).learn(action, features, step);
            self.before.forget_values();
        }
    }

    /// Lines 12 to 22: a child has returned. Learns in its parent and, while that
    /// returns too, in the parent's parent and so on.
    fn ascend(&mut self, truncated: bool, observer: &mut impl Observer<W>) {
        while let Some(&frame) = self.stack.last() {
            let plan = &self.parameters.plan;
            let terminal = !plan.can_act(frame.node, self.now.state_type);
            self.update(frame, terminal, observer);
            if self.stack.len() == 1 {
                self.visited.clear();
            }
            if !terminal && !truncated {
                return;
            }
            if terminal {
                self.cool(frame.node, observer);
            }
            self.stack.pop();
        }
    }

    /// Lines 13 to 19: updates C~ and C of the child that returned, for all states of
    /// its `childSeq`, the most recent first.
    ///
    /// The bootstrap values are computed once, before the first update.
    fn update(&mut self, frame: Frame, terminal: bool, observer: &mut impl Observer<W>) {
        let Frame {
            node,
            child,
            started,
        } = frame;
        let parameters = &mut self.parameters;
        let at_goal = parameters.plan.nodes[node]
            .goal
            .contains(self.now.state_type);
        let (mut inside, mut outside) = (0.0, 0.0);
        if !terminal {
            let now = &mut self.now;
            let (a_star, value) = parameters.best_child(now, node);
            inside = value + parameters.completion(now, node, a_star, Completion::Inside);
            outside = value + parameters.completion(now, node, a_star, Completion::Outside);
        }
        inside += pseudo_reward(self.settings, at_goal, terminal);
        let learning_rate = self.settings.learning_rate as f32;
        let map = parameters.plan.nodes[child].completion.map;
        if parameters.plan.nodes[child].primitive.is_some() {
            let update = CompletionUpdate {
                state_type: self.before.state_type,
                features: parameters.encoder.encode(map, &mut self.before.features),
                steps: 1,
                discounts: &self.discounts[1..2],
                targets: [inside, outside],
                learning_rate,
            };
            parameters.apply(node, child, update, observer);
        } else {
            let states = self.visited.types.len();
            let mut end = states;
            while end > started {
                let state_type = self.visited.types[end - 1];
                let alike = self.visited.types[started..end].iter().rev();
                let begin = end - alike.take_while(|&&t| t == state_type).count();
                let steps = states - end + 1;
                let update = CompletionUpdate {
                    state_type,
                    features: self.visited.features(map, begin..end),
                    steps,
                    discounts: &self.discounts[steps..=states - begin],
                    targets: [inside, outside],
                    learning_rate,
                };
                parameters.apply(node, child, update, observer);
                end = begin;
            }
        }
        self.now.forget(&self.parameters.plan, child);
    }

    /// After line 22: multiplies the temperature by its decrease factor, down to the
    /// limit (Thesis 3.1).
    fn cool(&mut self, node: usize, observer: &mut impl Observer<W>) {
        let goal = self.parameters.plan.nodes[node].goal;
        let at_goal = goal.contains(self.now.state_type);
        observer.terminated(node, at_goal);
        if self.settings.cool_on == CoolOn::Goal && !at_goal {
            return;
        }
        if let Some(values) = &mut self.parameters.values[node] {
            let cooled = values.temperature * self.settings.temperature_decrease as f32;
            values.temperature = cooled.max(self.settings.temperature_limit as f32);
        }
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

/// An update of C~ and C in successive states of one type.
struct CompletionUpdate<'a> {
    state_type: StateType,
    /// The feature vectors of the states, the most recent state last.
    features: &'a [f32],
    /// N of the most recent state.
    steps: usize,
    /// gamma^N of each state, the most recent state first.
    discounts: &'a [f32],
    /// The targets of C~ and C before they are discounted by gamma^N.
    targets: [f32; 2],
    learning_rate: f32,
}

impl Parameters<'_> {
    /// Lines 16 and 17: updates C~ and C of a composite node for a child.
    #[inline(always)]
    fn apply<W: World>(
        &mut self,
        node: usize,
        child: usize,
        update: CompletionUpdate<'_>,
        observer: &mut impl Observer<W>,
    ) {
        let Some(values) = &mut self.values[node] else {
            return;
        };
        let plan = &self.plan.nodes[child].completion;
        let at = self.plan.block(child, update.state_type);
        let (first, second) = values.parameters[at..].split_at_mut(plan.vector);
        let replay = Replay {
            parameters: [&mut first[..plan.stride], &mut second[..plan.stride]],
            features: update.features,
            discounts: update.discounts,
            targets: update.targets,
            learning_rate: update.learning_rate,
            watch: |recent, [error_inside, error_outside]: [f32; 2]| {
                observer.updated(Update {
                    node,
                    child,
                    state_type: update.state_type,
                    steps: update.steps + recent,
                    error_inside,
                    error_outside,
                });
            },
        };
        replay.run();
    }
}
