//! Markov decision processes of small worlds, solved by dynamic programming.
//!
//! Learned values are compared with these exact ones. Learning and evolution never use them.

use nalgebra::{DMatrix, DVector};

use super::{MapId, StateType, SubtaskId};

/// Largest number of sweeps over all states. The values of a policy that need not terminate
/// never converge.
pub const MAX_SWEEPS: usize = 20_000;
/// Values have converged when a sweep changes none by more than this.
const EXACT: f64 = 1e-12;
/// Largest number of states whose linear equations are solved: it takes about a second.
const MOST_EQUATIONS: usize = 2000;

/// A possible outcome of an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Its probability.
    pub probability: f64,
    /// The reward.
    pub reward: f64,
    /// The next state.
    pub next: usize,
}

/// A state of an MDP.
#[derive(Clone, Debug, PartialEq)]
pub struct MdpState<P> {
    /// Its type.
    pub state_type: StateType,
    /// What the agent perceives.
    pub percept: P,
    /// The probability that a trial starts here.
    pub start: f64,
    /// The possible outcomes of each action; empty for a terminal state.
    pub outcomes: Vec<Vec<Outcome>>,
}

/// The Markov decision process of a world. States have the numbers of the features of `table`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mdp<P> {
    /// The feature map that tells all states apart.
    pub table: MapId,
    /// A feature map of Gaussians over the whole state, if the world has one.
    pub gaussian: Option<MapId>,
    /// The actions: primitive subtasks with the index of the action.
    pub actions: Vec<(SubtaskId, usize)>,
    /// The states; `None` where a number has no state.
    pub states: Vec<Option<MdpState<P>>>,
}

/// For each state the probability of each action.
pub type PolicyTable = Vec<Vec<f64>>;

impl<P> Mdp<P> {
    /// Returns the optimal values (Thesis Eq. 2.10) by value iteration, and the number of sweeps.
    #[must_use]
    pub fn optimal_values(&self, discount: f64) -> (Vec<f64>, usize) {
        self.iterate(MAX_SWEEPS, |_, state, values| {
            let all = state.outcomes.iter();
            all.map(|outcomes| expected(outcomes, values, discount))
                .fold(f64::NEG_INFINITY, f64::max)
        })
    }

    /// Returns the values of a policy (Thesis Eq. 2.8) after at most `sweeps` sweeps over all
    /// states, and the number of sweeps.
    ///
    /// If that is `sweeps`, the values have not converged: they count at least as many steps.
    #[must_use]
    pub fn policy_values(
        &self,
        policy: &PolicyTable,
        discount: f64,
        sweeps: usize,
    ) -> (Vec<f64>, usize) {
        self.iterate(sweeps, |index, state, values| {
            let all = state.outcomes.iter().zip(&policy[index]);
            all.filter(|&(_, &probability)| probability > 0.0)
                .map(|(outcomes, probability)| probability * expected(outcomes, values, discount))
                .sum()
        })
    }

    /// Returns the values of a policy (Thesis Eq. 2.8) up to rounding: by sweeps or, where those
    /// converge too slowly, by solving the linear equations. `None` where a value is not finite,
    /// because an episode need not end, or where there are too many states to solve for.
    #[must_use]
    pub fn exact_policy_values(&self, policy: &PolicyTable, discount: f64) -> Option<Vec<f64>> {
        let (values, sweeps) = self.policy_values(policy, discount, MAX_SWEEPS);
        if sweeps < MAX_SWEEPS {
            return Some(values);
        }
        let ends = discount < 1.0 || self.always_ends(policy);
        (ends && self.states.len() <= MOST_EQUATIONS)
            .then(|| self.solve(policy, discount))
            .flatten()
    }

    /// Solves V = r + gamma P V.
    fn solve(&self, policy: &PolicyTable, discount: f64) -> Option<Vec<f64>> {
        let count = self.states.len();
        let mut matrix = DMatrix::<f64>::identity(count, count);
        let mut rewards = DVector::<f64>::zeros(count);
        for (index, state) in self.existing() {
            for (outcomes, share) in state.outcomes.iter().zip(&policy[index]) {
                for outcome in outcomes {
                    let probability = share * outcome.probability;
                    rewards[index] += probability * outcome.reward;
                    matrix[(index, outcome.next)] -= discount * probability;
                }
            }
        }
        let values = matrix.lu().solve(&rewards)?;
        let finite = values.iter().all(|value| value.is_finite());
        finite.then(|| values.iter().copied().collect())
    }

    /// Returns whether from every state a terminal one is reached under a policy, sooner or
    /// later.
    fn always_ends(&self, policy: &PolicyTable) -> bool {
        let terminal = |state: &Option<MdpState<P>>| {
            state.as_ref().is_none_or(|state| state.outcomes.is_empty())
        };
        let mut ends: Vec<bool> = self.states.iter().map(terminal).collect();
        loop {
            let leads = |index: usize, state: &MdpState<P>| {
                let chosen = state.outcomes.iter().zip(&policy[index]);
                let mut outcomes = chosen
                    .filter(|&(_, &share)| share > 0.0)
                    .flat_map(|(outcomes, _)| outcomes);
                outcomes.any(|outcome| outcome.probability > 0.0 && ends[outcome.next])
            };
            let more = self
                .existing()
                .filter(|&(index, state)| !ends[index] && leads(index, state));
            let more: Vec<usize> = more.map(|(index, _)| index).collect();
            if more.is_empty() {
                return ends.into_iter().all(|ends| ends);
            }
            for index in more {
                ends[index] = true;
            }
        }
    }

    /// Returns the greedy policy for these values; equally good actions are equally likely.
    #[must_use]
    pub fn best_policy(&self, values: &[f64], discount: f64) -> PolicyTable {
        let best = |state: &MdpState<P>| -> Vec<f64> {
            let outcomes = state.outcomes.iter();
            let q: Vec<_> = outcomes.map(|o| expected(o, values, discount)).collect();
            let highest = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let good = |&q: &f64| q > highest - 1e-9;
            let share = 1.0 / q.iter().filter(|q| good(q)).count().max(1) as f64;
            q.iter()
                .map(|q| if good(q) { share } else { 0.0 })
                .collect()
        };
        let states = self.states.iter();
        states
            .map(|state| state.as_ref().map(best).unwrap_or_default())
            .collect()
    }

    /// Returns the policy in which all actions are equally likely.
    #[must_use]
    pub fn random_policy(&self) -> PolicyTable {
        let share = 1.0 / self.actions.len() as f64;
        vec![vec![share; self.actions.len()]; self.states.len()]
    }

    /// Returns the expected value of the start state.
    #[must_use]
    pub fn value_at_start(&self, values: &[f64]) -> f64 {
        let states = self.states.iter().zip(values);
        states
            .filter_map(|(state, value)| Some(state.as_ref()?.start * value))
            .sum()
    }

    /// Returns the states with their numbers.
    pub fn existing(&self) -> impl Iterator<Item = (usize, &MdpState<P>)> {
        let states = self.states.iter().enumerate();
        states.filter_map(|(index, state)| Some((index, state.as_ref()?)))
    }

    fn iterate(
        &self,
        sweeps: usize,
        backup: impl Fn(usize, &MdpState<P>, &[f64]) -> f64,
    ) -> (Vec<f64>, usize) {
        let mut values = vec![0.0; self.states.len()];
        for sweep in 0..sweeps {
            let mut change: f64 = 0.0;
            for (index, state) in self.existing() {
                if !state.outcomes.is_empty() {
                    let value = backup(index, state, &values);
                    change = change.max((value - values[index]).abs());
                    values[index] = value;
                }
            }
            if change < EXACT {
                return (values, sweep);
            }
        }
        (values, sweeps)
    }
}

fn expected(outcomes: &[Outcome], values: &[f64], discount: f64) -> f64 {
    let of = |outcome: &Outcome| {
        outcome.probability * (outcome.reward + discount * values[outcome.next])
    };
    outcomes.iter().map(of).sum()
}
