//! Algorithm 2.5 and Eq. 3.2 and 3.7 to 3.9, computed from scratch.

use maxq_lab::scenario::{CompositeReward, PrimitiveLearning};

use super::subtasks::{Kind, Row};
use super::{MaxqQ, State};

impl MaxqQ<'_> {
    /// The children that can act in a state with C~(i, s, a) + V(a, s).
    pub fn choices(&self, i: usize, s: &State) -> Vec<(usize, f64)> {
        let able = self.tree.children(i).filter(|&a| !self.terminal(a, s));
        able.filter(|_| !self.terminal(i, s))
            .map(|a| (a, self.c_tilde(i, s, a) + self.v(a, s)))
            .collect()
    }

    /// Algorithm 2.5 with Eq. 3.2, as the parent of i counts it: where composite subtasks are
    /// rewarded for time, a primitive subtask is worth the reward of a time step.
    pub fn v(&self, i: usize, s: &State) -> f64 {
        if self.rows[i].is_primitive() {
            let largest = || self.q_prim(i, s).into_iter().fold(f64::MIN, f64::max);
            return self.per_step().unwrap_or_else(largest);
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

    /// The reward of a time step to composite subtasks, where it is the same in all.
    pub(super) fn per_step(&self) -> Option<f64> {
        match self.model.composite_reward {
            CompositeReward::Subtask => None,
            CompositeReward::PerStep(r) => Some(r),
        }
    }

    /// T_i(s): the state type left the active set, the goal is reached, or no child
    /// can act. A primitive subtask cannot act outside its active set.
    pub(super) fn terminal(&self, i: usize, s: &State) -> bool {
        let Row { active, goal, .. } = self.rows[i];
        !active.contains(&s.state_type)
            || goal.contains(&s.state_type)
            || (!self.rows[i].is_primitive() && self.tree.children(i).all(|a| self.terminal(a, s)))
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

    /// Eq. 3.9, all actions. A command is worth nothing unless primitive subtasks learn. Recall
    /// has the values of the subtask as which it acts: the approach to the target of its task
    /// where it remembers that, else Wander.
    pub fn q_prim(&self, i: usize, s: &State) -> Vec<f64> {
        let frozen = self.model.primitive_learning == PrimitiveLearning::Frozen;
        let acts_as = match (self.rows[i].kind, s.state_type, s.remembers) {
            (Kind::Command, ..) if frozen => return vec![0.0],
            (Kind::Recall, 1, true) => "ApproachBattery",
            (Kind::Recall, 3, true) => "ApproachNest",
            (Kind::Recall, ..) => "Wander",
            (Kind::Behaviour | Kind::Command | Kind::Composite { .. }, ..) => &self.names[i],
        };
        let features = s.phi(super::row(acts_as).input);
        let thetas = self.theta_q[self.place(acts_as)].iter();
        thetas.map(|theta| dot(theta, features)).collect()
    }

    /// The place of a primitive subtask in `theta_q`.
    pub(super) fn place(&self, name: &str) -> usize {
        let place = self.primitives.iter().position(|other| other == name);
        place.expect("a primitive subtask")
    }

    /// The features of a composite subtask and where its parameters for the state's
    /// type begin: state types enter one-hot. With memory the blocks of a subtask that does not
    /// see its target come twice, those for states with a remembered place last.
    pub(super) fn features<'s>(&self, i: usize, s: &'s State) -> (&'s [f64], usize) {
        let row = &self.rows[i];
        let features = s.phi(row.input);
        let block = row.active.iter().position(|&t| t == s.state_type);
        let mut block = block.expect("only active states are visited");
        if self.memory && s.remembers && row.kind == (Kind::Composite { recalls: true }) {
            block += row.active.len();
        }
        (features, block * features.len())
    }
}

pub(super) fn double(vector: impl AsRef<[f32]>) -> Vec<f64> {
    vector.as_ref().iter().copied().map(f64::from).collect()
}

pub(super) fn dot(theta: &[f64], features: &[f64]) -> f64 {
    theta.iter().zip(features).map(|(t, f)| t * f).sum()
}

pub(super) fn learn(theta: &mut [f64], step: f64, features: &[f64], at: usize) {
    for (t, f) in theta[at..].iter_mut().zip(features) {
        *t += step * f;
    }
}
