//! A second MAXQ-Q: slow, plain, recursive, in double precision.
//!
//! [`MaxqQ`] is Thesis Algorithm 2.4 with Eq. 3.2 to 3.9 and the corrections listed in
//! `src/learning/README.md`, line by line with the symbols of the pseudo-code. Each value is
//! computed from scratch by Algorithm 2.5 whenever it is needed. It shares only the tree type
//! and the settings with the library. It does not act: it replays the actions of an agent.

mod lab;
mod replay;
mod subtasks;

pub use lab::{Lab, STEP_LIMIT};
pub use replay::{Event, Recorder};
pub use subtasks::{DELIVERED, Row, row};

use maxq_lab::hierarchy::Tree;
use maxq_lab::learning::{Hierarchy, PrimitiveSet, Update};
use maxq_lab::scenario::{CoolOn, LearningSettings, PrimitiveLearning, PseudoReward};
use maxq_lab::worlds::Catalogue;
use maxq_lab::worlds::foraging::FeatureSettings;
use subtasks::{Input, phi};

/// Children whose values differ by less than this can be swapped by rounding in single
/// precision. Then a* is the one that the agent took.
const TIE: f64 = 2e-4;

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
        }
    }
}

/// Counts of what a replay met, so that a test can show that it tested something.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// Updates compared.
    pub updates: usize,
    /// Updates of states more than one step before the child's termination.
    pub distant_updates: usize,
    /// Transitions with a pseudo-reward of -1.
    pub pseudo_rewards: usize,
    /// Trials truncated at the step limit.
    pub truncated: usize,
    /// Trials that ended with a delivery.
    pub delivered: usize,
    /// Times that a* was one of several children with nearly equal values.
    pub ties: usize,
    /// The largest difference from an error of the agent.
    pub worst_error: f64,
}

/// A hierarchy and the primitive subtasks, learning by MAXQ-Q.
#[derive(Clone, Debug)]
pub struct MaxqQ<'a> {
    tree: &'a Tree,
    /// The table row of each node.
    rows: Vec<Row>,
    model: &'a LearningSettings,
    /// theta^C~ of each node's parent for it; one block a state type of the parent.
    pub theta_c_tilde: Vec<Vec<f64>>,
    /// theta^C of each node's parent for it.
    pub theta_c: Vec<Vec<f64>>,
    /// theta^Qprim of each primitive subtask and action.
    pub theta_q: Vec<Vec<Vec<f64>>>,
    /// The place of each node's subtask in `theta_q`.
    primitive: Vec<usize>,
    /// Temperature of each node.
    pub tau: Vec<f64>,
    reading: Reading,
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
        let mut reference = Self {
            tree,
            rows: nodes
                .clone()
                .map(|i| row(tree.subtask(i).name(catalogue)))
                .collect(),
            model,
            theta_c_tilde: vec![Vec::new(); nodes.len()],
            theta_c: vec![Vec::new(); nodes.len()],
            theta_q: primitives
                .all()
                .iter()
                .map(|primitive| primitive.vectors().map(double).collect())
                .collect(),
            primitive: nodes
                .clone()
                .map(|i| {
                    let position = catalogue.primitives().position(|p| p == tree.subtask(i));
                    position.unwrap_or(usize::MAX)
                })
                .collect(),
            tau: vec![0.0; nodes.len()],
            reading,
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
        let (_, last) = self.maxq_q(0, start);
        assert_eq!(self.next, self.replayed.len(), "the agent did more");
        match last.state_type {
            DELIVERED => self.seen.delivered += 1,
            _ => self.seen.truncated += 1,
        }
    }

    /// Algorithm 2.4: the states visited while executing i, most recent first, and the
    /// state in which i returned.
    fn maxq_q(&mut self, i: usize, mut s: State) -> (Vec<State>, State) {
        let mut seq = Vec::new();
        if self.rows[i].primitive {
            // 4: execute i, receive r, and observe next state s'.
            let (action, r, s_next) = self.executed(i);
            // 5, Eq. 3.6; by default the primitive subtasks are frozen.
            if self.model.primitive_learning == PrimitiveLearning::Shared {
                let error = r - self.q_prim(i, &s)[action];
                let features = s.phi(self.rows[i].input);
                let theta = &mut self.theta_q[self.primitive[i]][action];
                learn(theta, self.model.learning_rate * error, features, 0);
            }
            seq.insert(0, s);
            self.steps_left -= 1;
            return (seq, s_next);
        }
        // 9: while T_i(s) is false; at the step limit all subtasks return.
        while !self.terminal(i, &s) && self.steps_left > 0 {
            let a = self.chosen(i, &s);
            let (mut child_seq, s_next) = self.maxq_q(a, s);
            self.update(i, a, &child_seq, &s_next);
            // 20: append childSeq onto the front of seq.
            child_seq.append(&mut seq);
            seq = child_seq;
            s = s_next;
        }
        if self.terminal(i, &s) {
            self.cool(i, &s);
        }
        (seq, s)
    }

    /// Lines 13 to 19.
    fn update(&mut self, i: usize, a: usize, child_seq: &[State], s_next: &State) {
        let alpha = self.model.learning_rate;
        let gamma = self.model.discount;
        let pseudo_reward = self.pseudo_reward(i, s_next);
        let a_star = self.argmax(i, a, child_seq, s_next);
        let before = self.bootstrap(i, a_star, s_next);
        // N: 1 for the last visited state, the length of childSeq for the first.
        for (n, s) in (1..).zip(child_seq) {
            let [next_c_tilde, next_c] = match self.reading {
                Reading::BeforeTheLoop => before,
                Reading::InTheLoop => self.bootstrap(i, a_star, s_next),
            };
            let discount = gamma.powi(n);
            // 16, Eq. 3.4.
            let error_inside = discount * (pseudo_reward + next_c_tilde) - self.c_tilde(i, s, a);
            // 17, Eq. 3.5.
            let error_outside = discount * next_c - self.c(i, s, a);
            let (features, at) = self.features(i, s);
            learn(
                &mut self.theta_c_tilde[a],
                alpha * error_inside,
                features,
                at,
            );
            learn(&mut self.theta_c[a], alpha * error_outside, features, at);
            self.compare(i, a, s, n, [error_inside, error_outside]);
        }
    }

    /// C~(i, s', a*) + V(a*, s') and C(i, s', a*) + V(a*, s'); 0 if s' is terminal.
    fn bootstrap(&self, i: usize, a_star: Option<usize>, s_next: &State) -> [f64; 2] {
        let Some(a_star) = a_star else {
            return [0.0; 2];
        };
        let v = self.v(a_star, s_next);
        [
            self.c_tilde(i, s_next, a_star) + v,
            self.c(i, s_next, a_star) + v,
        ]
    }

    /// 13: a* maximises C~(i, s', a') + V(a', s') over the children that can act in s',
    /// the first of equals.
    fn argmax(&mut self, i: usize, a: usize, seq: &[State], s_next: &State) -> Option<usize> {
        let values = self.choices(i, s_next);
        let highest = values
            .iter()
            .map(|&(_, value)| value)
            .fold(f64::MIN, f64::max);
        let near = values.iter().filter(|(_, value)| highest - value < TIE);
        let near: Vec<usize> = near.map(|&(child, _)| child).collect();
        if near.len() < 2 {
            return near.first().copied();
        }
        self.seen.ties += 1;
        let recorded = self.peek_update();
        let discount = self.model.discount;
        let distance = |&a_star: &usize| {
            let [_, next_c] = self.bootstrap(i, Some(a_star), s_next);
            let error_outside = discount * next_c - self.c(i, &seq[0], a);
            (error_outside - f64::from(recorded.error_outside)).abs()
        };
        near.iter()
            .copied()
            .min_by(|x, y| distance(x).total_cmp(&distance(y)))
    }

    /// The children that can act in a state with C~(i, s, a) + V(a, s).
    pub fn choices(&self, i: usize, s: &State) -> Vec<(usize, f64)> {
        let able = self.tree.children(i).filter(|&a| !self.terminal(a, s));
        able.filter(|_| !self.terminal(i, s))
            .map(|a| (a, self.c_tilde(i, s, a) + self.v(a, s)))
            .collect()
    }

    /// Algorithm 2.5 with Eq. 3.2.
    pub fn v(&self, i: usize, s: &State) -> f64 {
        if self.rows[i].primitive {
            return self.q_prim(i, s).into_iter().fold(f64::MIN, f64::max);
        }
        let mut best = None;
        for j in self.tree.children(i).filter(|&j| !self.terminal(j, s)) {
            let value = self.v(j, s) + self.c_tilde(i, s, j);
            if best.is_none_or(|(_, highest)| value > highest) {
                best = Some((j, value));
            }
        }
        let (j_star, _) = best.expect("only subtasks that can act are evaluated");
        self.v(j_star, s) + self.c(i, s, j_star)
    }

    /// T_i(s): the state type left the active set, the goal is reached, or no child
    /// can act. A primitive subtask cannot act outside its active set.
    fn terminal(&self, i: usize, s: &State) -> bool {
        let Row {
            active,
            goal,
            primitive,
            ..
        } = self.rows[i];
        !active.contains(&s.state_type)
            || goal.contains(&s.state_type)
            || (!primitive && self.tree.children(i).all(|a| self.terminal(a, s)))
    }

    fn pseudo_reward(&mut self, i: usize, s_next: &State) -> f64 {
        let at_goal = self.rows[i].goal.contains(&s_next.state_type);
        let terminal = self.terminal(i, s_next);
        let punished = match self.model.pseudo_reward {
            PseudoReward::Terminal => terminal && !at_goal,
            PseudoReward::All => !at_goal,
        };
        self.seen.pseudo_rewards += usize::from(punished);
        if punished { -1.0 } else { 0.0 }
    }

    /// After line 22.
    fn cool(&mut self, i: usize, s: &State) {
        let at_goal = self.rows[i].goal.contains(&s.state_type);
        let event = self.take();
        assert_eq!(event, Event::Terminated { node: i, at_goal });
        if self.model.cool_on == CoolOn::Termination || at_goal {
            let cooled = self.tau[i] * self.model.temperature_decrease;
            self.tau[i] = cooled.max(self.model.temperature_limit);
        }
    }

    /// Eq. 3.7.
    pub fn c_tilde(&self, i: usize, s: &State, a: usize) -> f64 {
        let (features, at) = self.features(i, s);
        dot(&self.theta_c_tilde[a][at..], features)
    }

    /// Eq. 3.8.
    pub fn c(&self, i: usize, s: &State, a: usize) -> f64 {
        let (features, at) = self.features(i, s);
        dot(&self.theta_c[a][at..], features)
    }

    /// Eq. 3.9, all actions.
    pub fn q_prim(&self, i: usize, s: &State) -> Vec<f64> {
        let features = s.phi(self.rows[i].input);
        let thetas = self.theta_q[self.primitive[i]].iter();
        thetas.map(|theta| dot(theta, features)).collect()
    }

    /// The features of a composite subtask and where its parameters for the state's
    /// type begin: state types enter one-hot.
    fn features<'s>(&self, i: usize, s: &'s State) -> (&'s [f64], usize) {
        let row = &self.rows[i];
        let features = s.phi(row.input);
        let block = row.active.iter().position(|&t| t == s.state_type);
        let block = block.expect("only active states are visited");
        let at = block * features.len();
        (features, at)
    }
}

fn double(vector: impl AsRef<[f32]>) -> Vec<f64> {
    vector.as_ref().iter().copied().map(f64::from).collect()
}

fn dot(theta: &[f64], features: &[f64]) -> f64 {
    theta.iter().zip(features).map(|(t, f)| t * f).sum()
}

fn learn(theta: &mut [f64], step: f64, features: &[f64], at: usize) {
    for (t, f) in theta[at..].iter_mut().zip(features) {
        *t += step * f;
    }
}

/// The recorded events of the agent, in order.
impl MaxqQ<'_> {
    fn take(&mut self) -> Event {
        let event = self.replayed.get(self.next).cloned();
        self.next += 1;
        event.expect("the agent did less")
    }

    /// 10: the child that the agent chose, which must be able to act.
    fn chosen(&mut self, i: usize, s: &State) -> usize {
        let event = self.take();
        let Event::Chose { node, child } = event else {
            panic!("node {i} chooses, the agent did {event:?}")
        };
        assert_eq!(node, i);
        let choices = self.choices(i, s);
        assert!(choices.iter().any(|&(choice, _)| choice == child));
        child
    }

    fn executed(&mut self, i: usize) -> (usize, f64, State) {
        let event = self.take();
        let Event::Acted {
            node,
            action,
            reward,
            state,
        } = event
        else {
            panic!("node {i} acts, the agent did {event:?}")
        };
        assert_eq!(node, i);
        (action, f64::from(reward), state.into_inner())
    }

    fn peek_update(&self) -> Update {
        match &self.replayed[self.next] {
            Event::Updated(update) => *update,
            event => panic!("an update is due, the agent did {event:?}"),
        }
    }

    fn compare(&mut self, i: usize, a: usize, s: &State, n: i32, errors: [f64; 2]) {
        let update = self.peek_update();
        self.next += 1;
        let place = (update.node, update.child, update.state_type.number());
        assert_eq!(place, (i, a, s.state_type));
        assert_eq!(update.steps, n as usize, "N of node {i}, child {a}");
        for (error, agents) in errors
            .iter()
            .zip([update.error_inside, update.error_outside])
        {
            let difference = (error - f64::from(agents)).abs();
            assert!(!difference.is_nan());
            self.seen.worst_error = self.seen.worst_error.max(difference);
        }
        self.seen.updates += 1;
        self.seen.distant_updates += usize::from(n > 1);
    }
}
