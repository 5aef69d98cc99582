//! Lines 13 to 19: what a composite subtask learns when a child returns.

use maxq_lab::scenario::{Bootstrap, CompositeChoice, ExitValue, PseudoReward};

use super::values::learn;
use super::{Decision, MaxqQ, Reading, State};

/// Children whose values differ by less than this can be swapped by rounding in single
/// precision. Then a* is the one that the agent took.
const TIE: f64 = 2e-4;
/// A largest probability this near to the limit can be on either side of it in single precision.
const LIMIT_TIE: f64 = 2e-5;

/// Children with their weights in the value of a state.
type Weights = Vec<(usize, f64)>;

/// What is learned from s', for lines 16 and 17.
#[derive(Clone, Copy, Debug)]
struct Targets {
    /// R~_i(s') or the value of leaving.
    exit: f64,
    /// C~(i, s', a*) + V(a*, s'), or its mean.
    next_c_tilde: f64,
    /// C(i, s', a*) + V(a*, s'), or its mean.
    next_c: f64,
}

impl MaxqQ<'_> {
    /// Lines 13 to 19.
    pub(super) fn update(&mut self, decision: &Decision) {
        let (i, a, s_next) = (decision.i, decision.a, &*decision.s_next);
        let alpha = self.model.learning_rate;
        let gamma = self.model.discount;
        self.count_exit(i, s_next);
        let weights = self.weights_of_the_agent(decision);
        let before = self.targets(i, s_next, &weights);
        // The discounted rewards of the steps after the one from s, which V(a, s) lacks where a
        // is a primitive subtask that acts for several steps.
        let mut later = 0.0;
        let mut r_next = None;
        // N: 1 for the last visited state, the length of childSeq for the first.
        for (n, visit) in (1..).zip(&decision.child_seq) {
            let Targets {
                exit,
                next_c_tilde,
                next_c,
            } = match self.reading {
                Reading::BeforeTheLoop => before,
                Reading::InTheLoop => self.targets(i, s_next, &weights),
            };
            if let Some(r) = r_next.filter(|_| self.rows[a].is_primitive()) {
                later = gamma * (r + later);
                self.seen.later_rewards += 1;
            }
            r_next = Some(visit.r);
            let s = &*visit.s;
            let discount = gamma.powi(n);
            // 16, Eq. 3.4.
            let error_inside = discount * (exit + next_c_tilde) + later - self.c_tilde(i, s, a);
            // 17, Eq. 3.5.
            let error_outside = discount * next_c + later - self.c(i, s, a);
            let (features, at) = self.features(i, s);
            learn(
                &mut self.theta_c_tilde[a],
                alpha * error_inside,
                features,
                at,
            );
            learn(&mut self.theta_c[a], alpha * error_outside, features, at);
            self.compare(i, a, s, n, [exit, error_inside, error_outside]);
        }
    }

    /// The right-hand sides without discount. Where s' is terminal for i, all but the first are 0.
    fn targets(&self, i: usize, s_next: &State, weights: &Weights) -> Targets {
        let leaves = self.terminal(i, s_next);
        let continues = leaves && self.model.exit_value == ExitValue::Continuation;
        let exit = match self.goes_on(i, s_next).filter(|_| continues) {
            Some(ancestor) => {
                let value = |a| self.c_tilde(ancestor, s_next, a) + self.v(a, s_next);
                self.mean(weights, value)
            }
            None => self.pseudo_reward(i, s_next),
        };
        let [mut next_c_tilde, mut next_c] = [0.0; 2];
        if !leaves {
            next_c_tilde = self.mean(weights, |a| self.c_tilde(i, s_next, a) + self.v(a, s_next));
            next_c = self.mean(weights, |a| self.c(i, s_next, a) + self.v(a, s_next));
        }
        Targets {
            exit,
            next_c_tilde,
            next_c,
        }
    }

    fn mean(&self, weights: &Weights, value: impl Fn(usize) -> f64) -> f64 {
        weights.iter().map(|&(a, weight)| weight * value(a)).sum()
    }

    /// The first ancestor of i that is not terminal in s'.
    fn goes_on(&self, i: usize, s_next: &State) -> Option<usize> {
        let mut at = i;
        while let Some(parent) = self.tree.nodes()[at].parent {
            if !self.terminal(parent, s_next) {
                return Some(parent);
            }
            at = parent;
        }
        None
    }

    /// The weights of the children from which i learns in s': its own, or those of the ancestor
    /// that goes on. Where rounding decides, they are those that explain the agent's error.
    fn weights_of_the_agent(&mut self, decision: &Decision) -> Weights {
        let (i, a, s_next) = (decision.i, decision.a, &*decision.s_next);
        let node = match self.model.exit_value {
            _ if !self.terminal(i, s_next) => i,
            ExitValue::PseudoReward => return Weights::new(),
            ExitValue::Continuation => match self.goes_on(i, s_next) {
                Some(ancestor) => ancestor,
                None => return Weights::new(),
            },
        };
        let mut candidates = self.candidates(node, s_next);
        if candidates.len() == 1 {
            return candidates.remove(0);
        }
        self.seen.ties += 1;
        let recorded = self.peek_update();
        let last = &*decision.child_seq[0].s;
        let discount = self.model.discount;
        let distance = |weights: &Weights| {
            let targets = self.targets(i, s_next, weights);
            let inside = discount * (targets.exit + targets.next_c_tilde);
            let outside = discount * targets.next_c;
            let off_inside = inside - self.c_tilde(i, last, a) - f64::from(recorded.error_inside);
            let off_outside = outside - self.c(i, last, a) - f64::from(recorded.error_outside);
            off_inside.abs().max(off_outside.abs())
        };
        let all = candidates.into_iter();
        let nearest = all.min_by(|x, y| distance(x).total_cmp(&distance(y)));
        nearest.expect("a child that can act")
    }

    /// The weights of the children of a node that can act; several where rounding decides.
    fn candidates(&self, node: usize, s: &State) -> Vec<Weights> {
        let values = self.choices(node, s);
        let highest = values.iter().map(|v| v.1).fold(f64::MIN, f64::max);
        if self.model.bootstrap == Bootstrap::Greedy {
            // 13: a* maximises C~(i, s', a') + V(a', s'), the first of equals.
            let near = values.iter().filter(|(_, value)| highest - value < TIE);
            return near.map(|&(a_star, _)| vec![(a_star, 1.0)]).collect();
        }
        let count = values.len() as f64;
        if self.model.composite_choice == CompositeChoice::Random {
            let equal = |&(a, _): &(usize, f64)| (a, 1.0 / count);
            return vec![values.iter().map(equal).collect()];
        }
        let odds = |value: f64| ((value - highest) / self.tau[node]).exp();
        let sum: f64 = values.iter().map(|&(_, value)| odds(value)).sum();
        let softmax = values.iter().map(|&(a, value)| (a, odds(value) / sum));
        let epsilon = self.model.epsilon;
        let greedy = values.iter().map(|&(a, value)| {
            let best = if value == highest { 1.0 - epsilon } else { 0.0 };
            (a, epsilon / count + best)
        });
        let beyond = 1.0 / sum - self.model.probability_limit;
        let mut candidates = Vec::new();
        if beyond <= LIMIT_TIE {
            candidates.push(softmax.collect());
        }
        if beyond >= -LIMIT_TIE {
            candidates.push(greedy.collect());
        }
        candidates
    }

    /// R~_i(s'). There is none where an exit is worth what follows.
    fn pseudo_reward(&self, i: usize, s_next: &State) -> f64 {
        if self.model.exit_value == ExitValue::Continuation {
            return 0.0;
        }
        let at_goal = self.rows[i].goal.contains(&s_next.state_type);
        let punished = match self.model.pseudo_reward {
            PseudoReward::Terminal => self.terminal(i, s_next) && !at_goal,
            PseudoReward::All => !at_goal,
        };
        if punished {
            -self.model.pseudo_penalty
        } else {
            0.0
        }
    }

    fn count_exit(&mut self, i: usize, s_next: &State) {
        let leaves = self.terminal(i, s_next);
        if leaves && self.model.exit_value == ExitValue::Continuation {
            let goes_on = self.goes_on(i, s_next).is_some();
            self.seen.continuations += usize::from(goes_on);
        } else {
            self.seen.pseudo_rewards += usize::from(self.pseudo_reward(i, s_next) < 0.0);
        }
    }
}
