//! The algorithms that a single learner can use, behind one interface.

use crate::evolution::Experiment;
use crate::hierarchy::Tree;
use crate::learning::{
    Agent, Episode, FlatLearner, FlatMethod, Gate, Policy, PrimitiveSet, Stopped,
};
use crate::random::Stream;
use crate::worlds::World;
use crate::worlds::mdp::{Mdp, MdpState, PolicyTable};

/// A learning algorithm.
#[derive(Clone, Debug)]
pub enum Algorithm {
    /// TD(0) on a table (Thesis Algorithm 2.1).
    Td0(GivenPolicy),
    /// Q-learning on a table (Thesis Algorithm 2.2).
    QLearning,
    /// Q-learning with normalised Gaussian features (Thesis Algorithm 2.3).
    QLearningRbf,
    /// MAXQ-Q on a hierarchy (Thesis Algorithm 2.4).
    MaxqQ(Tree),
}

/// The policy whose values TD(0) learns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GivenPolicy {
    /// The optimal policy; equally good actions are equally likely.
    Optimal,
    /// All actions are equally likely.
    Random,
}

/// A learner that has a value and a best action for every state.
pub(super) trait Learner<P> {
    /// Returns the value of a state that is not terminal.
    fn value(&mut self, state: &MdpState<P>) -> f64;

    /// Returns the best action in a state as its index in [`Mdp::actions`]; `None` where
    /// it can do nothing.
    fn greedy(&mut self, state: &MdpState<P>) -> Option<usize>;
}

/// A flat learner or a hierarchy.
pub(super) enum AnyLearner<'e, W: World> {
    Flat(Box<FlatLearner<'e, W>>),
    Hierarchy(Box<HierarchyLearner<'e, W>>),
}

/// An agent, and its policy after the last episode.
pub(super) struct HierarchyLearner<'e, W: World> {
    agent: Agent<'e, W>,
    finite: &'e Mdp<W::Percept>,
    policy: Policy<'e>,
}

impl<'e, W: World> AnyLearner<'e, W> {
    /// Returns an untrained learner; `policy` is the one that TD(0) evaluates.
    pub(super) fn new(
        experiment: &'e Experiment<W>,
        finite: &'e Mdp<W::Percept>,
        algorithm: &Algorithm,
        policy: Option<&PolicyTable>,
    ) -> Self {
        if let Algorithm::MaxqQ(tree) = algorithm {
            let learning = &experiment.scenario.learning;
            let primitives = PrimitiveSet::untrained(experiment.catalogue(), learning);
            let agent = experiment.agent(experiment.untrained(tree.clone()), primitives);
            return Self::Hierarchy(Box::new(HierarchyLearner {
                policy: agent.policy(),
                agent,
                finite,
            }));
        }
        let map = match algorithm {
            Algorithm::QLearningRbf => finite.gaussian.unwrap_or(finite.table),
            _ => finite.table,
        };
        let method = policy.map_or(FlatMethod::QLearning, |policy| {
            FlatMethod::Td0(policy.clone())
        });
        let Experiment {
            world,
            encoder,
            scenario,
            ..
        } = experiment;
        let learning = &scenario.learning;
        Self::Flat(Box::new(FlatLearner::new(
            world, encoder, learning, finite, map, method,
        )))
    }

    pub(super) fn run_episode(
        &mut self,
        start: &W::Start,
        step_limit: u32,
        rng: &mut Stream,
        gate: &Gate,
    ) -> Result<Episode, Stopped> {
        match self {
            Self::Flat(flat) => flat.run_episode(start, step_limit, rng, gate),
            Self::Hierarchy(learner) => {
                let trial = learner.agent.run_trial(start, step_limit, rng, gate)?;
                Ok(Episode {
                    steps: trial.steps,
                    done: trial.done,
                    reward: trial.reward,
                })
            }
        }
    }

    /// Updates the policy with what has been learned since.
    pub(super) fn refresh(&mut self) {
        if let Self::Hierarchy(learner) = self {
            learner.policy = learner.agent.policy();
        }
    }
}

impl<W: World> Learner<W::Percept> for AnyLearner<'_, W> {
    fn value(&mut self, state: &MdpState<W::Percept>) -> f64 {
        let value = match self {
            Self::Flat(flat) => {
                let values = flat.values(&state.percept);
                values.into_iter().fold(f32::NEG_INFINITY, f32::max)
            }
            Self::Hierarchy(learner) => {
                let percept = state.percept.as_ref();
                learner.policy.look(state.state_type, percept);
                learner.policy.value()
            }
        };
        f64::from(value)
    }

    fn greedy(&mut self, state: &MdpState<W::Percept>) -> Option<usize> {
        match self {
            Self::Flat(flat) => {
                let values = flat.values(&state.percept);
                let better = |best: usize, (action, value): (usize, &f32)| match *value {
                    value if value > values[best] => action,
                    _ => best,
                };
                Some(values.iter().enumerate().fold(0, better))
            }
            Self::Hierarchy(learner) => {
                let percept = state.percept.as_ref();
                learner.policy.look(state.state_type, percept);
                let greedy = learner.policy.greedy()?;
                learner.finite.actions.iter().position(|&own| own == greedy)
            }
        }
    }
}
