//! A second MAXQ-Q: slow, plain, recursive, in double precision.
//!
//! [`MaxqQ`] is Thesis Algorithm 2.4 with Eq. 3.2 to 3.9, the corrections listed in
//! `src/learning/README.md` and the options beyond the thesis, line by line with the symbols of
//! the pseudo-code. Each value is computed from scratch by Algorithm 2.5 whenever it is needed.
//! It shares only the tree type and the settings with the library. It does not act: it replays
//! the actions of an agent.

mod lab;
mod replay;
mod subtasks;
mod targets;
mod values;

use std::rc::Rc;

pub use lab::{Lab, STEP_LIMIT};
pub use replay::{Event, Recorder};
pub use subtasks::{DELIVERED, Row, row};

use maxq_lab::hierarchy::Tree;
use maxq_lab::learning::{Hierarchy, PrimitiveSet};
use maxq_lab::scenario::{CoolOn, LearningSettings, PrimitiveLearning};
use maxq_lab::worlds::Catalogue;
use maxq_lab::worlds::foraging::FeatureSettings;
use subtasks::{Input, Kind, REMEMBERS, phi};
use values::{double, learn};

/// When C~(i, s', a*) of lines 16 and 17 is read.
///
/// Inside the loop of line 15 an update can change it only if a* is the child a that
/// returned. A child that terminated cannot act in s', so it is not a*. The two readings
/// differ only in a trial truncated at the step limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// Once, before the loop, with the values at the time when the child returned.
    BeforeTheLoop,
    /// Again for every state of childSeq, as the pseudo-code reads literally.
    InTheLoop,
}

/// A state: its type, numbered from 1, and its features for all inputs.
#[derive(Clone, Debug)]
pub struct State {
    /// Type of Table 4.1, numbered from 1; [`DELIVERED`] at the end.
    pub state_type: usize,
    /// Whether the robot remembers the place that its task needs.
    remembers: bool,
    proximity: Vec<f64>,
    target: Vec<f64>,
    approach: Vec<f64>,
    turn: Vec<f64>,
}

impl State {
    /// The state of this type in which the agent perceives `percept`.
    pub fn new(state_type: usize, percept: &[f32], model: &FeatureSettings) -> Self {
        Self {
            state_type,
            remembers: percept[REMEMBERS] == 1.0,
            proximity: phi(Input::Proximity, percept, model),
            target: phi(Input::Target, percept, model),
            approach: phi(Input::Approach, percept, model),
            turn: phi(Input::Turn, percept, model),
        }
    }

    fn phi(&self, input: Input) -> &[f64] {
        match input {
            Input::Proximity => &self.proximity,
            Input::Target => &self.target,
            Input::Approach => &self.approach,
            Input::Turn => &self.turn,
            Input::Nothing => &[1.0],
        }
    }
}

/// A visited state, and the reward of the time step from it as composite subtasks count it.
#[derive(Clone, Debug)]
struct Visit {
    s: Rc<State>,
    r: f64,
}

/// A child a that returned to i in s', and the states that it visited, most recent first.
#[derive(Clone, Debug)]
struct Decision {
    i: usize,
    a: usize,
    child_seq: Vec<Visit>,
    s_next: Rc<State>,
}

/// Counts of what a replay met, so that a test can show that it tested something.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// Updates compared.
    pub updates: usize,
    /// Those of them that were repeated after their trial.
    pub repeated: usize,
    /// Updates of states more than one step before the child's termination.
    pub distant_updates: usize,
    /// Those of them in which rewards of later steps were counted.
    pub later_rewards: usize,
    /// Transitions with a pseudo-reward of -1.
    pub pseudo_rewards: usize,
    /// Exits whose value was that of an ancestor.
    pub continuations: usize,
    /// Time steps in which Recall acted, with a remembered place and without one.
    pub recalled: [usize; 2],
    /// Time steps in which a command acted.
    pub commands: usize,
    /// Trials truncated at the step limit.
    pub truncated: usize,
    /// Trials that ended with a delivery.
    pub delivered: usize,
    /// Times that rounding decided: a* was one of several children with nearly equal values, or
    /// the largest probability was nearly the limit.
    pub ties: usize,
    /// The largest difference from an error of the agent.
    pub worst_error: f64,
}

impl Seen {
    /// Adds other counts.
    pub fn add(&mut self, other: &Self) {
        self.updates += other.updates;
        self.repeated += other.repeated;
        self.distant_updates += other.distant_updates;
        self.later_rewards += other.later_rewards;
        self.pseudo_rewards += other.pseudo_rewards;
        self.continuations += other.continuations;
        self.recalled = [0, 1].map(|case| self.recalled[case] + other.recalled[case]);
        self.commands += other.commands;
        self.truncated += other.truncated;
        self.delivered += other.delivered;
        self.ties += other.ties;
        self.worst_error = self.worst_error.max(other.worst_error);
    }
}

/// A hierarchy and the primitive subtasks, learning by MAXQ-Q.
#[derive(Clone, Debug)]
pub struct MaxqQ<'a> {
    tree: &'a Tree,
    /// The table row of each node.
    rows: Vec<Row>,
    model: &'a LearningSettings,
    /// Whether the robot has a memory.
    memory: bool,
    /// theta^C~ of each node's parent for it; one block a state type of the parent.
    pub theta_c_tilde: Vec<Vec<f64>>,
    /// theta^C of each node's parent for it.
    pub theta_c: Vec<Vec<f64>>,
    /// theta^Qprim of each primitive subtask and action.
    pub theta_q: Vec<Vec<Vec<f64>>>,
    /// The names of the primitive subtasks, in the order of `theta_q`.
    primitives: Vec<String>,
    /// The name of each node's subtask.
    names: Vec<String>,
    /// Temperature of each node.
    pub tau: Vec<f64>,
    reading: Reading,
    /// The decisions of the trial, in the order in which they ended.
    decisions: Vec<Decision>,
    replayed: Vec<Event>,
    next: usize,
    steps_left: u32,
    /// Counts of what the replay met so far.
    pub seen: Seen,
}

impl<'a> MaxqQ<'a> {
    /// The learner with the values that `hierarchy` and `primitives` have.
    pub fn new(
        hierarchy: &'a Hierarchy,
        primitives: &PrimitiveSet,
        catalogue: &Catalogue,
        model: &'a LearningSettings,
        reading: Reading,
    ) -> Self {
        let tree = hierarchy.tree();
        let nodes = 0..tree.nodes().len();
        let name = |i| tree.subtask(i).name(catalogue).to_owned();
        let names: Vec<_> = nodes.clone().map(name).collect();
        let all = primitives.all().iter();
        let mut reference = Self {
            tree,
            rows: names.iter().map(|name| row(name)).collect(),
            model,
            memory: catalogue.find("Recall").is_some(),
            theta_c_tilde: vec![Vec::new(); nodes.len()],
            theta_c: vec![Vec::new(); nodes.len()],
            theta_q: all
                .clone()
                .map(|primitive| primitive.vectors().map(double).collect())
                .collect(),
            primitives: all
                .map(|primitive| primitive.subtask.name(catalogue).to_owned())
                .collect(),
            names,
            tau: vec![0.0; nodes.len()],
            reading,
            decisions: Vec::new(),
            replayed: Vec::new(),
            next: 0,
            steps_left: 0,
            seen: Seen::default(),
        };
        for i in nodes {
            if let Some(values) = &hierarchy.values()[i] {
                reference.tau[i] = f64::from(values.temperature);
                for (child, [c_tilde, c]) in tree.children(i).zip(values.vectors()) {
                    reference.theta_c_tilde[child] = double(&c_tilde);
                    reference.theta_c[child] = double(&c);
                }
            }
        }
        reference
    }

    /// Replays one trial from its first state.
    pub fn replay(&mut self, start: State, events: Vec<Event>, step_limit: u32) {
        self.replayed = events;
        self.next = 0;
        self.steps_left = step_limit;
        self.decisions.clear();
        let (_, last) = self.maxq_q(0, Rc::new(start));
        self.repeat();
        if self.model.cool_on == CoolOn::Trial {
            for i in 0..self.rows.len() {
                self.cool(i);
            }
        }
        assert_eq!(self.next, self.replayed.len(), "the agent did more");
        match last.state_type {
            DELIVERED => self.seen.delivered += 1,
            _ => self.seen.truncated += 1,
        }
    }

    /// Algorithm 2.4: the states visited while executing i, most recent first, and the
    /// state in which i returned.
    fn maxq_q(&mut self, i: usize, mut s: Rc<State>) -> (Vec<Visit>, Rc<State>) {
        if self.rows[i].is_primitive() {
            return self.act(i, s);
        }
        let mut seq = Vec::new();
        // 9: while T_i(s) is false; at the step limit all subtasks return.
        while !self.terminal(i, &s) && self.steps_left > 0 {
            let a = self.chosen(i, &s);
            let (mut child_seq, s_next) = self.maxq_q(a, s);
            let decision = Decision {
                i,
                a,
                child_seq: child_seq.clone(),
                s_next: s_next.clone(),
            };
            self.update(&decision);
            self.decisions.push(decision);
            // 20: append childSeq onto the front of seq.
            child_seq.append(&mut seq);
            seq = child_seq;
            s = s_next;
        }
        if self.terminal(i, &s) {
            let at_goal = self.terminated(i, &s);
            match self.model.cool_on {
                CoolOn::Termination => self.cool(i),
                CoolOn::Goal if at_goal => self.cool(i),
                CoolOn::Goal | CoolOn::Trial => {}
            }
        }
        (seq, s)
    }

    /// Lines 4 to 6 of a primitive subtask, for as many time steps as it persists: up to the
    /// setting's number, while the state type stays and the trial goes on.
    fn act(&mut self, i: usize, mut s: Rc<State>) -> (Vec<Visit>, Rc<State>) {
        let mut seq = Vec::new();
        let state_type = s.state_type;
        for _ in 0..self.model.persistence {
            // 4: execute i, receive r, and observe next state s'.
            let (action, r, s_next) = self.executed(i);
            self.count_act(i, &s);
            // 5, Eq. 3.6; by default the primitive subtasks are frozen.
            let learns = self.rows[i].kind != Kind::Recall;
            if learns && self.model.primitive_learning == PrimitiveLearning::Shared {
                let error = r - self.q_prim(i, &s)[action];
                let features = s.phi(self.rows[i].input);
                let place = self.place(&self.names[i]);
                let theta = &mut self.theta_q[place][action];
                learn(theta, self.model.learning_rate * error, features, 0);
            }
            let r = self.per_step().unwrap_or(r);
            seq.insert(0, Visit { s, r });
            self.steps_left -= 1;
            s = Rc::new(s_next);
            if s.state_type != state_type || self.steps_left == 0 {
                break;
            }
        }
        (seq, s)
    }

    fn count_act(&mut self, i: usize, s: &State) {
        match self.rows[i].kind {
            Kind::Command => self.seen.commands += 1,
            Kind::Recall => self.seen.recalled[usize::from(!s.remembers)] += 1,
            Kind::Composite { .. } | Kind::Behaviour => {}
        }
    }

    /// Repeats the updates of the finished trial, that of the decision which ended last first.
    fn repeat(&mut self) {
        if self.model.replay > 0 {
            assert_eq!(self.take(), Event::Replays);
        }
        let decisions = std::mem::take(&mut self.decisions);
        let before = self.seen.updates;
        for _ in 0..self.model.replay {
            for decision in decisions.iter().rev() {
                self.update(decision);
            }
        }
        self.seen.repeated += self.seen.updates - before;
    }

    /// After line 22.
    fn cool(&mut self, i: usize) {
        if !self.rows[i].is_primitive() {
            let cooled = self.tau[i] * self.model.temperature_decrease;
            self.tau[i] = cooled.max(self.model.temperature_limit);
        }
    }
}
