//! MAXQ-Q (Thesis Algorithm 2.4 with Eq. 3.2 to 3.9) on one hierarchy.
//!
//! The recursion of the algorithm is an explicit stack of the active composite
//! subtasks, so that a trial can be taken one time step at a time: paused, watched,
//! ended at any moment.

use rand::RngExt;

use super::Encoder;
use super::gate::{Gate, Stopped};
use super::hierarchy::Hierarchy;
use super::observe::Observer;
use super::plan::Plan;
use super::primitives::PrimitiveSet;
use super::selection::{Softmax, uniform};
use super::state_values::{Completion, Parameters, StateValues};
use super::visited::Visited;
use crate::random::Stream;
use crate::scenario::{CompositeChoice, LearningSettings, PrimitiveLearning};
use crate::worlds::World;

/// An active composite subtask.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) node: usize,
    /// The child that it has invoked last.
    pub(super) child: usize,
    /// How many states had been visited when it did: the child's start there.
    pub(super) started: usize,
}

/// An agent: a hierarchy that acts in a world and learns.
#[derive(Clone, Debug)]
pub struct Agent<'r, W: World> {
    pub(super) world: &'r W,
    pub(super) settings: &'r LearningSettings,
    pub(super) softmax: Softmax,
    pub(super) parameters: Parameters<'r>,
    hierarchy_tree: crate::hierarchy::Tree,
    pub(super) now: StateValues,
    pub(super) before: StateValues,
    pub(super) visited: Visited<W::Percept>,
    pub(super) stack: Vec<Frame>,
    step_limit: u32,
    /// gamma^N for N = 0, 1, ... up to the step limit.
    pub(super) discounts: Vec<f32>,
    scratch: Vec<f32>,
}

/// A trial that is going on, or over.
#[derive(Clone, Debug)]
pub struct Trial<S> {
    /// The state of the world.
    pub state: S,
    /// Time steps so far.
    pub steps: u32,
    /// Whether the task is done.
    pub done: bool,
    /// The sum of the primitive subtasks' rewards.
    pub reward: f64,
}

impl<'r, W: World> Agent<'r, W> {
    /// An agent with a hierarchy and the primitive subtasks, ready for a trial of at
    /// most `step_limit` time steps.
    #[must_use]
    pub fn new(
        world: &'r W,
        encoder: &'r Encoder,
        settings: &'r LearningSettings,
        hierarchy: Hierarchy,
        primitives: PrimitiveSet,
        step_limit: u32,
    ) -> Self {
        let catalogue = world.catalogue();
        let (tree, values) = hierarchy.into_parts();
        let plan = Plan::new(&tree, catalogue, |map| encoder.width(map));
        let parameters = Parameters {
            encoder,
            plan,
            values,
            primitives,
        };
        let situation = StateValues::new(&parameters, catalogue.terminal());
        let mut discounts = vec![1.0_f64];
        for power in 0..step_limit as usize {
            discounts.push(discounts[power] * settings.discount);
        }
        Self {
            world,
            settings,
            softmax: Softmax::new(settings),
            visited: Visited::new(&parameters.plan, settings),
            parameters,
            hierarchy_tree: tree,
            before: situation.clone(),
            now: situation,
            stack: Vec::new(),
            step_limit,
            discounts: discounts
                .into_iter()
                .map(|discount| discount as f32)
                .collect(),
            scratch: Vec::new(),
        }
    }

    /// The hierarchy with what it has learned, and the primitive subtasks.
    #[must_use]
    pub fn into_parts(self) -> (Hierarchy, PrimitiveSet) {
        let hierarchy = Hierarchy::from_parts(self.hierarchy_tree, self.parameters.values);
        let hierarchy = hierarchy.unwrap_or_else(|| unreachable!("values keep their tree's shape"));
        (hierarchy, self.parameters.primitives)
    }

    /// Runs a whole trial of at most `step_limit` time steps; no more than the agent was
    /// made ready for.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn run_trial(
        &mut self,
        start: &W::Start,
        step_limit: u32,
        rng: &mut Stream,
        gate: &Gate,
    ) -> Result<Trial<W::State>, Stopped> {
        let step_limit = step_limit.min(self.step_limit);
        let mut trial = self.begin(start, rng);
        while !trial.done && trial.steps < step_limit {
            self.advance(&mut trial, step_limit, rng, &mut ());
            if trial.steps.is_multiple_of(Gate::STRIDE) {
                gate.pass(Gate::STRIDE)?;
            }
        }
        gate.pass(trial.steps % Gate::STRIDE)?;
        Ok(trial)
    }

    /// Begins a trial.
    pub fn begin(&mut self, start: &W::Start, rng: &mut Stream) -> Trial<W::State> {
        self.begin_in(self.world.begin(start, rng))
    }

    /// Begins a trial in a state.
    pub fn begin_in(&mut self, state: W::State) -> Trial<W::State> {
        self.visited.clear();
        self.stack.clear();
        self.stack.push(Frame {
            node: 0,
            child: 0,
            started: 0,
        });
        self.perceive(&state);
        Trial {
            state,
            steps: 0,
            done: self.now.state_type == self.world.catalogue().terminal(),
            reward: 0.0,
        }
    }

    /// One time step: choose down to an action, execute it, learn from where it led.
    ///
    /// When the trial reaches `step_limit`, or the limit that the agent was made ready
    /// for, all subtasks return as they are: that is a
    /// truncation, not a terminal state.
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
        if self.stack.len() > 1 {
            self.visited.push(self.parameters.encoder, &mut self.now);
            if let Some(percepts) = &mut self.visited.percepts {
                percepts.push(self.world.percept(&trial.state));
            }
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
            let map = self.parameters.plan.nodes[node].map;
            let features = self
                .parameters
                .encoder
                .encode(map, &mut self.before.features);
            let step = self.settings.learning_rate as f32 * (reward - value);
            self.parameters
                .primitives
                .at_mut(primitive)
                .learn(action, features, step);
            self.before.forget_values();
        }
        let limit = step_limit.min(self.step_limit);
        self.ascend(trial.steps >= limit, observer);
    }

    fn perceive(&mut self, state: &W::State) {
        let percept = self.world.percept(state);
        self.now
            .load(self.world.state_type(state), percept.as_ref());
    }

    /// Algorithm 2.4, line 10, from the innermost active subtask down to a primitive
    /// one: its node and its primitive.
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

    fn choose(&mut self, node: usize, rng: &mut Stream) -> Option<usize> {
        let choices = self.parameters.plan.choices(node, self.now.state_type);
        if let [] | [_] = choices {
            return choices.first().copied();
        }
        if self.settings.composite_choice == CompositeChoice::Random {
            return Some(choices[uniform(rng.random(), choices.len())]);
        }
        self.scratch.clear();
        for &child in choices {
            let value = self.parameters.projected_value(&mut self.now, child);
            let inside = self
                .parameters
                .completion(&mut self.now, node, child, Completion::Inside);
            self.scratch.push(value + inside);
        }
        let temperature = self.parameters.temperature(node);
        Some(choices[self.softmax.choose(&self.scratch, temperature, rng)])
    }
}
