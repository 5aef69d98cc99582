//! Lets single learners learn a finite world and compares them with the exact values.

use std::sync::atomic::{AtomicUsize, Ordering};

use serde::Serialize;
use thiserror::Error;

use super::learner::{Algorithm, AnyLearner, GivenPolicy, Learner};
use super::statistics::{Mean, mean};
use crate::evolution::{Experiment, Workers};
use crate::learning::{Gate, Stopped};
use crate::random::{Purpose, Stream, stream};
use crate::worlds::World;
use crate::worlds::mdp::{MAX_SWEEPS, Mdp, PolicyTable};

/// Fewest sweeps for the value of a greedy policy. A policy whose episodes have not ended after
/// as many steps is far from optimal.
const CHECK_SWEEPS: usize = 300;

/// The numbers of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearnProtocol {
    /// Primitive steps of a repeat, which ends with the trial under way.
    pub steps: u64,
    /// Primitive steps between two checks.
    pub every: u64,
    /// Largest shortfall of expected return at which a greedy policy counts as optimal.
    pub tolerance: f64,
    /// Number of learners; each starts untrained.
    pub repeats: usize,
}

/// The result of a check, which is made every [`LearnProtocol::every`] steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LearnCheck {
    /// Primitive steps so far.
    pub steps: u64,
    /// Mean return of the trials since the last check, with exploration; `None` if no trial
    /// ended.
    pub return_while_learning: Option<f64>,
    /// Exact expected return of the greedy policy from a random start; `None` for TD(0), whose
    /// policy is given, and for a policy whose episodes do not end.
    pub greedy_return: Option<f64>,
    /// Largest absolute difference between a learned value and the exact one.
    pub largest_error: f64,
}

/// The course of one learner.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Course {
    /// Primitive steps until the first check at which the greedy policy was optimal.
    pub steps_until_optimal: Option<u64>,
    /// Primitive steps until the check from which on the greedy policy stayed optimal; `None` if
    /// it was not optimal at the last check.
    pub steps_until_always_optimal: Option<u64>,
    /// Number of trials.
    pub trials: u64,
    /// All checks.
    pub checks: Vec<LearnCheck>,
    /// The learned value of every state at the end, in the order of [`Learned::exact`].
    #[serde(skip)]
    pub values: Vec<Option<f64>>,
}

/// The result of all learners.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Learned {
    /// Exact expected return of the optimal policy from a random start.
    pub optimal_return: f64,
    /// Mean of [`Course::steps_until_optimal`]; `None` unless all repeats have it.
    pub steps_until_optimal: Option<Mean>,
    /// Mean of [`Course::steps_until_always_optimal`]; `None` unless all repeats have it.
    pub steps_until_always_optimal: Option<Mean>,
    /// Whether the policy was given (TD(0)), so that none becomes optimal.
    pub policy_is_given: bool,
    /// Mean of the last greedy returns; `None` unless all repeats have one.
    pub final_greedy_return: Option<Mean>,
    /// The exact values: the optimal ones, or those of the given policy for TD(0).
    #[serde(skip)]
    pub exact: Vec<Option<f64>>,
    /// All repeats.
    pub repeats: Vec<Course>,
}

/// Why learners cannot be compared.
#[derive(Debug, Error)]
pub enum LearnError {
    /// The world is not finite.
    #[error(
        "found a world whose states cannot be counted; allowed: a finite world, such as taxi or \
         cliff"
    )]
    NotFinite,
    /// The world has no Gaussian features.
    #[error(
        "found a world without RBF features; allowed: q-learning on its table, or RBF features \
         in cliff"
    )]
    NoGaussians,
    /// The values that should be learned cannot be computed.
    #[error(
        "found no exact values to compare with: an episode need not end, or there are too many \
         states; allowed: a discount below 1, or a policy that always ends"
    )]
    NoValues,
    /// The gate was stopped.
    #[error(transparent)]
    Stopped(#[from] Stopped),
}

/// Lets untrained learners learn the world of `experiment`; calls `progress` with the number of
/// repeats done so far.
///
/// # Errors
/// When the world is not finite or lacks features for the algorithm, or the gate is stopped.
pub fn learn<W: World>(
    experiment: &Experiment<W>,
    seed: u64,
    algorithm: &Algorithm,
    protocol: &LearnProtocol,
    workers: &Workers,
    gate: &Gate,
    progress: impl Fn(usize) + Sync,
) -> Result<Learned, LearnError> {
    let finite = experiment.world.mdp().ok_or(LearnError::NotFinite)?;
    if matches!(algorithm, Algorithm::QLearningRbf) && finite.gaussian.is_none() {
        return Err(LearnError::NoGaussians);
    }
    let exam = Exam::new(
        &finite,
        algorithm,
        protocol,
        experiment.scenario.learning.discount,
    )?;
    let done = AtomicUsize::new(0);
    let repeats = workers.map(
        (0..protocol.repeats).collect(),
        |repeat| -> Result<_, Stopped> {
            let learner = AnyLearner::new(experiment, &finite, algorithm, exam.policy.as_ref());
            let rng = stream(seed, 0, repeat as u64, Purpose::Evaluation);
            let course = exam.course(experiment, learner, rng, gate)?;
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
            Ok(course)
        },
    )?;
    let all = |of: fn(&Course) -> Option<f64>| -> Option<Mean> {
        let numbers: Option<Vec<_>> = repeats.iter().map(of).collect();
        numbers.as_deref().and_then(mean)
    };
    let existing = finite.states.iter().zip(&exam.exact);
    Ok(Learned {
        optimal_return: exam.optimal_return,
        steps_until_optimal: all(|course| course.steps_until_optimal.map(|steps| steps as f64)),
        steps_until_always_optimal: all(|course| {
            course.steps_until_always_optimal.map(|steps| steps as f64)
        }),
        policy_is_given: exam.policy.is_some(),
        final_greedy_return: all(|course| course.checks.last()?.greedy_return),
        exact: existing
            .map(|(state, &value)| state.as_ref().map(|_| value))
            .collect(),
        repeats,
    })
}

/// The exact values that learners are compared with.
struct Exam<'f, P> {
    finite: &'f Mdp<P>,
    protocol: &'f LearnProtocol,
    discount: f64,
    /// The policy given to TD(0).
    policy: Option<PolicyTable>,
    /// The values that learning should arrive at.
    exact: Vec<f64>,
    optimal_return: f64,
    /// Sweeps for the value of a greedy policy.
    check_sweeps: usize,
}

impl<'f, P: Copy + AsRef<[f32]> + Send + Sync> Exam<'f, P> {
    fn new(
        finite: &'f Mdp<P>,
        algorithm: &Algorithm,
        protocol: &'f LearnProtocol,
        discount: f64,
    ) -> Result<Self, LearnError> {
        let (optimal, sweeps) = finite.optimal_values(discount);
        let policy = match algorithm {
            Algorithm::Td0(GivenPolicy::Optimal) => Some(finite.best_policy(&optimal, discount)),
            Algorithm::Td0(GivenPolicy::Random) => Some(finite.random_policy()),
            _ => None,
        };
        let exact = match &policy {
            Some(policy) => finite.exact_policy_values(policy, discount),
            None => (sweeps < MAX_SWEEPS).then(|| optimal.clone()),
        };
        let exact = exact.ok_or(LearnError::NoValues)?;
        Ok(Self {
            optimal_return: finite.value_at_start(&optimal),
            exact,
            finite,
            protocol,
            discount,
            policy,
            check_sweeps: CHECK_SWEEPS.max(4 * sweeps),
        })
    }

    fn course<W: World<Percept = P>>(
        &self,
        experiment: &Experiment<W>,
        mut learner: AnyLearner<'_, W>,
        mut rng: Stream,
        gate: &Gate,
    ) -> Result<Course, Stopped> {
        let limit = experiment.scenario.evolution.trial_step_limit;
        let mut course = Course {
            steps_until_optimal: None,
            steps_until_always_optimal: None,
            trials: 0,
            checks: Vec::new(),
            values: Vec::new(),
        };
        let (mut steps, mut recent) = (0, Vec::new());
        while steps < self.protocol.steps {
            let start = experiment.world.draw_start(&mut rng);
            let episode = learner.run_episode(&start, limit, &mut rng, gate)?;
            let checks = steps / self.protocol.every;
            steps += u64::from(episode.steps);
            course.trials += 1;
            recent.push(episode.reward);
            if steps / self.protocol.every > checks || steps >= self.protocol.steps {
                learner.refresh();
                course.checks.push(self.check(steps, &recent, &mut learner));
                recent.clear();
            }
        }
        let optimal = |check: &&LearnCheck| {
            let lowest = self.optimal_return - self.protocol.tolerance;
            check.greedy_return.is_some_and(|greedy| greedy >= lowest)
        };
        course.steps_until_optimal = course.checks.iter().find(optimal).map(|check| check.steps);
        let last = course.checks.iter().rev().take_while(optimal).last();
        course.steps_until_always_optimal = last.map(|check| check.steps);
        course.values = self.values(&mut learner);
        Ok(course)
    }

    fn check<L: Learner<P>>(&self, steps: u64, recent: &[f64], learner: &mut L) -> LearnCheck {
        let greedy = self.policy.is_none().then(|| -> Option<f64> {
            let policy = self.finite.states.iter().map(|state| {
                let mut shares = vec![0.0; self.finite.actions.len()];
                if let Some(action) = state.as_ref().and_then(|s| learner.greedy(s)) {
                    shares[action] = 1.0;
                }
                shares
            });
            self.settled_return(&policy.collect())
        });
        let errors = self.values(learner).into_iter().zip(&self.exact);
        let errors = errors.filter_map(|(value, exact)| Some((value? - exact).abs()));
        LearnCheck {
            steps,
            return_while_learning: mean(recent).map(|mean| mean.mean),
            greedy_return: greedy.flatten(),
            // `total_cmp` puts NaN last, so a learner that has diverged has the largest error.
            largest_error: errors.max_by(f64::total_cmp).unwrap_or(0.0),
        }
    }

    /// Returns the expected return of a policy from a random start; `None` where more sweeps
    /// still change it, because its episodes do not end. A policy may loop in states that no
    /// trial visits: these do not count.
    fn settled_return(&self, policy: &PolicyTable) -> Option<f64> {
        let after = |sweeps| self.finite.policy_values(policy, self.discount, sweeps);
        let (values, sweeps) = after(self.check_sweeps);
        let value = self.finite.value_at_start(&values);
        if sweeps < self.check_sweeps {
            return Some(value);
        }
        let later = self.finite.value_at_start(&after(2 * self.check_sweeps).0);
        ((later - value).abs() < 1e-9).then_some(later)
    }

    /// Returns the learned value of every state; 0 for terminal states.
    fn values<L: Learner<P>>(&self, learner: &mut L) -> Vec<Option<f64>> {
        let states = self.finite.states.iter();
        states
            .map(|state| {
                let state = state.as_ref()?;
                Some(if state.outcomes.is_empty() {
                    0.0
                } else {
                    learner.value(state)
                })
            })
            .collect()
    }
}
