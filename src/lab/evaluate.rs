//! How good one structure is: fresh hierarchies of it learn and are scored.

use std::sync::atomic::{AtomicUsize, Ordering};

use serde::{Deserialize, Serialize};

use super::statistics::{plain_mean, standard_error};
use crate::evolution::{Experiment, Workers};
use crate::hierarchy::{Tree, to_text};
use crate::learning::{Gate, PrimitiveSet, Stopped};
use crate::random::{Purpose, stream};
use crate::worlds::World;

/// How an evaluation is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Protocol {
    /// Trials of each repeat before scoring starts.
    pub warmup: usize,
    /// Scored trials of each repeat; learning goes on.
    pub trials: usize,
    /// Fresh hierarchies.
    pub repeats: usize,
    /// Separately trained sets of primitive subtasks that the repeats are spread over.
    pub banks: usize,
}

/// One fresh hierarchy's scored trials.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Repeat {
    /// Time steps of each scored trial.
    pub steps: Vec<u32>,
    /// How many of them delivered.
    pub delivered: usize,
    /// The set of primitive subtasks used, from 0.
    pub bank: usize,
}

/// The result of an evaluation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// The structure.
    pub tree: String,
    /// Every repeat.
    pub repeats: Vec<Repeat>,
    /// Mean number of time steps of a scored trial.
    pub mean: f64,
    /// Standard error of the mean; `null` for a single repeat. Repeats on the same set
    /// of primitives are alike, so the variance between sets counts in full.
    pub standard_error: Option<f64>,
    /// Share of scored trials that delivered.
    pub delivered_share: f64,
    /// Control steps of all trials, warm-up included, training of primitives not.
    pub control_steps: u64,
}

/// An evaluation with what its scored trials earned: foraging counts time steps, in other
/// worlds these do not tell the whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scored {
    /// The evaluation.
    #[serde(flatten)]
    pub evaluation: Evaluation,
    /// Return of each scored trial - the sum of its rewards -, by repeat.
    pub returns: Vec<Vec<f64>>,
    /// Mean return of a scored trial.
    pub mean_return: f64,
    /// Its standard error, as that of the time steps.
    pub return_standard_error: Option<f64>,
}

/// Evaluates the structure `tree`; `progress` is told how many repeats are done.
///
/// # Errors
/// When the gate is stopped.
pub fn evaluate<W: World>(
    experiment: &Experiment<W>,
    seed: u64,
    tree: &Tree,
    protocol: &Protocol,
    workers: &Workers,
    gate: &Gate,
    progress: impl Fn(usize) + Sync,
) -> Result<Scored, Stopped> {
    let banks = (0..protocol.banks)
        .map(|bank| experiment.train(seed, bank as u64, workers, gate))
        .collect::<Result<Vec<_>, _>>()?;
    let done = AtomicUsize::new(0);
    let repeats = workers.map((0..protocol.repeats).collect(), |repeat| {
        let bank = repeat % protocol.banks;
        let scored = one_repeat(experiment, seed, tree, protocol, repeat, &banks[bank], gate)?;
        progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        Ok(scored)
    })?;
    let control_steps = repeats.iter().map(|life| life.control_steps).sum();
    let means = |of: fn(&Life) -> f64| -> Vec<(usize, f64)> {
        let means = repeats.iter().map(|life| (life.repeat.bank, of(life)));
        means.collect()
    };
    let steps = means(|life| plain_mean(life.repeat.steps.iter().map(|&steps| f64::from(steps))));
    let returns = means(|life| plain_mean(life.returns.iter().copied()));
    let delivered: usize = repeats.iter().map(|life| life.repeat.delivered).sum();
    let (repeats, all_returns) = repeats
        .into_iter()
        .map(|life| (life.repeat, life.returns))
        .unzip();
    Ok(Scored {
        evaluation: Evaluation {
            tree: to_text(tree, experiment.catalogue()),
            mean: plain_mean(steps.iter().map(|(_, mean)| *mean)),
            standard_error: standard_error(&steps),
            delivered_share: delivered as f64 / (protocol.repeats * protocol.trials) as f64,
            repeats,
            control_steps,
        },
        returns: all_returns,
        mean_return: plain_mean(returns.iter().map(|(_, mean)| *mean)),
        return_standard_error: standard_error(&returns),
    })
}

/// One repeat, with what is not kept of it.
struct Life {
    repeat: Repeat,
    /// Return of each scored trial.
    returns: Vec<f64>,
    /// Control steps of all trials.
    control_steps: u64,
}

fn one_repeat<W: World>(
    experiment: &Experiment<W>,
    seed: u64,
    tree: &Tree,
    protocol: &Protocol,
    repeat: usize,
    primitives: &PrimitiveSet,
    gate: &Gate,
) -> Result<Life, Stopped> {
    let limit = experiment.scenario.evolution.trial_step_limit;
    let mut rng = stream(seed, 0, repeat as u64, Purpose::Evaluation);
    let untrained = experiment.untrained(tree.clone());
    let mut agent = experiment.agent(untrained, primitives.clone());
    let mut life = Life {
        repeat: Repeat {
            steps: Vec::with_capacity(protocol.trials),
            delivered: 0,
            bank: repeat % protocol.banks,
        },
        returns: Vec::with_capacity(protocol.trials),
        control_steps: 0,
    };
    for trial in 0..protocol.warmup + protocol.trials {
        let start = experiment.world.draw_start(&mut rng);
        let over = agent.run_trial(&start, limit, &mut rng, gate)?;
        life.control_steps += u64::from(over.steps);
        if trial >= protocol.warmup {
            life.repeat.steps.push(over.steps);
            life.repeat.delivered += usize::from(over.done);
            life.returns.push(over.reward);
        }
    }
    Ok(life)
}
