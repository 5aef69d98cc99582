//! MAXQ-Q (Thesis Algorithm 2.4 with Eq. 3.2 to 3.9) on one hierarchy.
//!
//! The recursion of the algorithm is an explicit stack of the active composite
//! subtasks, so that a trial can be taken one time step at a time: paused, watched,
//! ended at any moment.

use std::ops::Range;

use rand::RngExt;

use super::Encoder;
use super::gate::{Gate, Stopped};
use super::hierarchy::Hierarchy;
use super::linear::Replay;
use super::observe::{Observer, Update};
use super::plan::Plan;
use super::selection::{Softmax, uniform};
use super::situation::{Completion, Mind, Situation};
use super::skills::Skills;
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
    features: Vec<LoggedFeatures>,
    /// Percepts, where the bootstrap value is taken in the updated state.
    percepts: Option<Vec<P>>,
}

/// The feature vectors of one map, one state after the other.
#[derive(Clone, Debug)]
struct LoggedFeatures {
    map: MapId,
    width: usize,
    vectors: Vec<f32>,
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
            if trial.steps.is_multiple_of(Gate::STRIDE) {
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
        let Frame {
            node,
            child,
            started,
        } = frame;
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
        let map = mind.plan.nodes[node].map;
        if mind.plan.nodes[child].skill.is_some() {
            let before = &mut self.before;
            let state_type = before.state_type;
            if let Some(a_star) = best.filter(|&a| mind.plan.can_act(a, state_type)) {
                inside += mind.projected_value(before, a_star);
            }
            let features = mind.encoder.encode(map, &mut before.features);
            let lesson = Lesson {
                state_type,
                features,
                steps: 1,
                discounts: &self.discounts[1..2],
                targets: [inside, outside],
                learning_rate: self.model.learning_rate as f32,
            };
            mind.study(node, child, lesson, observer);
        } else {
            let states = self.log.types.len();
            let mut end = states;
            while end > started {
                let state_type = self.log.types[end - 1];
                let alike = self.log.types[started..end].iter().rev();
                let mut begin = end - alike.take_while(|&&t| t == state_type).count();
                let mut inside = inside;
                if let Some(a_star) = best {
                    // The bootstrap value is another one in each state.
                    begin = end - 1;
                    if mind.plan.can_act(a_star, state_type)
                        && let Some(percepts) = &self.log.percepts
                    {
                        self.before.load(state_type, percepts[begin].as_ref());
                        inside += mind.projected_value(&mut self.before, a_star);
                    }
                }
                let steps = states - end + 1;
                let lesson = Lesson {
                    state_type,
                    features: self.log.features(map, begin..end),
                    steps,
                    discounts: &self.discounts[steps..=states - begin],
                    targets: [inside, outside],
                    learning_rate: self.model.learning_rate as f32,
                };
                mind.study(node, child, lesson, observer);
                end = begin;
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

/// What is to be learned in successive states of one type.
struct Lesson<'a> {
    state_type: StateType,
    /// Of the composite subtask's map, the most recent state last.
    features: &'a [f32],
    /// N in the most recent state.
    steps: usize,
    /// gamma^N, the most recent state first.
    discounts: &'a [f32],
    /// What C~ and C are to be where N = 0.
    targets: [f32; 2],
    learning_rate: f32,
}

impl Mind<'_> {
    /// Updates C~ and C of a composite node for a child.
    #[inline(always)]
    fn study<W: World>(
        &mut self,
        node: usize,
        child: usize,
        lesson: Lesson<'_>,
        observer: &mut impl Observer<W>,
    ) {
        let Some(values) = &mut self.values[node] else {
            return;
        };
        let plan = &self.plan.nodes[node];
        let at = self.plan.block(child, lesson.state_type);
        let (first, second) = values.parameters[at..].split_at_mut(plan.vector);
        let replay = Replay {
            parameters: [&mut first[..plan.stride], &mut second[..plan.stride]],
            features: lesson.features,
            discounts: lesson.discounts,
            targets: lesson.targets,
            learning_rate: lesson.learning_rate,
            watch: |recent, [error_inside, error_outside]: [f32; 2]| {
                observer.updated(Update {
                    node,
                    child,
                    state_type: lesson.state_type,
                    steps: lesson.steps + recent,
                    error_inside,
                    error_outside,
                });
            },
        };
        replay.run();
    }
}

impl<P> Log<P> {
    fn new(plan: &Plan, model: &LearningModel) -> Self {
        let mut features: Vec<LoggedFeatures> = Vec::new();
        for node in plan.nodes.iter().filter(|node| node.skill.is_none()) {
            let Some(parent) = node.parent.map(|parent| &plan.nodes[parent]) else {
                continue;
            };
            if features.iter().all(|logged| logged.map != parent.map) {
                features.push(LoggedFeatures {
                    map: parent.map,
                    width: parent.stride,
                    vectors: Vec::new(),
                });
            }
        }
        Self {
            types: Vec::new(),
            features,
            percepts: (model.completion_bootstrap == CompletionBootstrap::AsPrinted).then(Vec::new),
        }
    }

    fn clear(&mut self) {
        self.types.clear();
        for logged in &mut self.features {
            logged.vectors.clear();
        }
        if let Some(percepts) = &mut self.percepts {
            percepts.clear();
        }
    }

    #[inline]
    fn push(&mut self, encoder: &Encoder, now: &mut Situation) {
        self.types.push(now.state_type);
        for logged in &mut self.features {
            let features = encoder.encode(logged.map, &mut now.features);
            logged.vectors.extend_from_slice(features);
        }
    }

    /// The feature vectors of some states, one after the other.
    #[inline(always)]
    fn features(&self, map: MapId, states: Range<usize>) -> &[f32] {
        let logged = self.features.iter().find(|logged| logged.map == map);
        logged.map_or(&[], |logged| {
            &logged.vectors[states.start * logged.width..states.end * logged.width]
        })
    }
}
