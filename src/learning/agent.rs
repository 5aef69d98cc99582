//! An agent and its trials. What happens in a time step is in `maxq_q`.

use super::Encoder;
use super::gate::{Gate, Stopped};
use super::hierarchy::Hierarchy;
use super::history::History;
use super::plan::Plan;
use super::primitives::PrimitiveSet;
use super::state_values::{Parameters, StateValues};
use crate::hierarchy::Tree;
use crate::random::Stream;
use crate::scenario::LearningSettings;
use crate::worlds::{StateType, World};

/// A call of the recursion: an active composite subtask.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) node: usize,
    /// The child that it invoked last.
    pub(super) child: usize,
    /// The length of the list of visited states when that child was invoked: its
    /// `childSeq` starts there.
    pub(super) started: usize,
}

/// An agent: a hierarchy that acts in a world and learns by MAXQ-Q (Thesis Algorithm 2.4).
#[derive(Clone, Debug)]
pub struct Agent<'r, W: World> {
    pub(super) world: &'r W,
    pub(super) settings: &'r LearningSettings,
    pub(super) parameters: Parameters<'r>,
    tree: Tree,
    /// The present state.
    pub(super) now: StateValues,
    /// The state before the last time step.
    pub(super) before: StateValues,
    pub(super) history: History,
    /// Time steps for which the primitive subtask that acts may go on without being chosen again.
    pub(super) persists: u32,
    pub(super) stack: Vec<Frame>,
    pub(super) step_limit: u32,
    /// gamma^N for N = 0, 1, ... up to the step limit.
    pub(super) discounts: Vec<f32>,
    /// Room for the targets of updates.
    pub(super) targets: Vec<[f32; 2]>,
}

/// A trial, running or ended.
#[derive(Clone, Debug)]
pub struct Trial<S> {
    /// The state of the world.
    pub state: S,
    /// Time steps so far.
    pub steps: u32,
    /// Whether the task is done.
    pub done: bool,
    /// The sum of the rewards.
    pub reward: f64,
}

/// One update of C~(i, s, a) and C(i, s, a) (Thesis Eq. 3.4, 3.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Update {
    /// The composite node i.
    pub node: usize,
    /// Its child a.
    pub child: usize,
    /// Type of the updated state s.
    pub state_type: StateType,
    /// Time steps N from s to the child's termination.
    pub steps: usize,
    /// What i learned of the child's last state beyond its own values there: the pseudo-reward,
    /// or what its exit is worth.
    pub exit: f32,
    /// Target minus value of C~.
    pub error_inside: f32,
    /// Target minus value of C.
    pub error_outside: f32,
}

/// Watches an agent. It cannot change what the agent does.
///
/// The default observer `()` sees nothing and costs nothing.
pub trait Observer<W: World> {
    /// A composite node chose a child.
    fn chose(&mut self, _node: usize, _child: usize) {}
    /// A primitive node executed an action that earned `reward` and led to `state`.
    fn acted(&mut self, _node: usize, _action: usize, _reward: f32, _state: &W::State) {}
    /// A composite node learned.
    fn updated(&mut self, _update: Update) {}
    /// A composite node terminated, at its goal or not.
    fn terminated(&mut self, _node: usize, _at_goal: bool) {}
    /// The trial is over, and its updates are repeated from here on.
    fn replays(&mut self) {}
}

impl<W: World> Observer<W> for () {}

impl<'r, W: World> Agent<'r, W> {
    /// Makes an agent of a hierarchy and a primitive set, for trials of at most
    /// `step_limit` time steps.
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
        let parameters = Parameters::new(encoder, settings, plan, values, primitives);
        let now = StateValues::new(&parameters, catalogue.terminal());
        let powers = std::iter::successors(Some(1.0_f64), |power| Some(power * settings.discount));
        let discounts = powers.map(|power| power as f32);
        Self {
            world,
            settings,
            history: History::new(&parameters.plan, settings),
            persists: 0,
            parameters,
            tree,
            before: now.clone(),
            now,
            stack: Vec::new(),
            step_limit,
            discounts: discounts.take(step_limit as usize + 1).collect(),
            targets: Vec::new(),
        }
    }

    /// Returns the hierarchy and the primitive set with all that they have learned.
    #[must_use]
    pub fn into_parts(self) -> (Hierarchy, PrimitiveSet) {
        let hierarchy = Hierarchy::from_parts(self.tree, self.parameters.values);
        let hierarchy = hierarchy.unwrap_or_else(|| unreachable!("values keep their tree's shape"));
        (hierarchy, self.parameters.primitives)
    }

    /// Runs a whole trial of at most `step_limit` time steps. The limit given to
    /// [`Agent::new`] holds too.
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

    /// Begins a trial in a given state.
    pub fn begin_in(&mut self, state: W::State) -> Trial<W::State> {
        self.history.forget_trial();
        self.persists = 0;
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
            done: self.now.situation.state_type == self.world.catalogue().terminal(),
            reward: 0.0,
        }
    }

    pub(super) fn perceive(&mut self, state: &W::State) {
        let percept = self.world.percept(state);
        let state_type = self.world.state_type(state);
        let situation = self.parameters.plan.situation(state_type, percept.as_ref());
        self.now.load(situation, percept.as_ref());
    }
}
