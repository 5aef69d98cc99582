//! MAXQ-Q (Thesis Algorithm 2.4 with Eq. 3.2 to 3.9) on one hierarchy.
//!
//! The recursion of the algorithm is an explicit stack of the active composite
//! subtasks, so that a trial can be taken one time step at a time: paused, watched,
//! ended at any moment.

use rand::RngExt;

use super::gate::{Gate, Stopped};
use super::hierarchy::Hierarchy;
use super::linear;
use super::observe::{Observer, Update};
use super::plan::Plan;
use super::selection::{Softmax, uniform};
use super::situation::{Completion, Mind, Situation};
use super::skills::Skills;
use super::{CompositeValues, Encoder};
use crate::random::Stream;
use crate::scenario::{
    CompletionBootstrap, CompositeChoice, CoolOn, LearningModel, PrimitiveLearning, PseudoReward,
};
use crate::worlds::{MapId, StateType, World};

/// An active composite subtask.
#[derive(Clone, Copy, Debug)]
struct Frame {
    node: usize,
    /// The child that it has invoked last.
    child: usize,
    /// Length of the log when it did: the child's states start there.
    started: usize,
}

/// The states since the root's present child was invoked, most recent last
/// (`childSeq` of all active subtasks).
#[derive(Clone, Debug, Default)]
struct Log<P> {
    types: Vec<StateType>,
    /// Feature vectors for each map that a composite with composite children uses.
    features: Vec<(MapId, Vec<f32>)>,
    /// Percepts, where the bootstrap value is taken in the updated state.
    percepts: Option<Vec<P>>,
}

/// An agent: a hierarchy that acts in a world and learns.
#[derive(Clone, Debug)]
pub struct Agent<'r, W: World> {
    world: &'r W,
    model: &'r LearningModel,
    softmax: Softmax,
    mind: Mind<'r>,
    hierarchy_tree: crate::hierarchy::Tree,
    now: Situation,
    before: Situation,
    log: Log<W::Percept>,
    stack: Vec<Frame>,
    /// gamma^N for N = 0, 1, ...
    discounts: Vec<f32>,
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
}

impl<'r, W: World> Agent<'r, W> {
    /// An agent with a hierarchy and the primitive subtasks, ready for a trial of at
    /// most `step_limit` time steps.
    #[must_use]
    pub fn new(
        world: &'r W,
        encoder: &'r Encoder,
        model: &'r LearningModel,
        hierarchy: Hierarchy,
        skills: Skills,
        step_limit: u32,
    ) -> Self {
        let catalogue = world.catalogue();
        let (tree, values) = hierarchy.into_parts();
        let plan = Plan::new(&tree, catalogue, |map| encoder.width(map));
        let mind = Mind {
            encoder,
            plan,
            values,
            skills,
        };
        let situation = Situation::new(&mind, catalogue.terminal());
        let mut discounts = vec![1.0_f64];
        for power in 0..step_limit as usize {
            discounts.push(discounts[power] * model.discount);
        }
        Self {
            world,
            model,
            softmax: Softmax::new(model),
            log: Log::new(&mind.plan, model),
            mind,
            hierarchy_tree: tree,
            before: situation.clone(),
            now: situation,
            stack: Vec::new(),
            discounts: discounts
                .into_iter()
                .map(|discount| discount as f32)
                .collect(),
            scratch: Vec::new(),
        }
    }

    /// The hierarchy with what it has learned, and the primitive subtasks.
    #[must_use]
    pub fn into_parts(self) -> (Hierarchy, Skills) {
        let hierarchy = Hierarchy::from_parts(self.hierarchy_tree, self.mind.values);
        let hierarchy = hierarchy.unwrap_or_else(|| unreachable!("values keep their tree's shape"));
        (hierarchy, self.mind.skills)
    }

    /// Runs a whole trial of at most `step_limit` time steps.
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
        let mut trial = self.begin(start, rng);
        while !trial.done && trial.steps < step_limit {
            self.advance(&mut trial, step_limit, rng, &mut ());
            if trial.steps % Gate::STRIDE == 0 {
                gate.pass(Gate::STRIDE)?;
            }
        }
        gate.pass(trial.steps % Gate::STRIDE)?;
        Ok(trial)
    }

    /// Begins a trial.
    pub fn begin(&mut self, start: &W::Start, rng: &mut Stream) -> Trial<W::State> {
        let state = self.world.begin(start, rng);
        self.log.clear();
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
            done: false,
        }
    }

    /// One time step: choose down to an action, execute it, learn from where it led.
    ///
    /// When the trial reaches `step_limit` all subtasks return as they are: that is a
    /// truncation, not a terminal state.
    pub fn advance(
        &mut self,
        trial: &mut Trial<W::State>,
        step_limit: u32,
        rng: &mut Stream,
        observer: &mut impl Observer<W>,
    ) {
        let Some((node, skill)) = self.descend(rng, observer) else {
            return;
        };
        if self.stack.len() > 1 {
            self.log.push(self.mind.encoder, &mut self.now);
            if let Some(percepts) = &mut self.log.percepts {
                percepts.push(self.world.percept(&trial.state));
            }
        }
        let values = self.mind.action_values(&mut self.now, skill);
        let limit = self.model.temperature_limit as f32;
        let action = self.softmax.choose(values, limit, rng);
        let value = values[action];
        let subtask = self.mind.plan.nodes[node].subtask;
        let reward = self.world.step(&mut trial.state, subtask, action, rng);
        trial.steps += 1;
        observer.acted(node, action, reward, &trial.state);
        std::mem::swap(&mut self.now, &mut self.before);
        self.perceive(&trial.state);
        trial.done = self.now.state_type == self.world.catalogue().terminal();
        if self.model.primitive_learning == PrimitiveLearning::Shared {
            let map = self.mind.plan.nodes[node].map;
            let features = self.mind.encoder.encode(map, &mut self.before.features);
            let step = self.model.learning_rate as f32 * (reward - value);
            self.mind.skills.at_mut(skill).learn(action, features, step);
        }
        self.ascend(trial.steps >= step_limit, observer);
    }

    fn perceive(&mut self, state: &W::State) {
        let percept = self.world.percept(state);
        self.now
            .load(self.world.state_type(state), percept.as_ref());
    }

    /// Algorithm 2.4, line 10, from the innermost active subtask down to a primitive
    /// one: its node and its skill.
    fn descend(
        &mut self,
        rng: &mut Stream,
        observer: &mut impl Observer<W>,
    ) -> Option<(usize, usize)> {
        loop {
            let node = self.stack.last()?.node;
            let child = self.choose(node, rng)?;
            observer.chose(node, child);
            let started = self.log.types.len();
            let frame = self.stack.last_mut()?;
            frame.child = child;
            frame.started = started;
            if let Some(skill) = self.mind.plan.nodes[child].skill {
                return Some((child, skill));
            }
            self.stack.push(Frame {
                node: child,
                child,
                started,
            });
        }
    }

    fn choose(&mut self, node: usize, rng: &mut Stream) -> Option<usize> {
        let choices = self.mind.plan.choices(node, self.now.state_type);
        if let [] | [_] = choices {
            return choices.first().copied();
        }
        if self.model.composite_choice == CompositeChoice::Random {
            return Some(choices[uniform(rng.random(), choices.len())]);
        }
        self.scratch.clear();
        for &child in choices {
            let value = self.mind.projected_value(&mut self.now, child);
            let inside = self
                .mind
                .completion(&mut self.now, node, child, Completion::Inside);
            self.scratch.push(value + inside);
        }
        let temperature = self.mind.temperature(node);
        Some(choices[self.softmax.choose(&self.scratch, temperature, rng)])
    }

    /// Algorithm 2.4, lines 12 to 22, from the innermost active subtask up to the first
    /// that goes on.
    fn ascend(&mut self, truncated: bool, observer: &mut impl Observer<W>) {
        while let Some(&frame) = self.stack.last() {
            let terminal = !self.mind.plan.can_act(frame.node, self.now.state_type);
            self.learn(frame, terminal, observer);
            if self.stack.len() == 1 {
                self.log.clear();
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

    /// Lines 13 to 19: updates C~ and C of the child that returned, for all states
    /// visited meanwhile, the most recent first.
    ///
    /// The bootstrap values are computed once, before the first update.
    fn learn(&mut self, frame: Frame, terminal: bool, observer: &mut impl Observer<W>) {
        let Frame { node, child, .. } = frame;
        let mind = &mut self.mind;
        let pseudo_reward = pseudo_reward(
            self.model.pseudo_reward,
            mind.plan.nodes[node].goal.contains(self.now.state_type),
            terminal,
        );
        let (mut inside, mut outside, mut best) = (0.0, 0.0, None);
        if !terminal {
            let (a_star, projected) = mind.best_child(&mut self.now, node);
            inside = mind.completion(&mut self.now, node, a_star, Completion::Inside);
            outside = projected + mind.completion(&mut self.now, node, a_star, Completion::Outside);
            match self.model.completion_bootstrap {
                CompletionBootstrap::NextState => inside += projected,
                CompletionBootstrap::AsPrinted => best = Some(a_star),
            }
        }
        inside += pseudo_reward;
        let alpha = self.model.learning_rate as f32;
        let plan = mind.plan.nodes[node];
        if mind.plan.nodes[child].skill.is_some() {
            let before = &mut self.before;
            if let Some(a_star) = best.filter(|&a| mind.plan.can_act(a, before.state_type)) {
                inside += mind.projected_value(before, a_star);
            }
            let error_inside = self.discounts[1] * inside
                - mind.completion(before, node, child, Completion::Inside);
            let error_outside = self.discounts[1] * outside
                - mind.completion(before, node, child, Completion::Outside);
            let at = mind.plan.block(child, node, before.state_type);
            let features = mind.encoder.encode(plan.map, &mut before.features);
            if let Some(values) = &mut mind.values[node] {
                let [first, second] = values.blocks(at, plan.vector, plan.stride);
                linear::learn(first, features, alpha * error_inside);
                linear::learn(second, features, alpha * error_outside);
            }
            observer.updated(Update {
                node,
                child,
                state_type: before.state_type,
                steps: 1,
                error_inside,
                error_outside,
            });
        } else {
            let states = self.log.types.len();
            for index in (frame.started..states).rev() {
                let state_type = self.log.types[index];
                let steps = states - index;
                let mut inside = inside;
                if let Some(a_star) = best.filter(|&a| mind.plan.can_act(a, state_type))
                    && let Some(percepts) = &self.log.percepts
                {
                    self.before.load(state_type, percepts[index].as_ref());
                    inside += mind.projected_value(&mut self.before, a_star);
                }
                let at = mind.plan.block(child, node, state_type);
                let features = self.log.features(plan.map, index, plan.stride);
                let Some(values) = &mut mind.values[node] else {
                    continue;
                };
                let discount = self.discounts[steps];
                let [first, second] = values.blocks(at, plan.vector, plan.stride);
                let error_inside = discount * inside - linear::value(first, features);
                let error_outside = discount * outside - linear::value(second, features);
                linear::learn(first, features, alpha * error_inside);
                linear::learn(second, features, alpha * error_outside);
                observer.updated(Update {
                    node,
                    child,
                    state_type,
                    steps,
                    error_inside,
                    error_outside,
                });
            }
        }
        self.now.forget(&self.mind.plan, child);
    }

    /// The temperature falls after line 22, never below its limit (Thesis 3.1).
    fn cool(&mut self, node: usize, observer: &mut impl Observer<W>) {
        let at_goal = self.mind.plan.nodes[node]
            .goal
            .contains(self.now.state_type);
        observer.terminated(node, at_goal);
        if self.model.cool_on == CoolOn::Goal && !at_goal {
            return;
        }
        if let Some(values) = &mut self.mind.values[node] {
            let cooled = values.temperature * self.model.temperature_decrease as f32;
            values.temperature = cooled.max(self.model.temperature_limit as f32);
        }
    }
}

/// The pseudo-reward of a transition (Thesis Definition 2.1): 0 into a goal state, -1
/// into another terminal state; under `all`, -1 into every state that is no goal.
fn pseudo_reward(rule: PseudoReward, at_goal: bool, terminal: bool) -> f32 {
    let punished = !at_goal && (terminal || rule == PseudoReward::All);
    if punished { -1.0 } else { 0.0 }
}

impl CompositeValues {
    /// The block at an offset in C~, and the same block in C.
    #[inline(always)]
    fn blocks(&mut self, at: usize, vector: usize, stride: usize) -> [&mut [f32]; 2] {
        let (first, second) = self.parameters[at..].split_at_mut(vector);
        [&mut first[..stride], &mut second[..stride]]
    }
}

impl<P> Log<P> {
    fn new(plan: &Plan, model: &LearningModel) -> Self {
        let mut maps: Vec<MapId> = Vec::new();
        for node in plan.nodes.iter().filter(|node| node.skill.is_none()) {
            if let Some(parent) = node.parent
                && !maps.contains(&plan.nodes[parent].map)
            {
                maps.push(plan.nodes[parent].map);
            }
        }
        Self {
            types: Vec::new(),
            features: maps.into_iter().map(|map| (map, Vec::new())).collect(),
            percepts: (model.completion_bootstrap == CompletionBootstrap::AsPrinted).then(Vec::new),
        }
    }

    fn clear(&mut self) {
        self.types.clear();
        for (_, features) in &mut self.features {
            features.clear();
        }
        if let Some(percepts) = &mut self.percepts {
            percepts.clear();
        }
    }

    #[inline]
    fn push(&mut self, encoder: &Encoder, now: &mut Situation) {
        self.types.push(now.state_type);
        for (map, features) in &mut self.features {
            features.extend_from_slice(encoder.encode(*map, &mut now.features));
        }
    }

    #[inline(always)]
    fn features(&self, map: MapId, index: usize, stride: usize) -> &[f32] {
        let logged = self.features.iter().find(|(logged, _)| *logged == map);
        logged.map_or(&[], |(_, features)| &features[index * stride..][..stride])
    }
}
