//! Worlds with few states, known exactly: Bellman's equations in place of experience.
//!
//! What agents learn by trial and error can be held against these values. Nothing that
//! learns or evolves looks at them.

use super::{MapId, StateType, SubtaskId};

/// Sweeps over all states after which values are taken as they are: those of a policy that
/// need not come to an end never settle.
pub const MAX_SWEEPS: usize = 20_000;
/// Values are exact when no sweep changes one by more than this.
const EXACT: f64 = 1e-12;

/// What can come of an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How likely it is.
    pub probability: f64,
    /// The reward.
    pub reward: f64,
    /// The next state.
    pub next: usize,
}

/// A state of a finite world.
#[derive(Clone, Debug, PartialEq)]
pub struct MdpState<P> {
    /// Its type.
    pub state_type: StateType,
    /// What the agent perceives in it.
    pub percept: P,
    /// The probability that a trial starts in it.
    pub start: f64,
    /// For each action what can come of it; empty in a terminal state.
    pub outcomes: Vec<Vec<Outcome>>,
}

/// A whole world: its states are numbered as the features of its `table` are.
#[derive(Clone, Debug, PartialEq)]
pub struct Mdp<P> {
    /// The feature map that tells all states apart.
    pub table: MapId,
    /// A feature map of Gaussians over all that matters, if the world has one.
    pub gaussian: Option<MapId>,
    /// The actions: primitive subtasks and the index of the action there.
    pub actions: Vec<(SubtaskId, usize)>,
    /// The states; `None` where no state has this number.
    pub states: Vec<Option<MdpState<P>>>,
}

/// For each state the probability of each action.
pub type PolicyTable = Vec<Vec<f64>>;

impl<P> Mdp<P> {
    /// The optimal values (Thesis Eq. 2.10), by value iteration, and how many sweeps over
    /// all states these took.
    #[must_use]
    pub fn optimal_values(&self, discount: f64) -> (Vec<f64>, usize) {
        self.iterate(MAX_SWEEPS, |_, state, values| {
            let all = state.outcomes.iter();
            all.map(|outcomes| expected(outcomes, values, discount))
                .fold(f64::NEG_INFINITY, f64::max)
        })
    }

    /// The values of a policy (Thesis Eq. 2.8), by at most `sweeps` sweeps over all states,
    /// and how many these took: if all, the values have not settled and are those of at
    /// least as many steps.
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

    /// The policy that takes the best actions for these values, equally good ones alike.
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

    /// The policy that takes all actions alike.
    #[must_use]
    pub fn random_policy(&self) -> PolicyTable {
        let share = 1.0 / self.actions.len() as f64;
        vec![vec![share; self.actions.len()]; self.states.len()]
    }

    /// The expected value of the state in which a trial starts.
    #[must_use]
    pub fn value_at_start(&self, values: &[f64]) -> f64 {
        let states = self.states.iter().zip(values);
        states
            .filter_map(|(state, value)| Some(state.as_ref()?.start * value))
            .sum()
    }

    /// The states that are no holes in the numbering.
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
