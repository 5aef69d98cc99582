//! MAXQ-Q: one time step of Algorithm 2.4, with the line numbers of this room's page.
//!
//! The recursion is an explicit stack of the active composite subtasks, so that a trial
//! can be paused, watched and ended after any time step.

use rand::RngExt;

use super::agent::{Agent, Frame, Observer, Trial, Update};
use super::history::Return;
use super::linear::GradientSteps;
use super::plan::Situation;
use super::selection::uniform;
use super::state_values::Parameters;
use super::targets::fill;
use crate::random::Stream;
use crate::scenario::{CompositeChoice, CompositeReward, CoolOn, PrimitiveLearning};
use crate::worlds::World;

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
        if self.persists == 0 && self.descend(rng, observer).is_none() {
            return;
        }
        self.execute(trial, rng, observer);
        let truncated = trial.steps >= step_limit.min(self.step_limit);
        let over = trial.done || truncated;
        let changed = self.now.situation.state_type != self.before.situation.state_type;
        if over || changed {
            self.persists = 0;
        }
        if self.persists == 0 {
            self.ascend(truncated, observer);
        }
        if over {
            self.end_trial(observer);
        }
    }

    /// Lines 9 to 11: from the innermost active subtask down to a primitive subtask. Returns
    /// `None` where no child can act.
    fn descend(&mut self, rng: &mut Stream, observer: &mut impl Observer<W>) -> Option<()> {
        loop {
            let node = self.stack.last()?.node;
            let child = self.choose(node, rng)?;
            observer.chose(node, child);
            let started = self.history.len();
            let frame = self.stack.last_mut()?;
            frame.child = child;
            frame.started = started;
            if self.parameters.plan.nodes[child].primitive.is_some() {
                self.persists = self.settings.persistence;
                return Some(());
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
        let Self {
            parameters, now, ..
        } = self;
        let choices = parameters.plan.choices(node, now.situation.state_type);
        if let [] | [_] = choices {
            return choices.first().copied();
        }
        if self.settings.composite_choice == CompositeChoice::Random {
            return Some(choices[uniform(rng.random(), choices.len())]);
        }
        let preferences = parameters.compare(now, node);
        let temperature = parameters.temperature(node);
        let index = parameters.softmax.choose(preferences, temperature, rng);
        Some(choices[index])
    }

    /// Lines 4 to 6: executes an action of the primitive subtask that acts, and learns its
    /// value.
    fn execute(
        &mut self,
        trial: &mut Trial<W::State>,
        rng: &mut Stream,
        observer: &mut impl Observer<W>,
    ) {
        let Some(&Frame { child: node, .. }) = self.stack.last() else {
            return;
        };
        self.persists -= 1;
        if self.history.keeps(self.stack.len()) {
            self.history.push(self.parameters.encoder, &mut self.now);
        }
        let primitive = self.parameters.plan.acting(node, self.now.situation);
        let (action, value) = self.choose_action(primitive, rng);
        let subtask = self.parameters.plan.nodes[node].subtask;
        let reward = self.world.step(&mut trial.state, subtask, action, rng);
        trial.steps += 1;
        trial.reward += f64::from(reward);
        observer.acted(node, action, reward, &trial.state);
        self.history.rewarded(match self.settings.composite_reward {
            CompositeReward::Subtask => reward,
            CompositeReward::PerStep(reward) => reward as f32,
        });
        std::mem::swap(&mut self.now, &mut self.before);
        self.perceive(&trial.state);
        trial.done = self.now.situation.state_type == self.world.catalogue().terminal();
        let own = self.parameters.plan.nodes[node].primitive == Some(primitive);
        if own && self.settings.primitive_learning != PrimitiveLearning::Frozen {
            self.learn_action(primitive, action, reward - value);
        }
    }

    /// Line 4: chooses an action of a primitive subtask, and returns its value.
    fn choose_action(&mut self, primitive: usize, rng: &mut Stream) -> (usize, f32) {
        let Self {
            parameters, now, ..
        } = self;
        let values = parameters.action_values(now, primitive);
        let limit = self.settings.temperature_limit as f32;
        let action = parameters.softmax.choose(values, limit, rng);
        (action, values[action])
    }

    /// Line 5: learns the value of an action of a primitive subtask.
    fn learn_action(&mut self, primitive: usize, action: usize, error: f32) {
        let Parameters {
            encoder,
            primitives,
            ..
        } = &mut self.parameters;
        let map = primitives.all()[primitive].map;
        let features = encoder.encode(map, &mut self.before.features);
        let step = self.settings.learning_rate as f32 * error;
        primitives.at_mut(primitive).learn(action, features, step);
        self.before.forget_values();
    }

    /// Lines 12 to 22: a child has returned. Learns in its parent and, while that
    /// returns too, in the parent's parent and so on.
    fn ascend(&mut self, truncated: bool, observer: &mut impl Observer<W>) {
        while let Some(&frame) = self.stack.last() {
            let terminal = !self.can_act_now(frame.node);
            self.update(frame, observer);
            if self.stack.len() == 1 {
                self.history.root_returned();
            }
            if !terminal && !truncated {
                return;
            }
            if terminal {
                self.terminate(frame.node, observer);
            }
            self.stack.pop();
        }
    }

    fn can_act_now(&self, node: usize) -> bool {
        let state_type = self.now.situation.state_type;
        self.parameters.plan.can_act(node, state_type)
    }

    /// Lines 13 to 19: updates C~ and C of the child that returned, for all states of
    /// its `childSeq`, the most recent first.
    fn update(&mut self, frame: Frame, observer: &mut impl Observer<W>) {
        let returned = Return {
            node: frame.node,
            child: frame.child,
            first: frame.started,
            end: self.history.len(),
        };
        self.history.returned(returned);
        let is_primitive = self.parameters.plan.nodes[frame.child].primitive.is_some();
        if is_primitive && self.settings.persistence == 1 {
            self.learn_one(returned, observer);
        } else {
            self.learn_all(returned, observer);
        }
        self.now.forget(&self.parameters.plan, frame.child);
    }

    /// Updates the one state before the present one, in which a primitive child acted.
    fn learn_one(&mut self, returned: Return, observer: &mut impl Observer<W>) {
        let Return { node, child, .. } = returned;
        let outcome = self.parameters.outcome(&mut self.now, node);
        let targets = [outcome.values.map(|value| self.discounts[1] * value)];
        let map = self.parameters.plan.nodes[child].completion.map;
        let update = CompletionUpdate {
            situation: self.before.situation,
            features: self
                .parameters
                .encoder
                .encode(map, &mut self.before.features),
            steps: 1,
            targets: &targets,
            exit: outcome.exit,
        };
        self.parameters.apply(node, child, update, observer);
    }

    /// Updates all states in which a child acted.
    fn learn_all(&mut self, returned: Return, observer: &mut impl Observer<W>) {
        let Self {
            parameters,
            history,
            targets,
            ..
        } = self;
        let Return {
            node,
            child,
            first,
            mut end,
        } = returned;
        // The bootstrap values are computed once, before the first update.
        let outcome = parameters.outcome(&mut self.now, node);
        let prepared = &parameters.plan.nodes[child];
        let (map, is_primitive) = (prepared.completion.map, prepared.primitive.is_some());
        let discounts = &self.discounts;
        fill(
            targets,
            outcome.values,
            returned,
            is_primitive,
            history,
            discounts,
        );
        while end > first {
            let begin = history.first_alike(first, end);
            let recent = returned.end - end;
            let update = CompletionUpdate {
                situation: history.situation(begin),
                features: history.features(map, begin..end),
                steps: recent + 1,
                targets: &targets[recent..returned.end - begin],
                exit: outcome.exit,
            };
            parameters.apply(node, child, update, observer);
            end = begin;
        }
    }

    /// A composite subtask has terminated. Its temperature falls (Thesis 3.1).
    fn terminate(&mut self, node: usize, observer: &mut impl Observer<W>) {
        let goal = self.parameters.plan.nodes[node].goal;
        let at_goal = goal.contains(self.now.situation.state_type);
        observer.terminated(node, at_goal);
        match self.settings.cool_on {
            CoolOn::Termination => self.parameters.cool(node),
            CoolOn::Goal if at_goal => self.parameters.cool(node),
            CoolOn::Goal | CoolOn::Trial => {}
        }
    }

    /// After the last time step of a trial.
    fn end_trial(&mut self, observer: &mut impl Observer<W>) {
        if self.settings.replay > 0 {
            self.replay(observer);
            self.history.forget_trial();
        }
        if self.settings.cool_on == CoolOn::Trial {
            for node in 0..self.parameters.plan.nodes.len() {
                self.parameters.cool(node);
            }
        }
    }

    /// Repeats the updates of the trial, the child that returned last first, with the values of
    /// that moment.
    fn replay(&mut self, observer: &mut impl Observer<W>) {
        observer.replays();
        self.history.push(self.parameters.encoder, &mut self.now);
        // Another state's values serve as room, so that the present state stays.
        std::mem::swap(&mut self.now, &mut self.before);
        for _ in 0..self.settings.replay {
            let mut loaded = None;
            for index in (0..self.history.returns.len()).rev() {
                let returned = self.history.returns[index];
                if loaded != Some(returned.end) {
                    self.history.load(returned.end, &mut self.now);
                    loaded = Some(returned.end);
                }
                self.learn_all(returned, observer);
                self.now.forget(&self.parameters.plan, returned.child);
            }
        }
        std::mem::swap(&mut self.now, &mut self.before);
        self.now.forget_values();
    }
}

/// An update of C~ and C in successive states of one situation.
struct CompletionUpdate<'a> {
    situation: Situation,
    /// The feature vectors of the states, the most recent state last.
    features: &'a [f32],
    /// N of the most recent state.
    steps: usize,
    /// The targets of C~ and C, the most recent state first.
    targets: &'a [[f32; 2]],
    /// See [`Update::exit`].
    exit: f32,
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
        let at = self.plan.block(child, update.situation);
        let plan = &self.plan.nodes[child].completion;
        let Some(values) = &mut self.values[node] else {
            return;
        };
        let (first, second) = values.parameters[at..].split_at_mut(plan.vector);
        let steps = GradientSteps {
            parameters: [&mut first[..plan.stride], &mut second[..plan.stride]],
            features: update.features,
            targets: update.targets,
            learning_rate: self.settings.learning_rate as f32,
            watch: |recent, [error_inside, error_outside]: [f32; 2]| {
                observer.updated(Update {
                    node,
                    child,
                    state_type: update.situation.state_type,
                    steps: update.steps + recent,
                    exit: update.exit,
                    error_inside,
                    error_outside,
                });
            },
        };
        steps.run();
    }

    /// Multiplies the temperature of a composite node by its decrease factor, down to the limit.
    fn cool(&mut self, node: usize) {
        if let Some(values) = &mut self.values[node] {
            let cooled = values.temperature * self.settings.temperature_decrease as f32;
            values.temperature = cooled.max(self.settings.temperature_limit as f32);
        }
    }
}
