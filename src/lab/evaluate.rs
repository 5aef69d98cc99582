//! Evaluates one structure: fresh hierarchies of it learn and are scored.

use std::sync::atomic::{AtomicUsize, Ordering};

use serde::{Deserialize, Serialize};

use super::curve::{CurvePoint, Lived, curve};
use super::statistics::{mean_of, standard_error};
use crate::evolution::{Experiment, Workers};
use crate::hierarchy::{Tree, to_text};
use crate::learning::{Gate, PrimitiveSet, Stopped};
use crate::random::{Purpose, stream};
use crate::worlds::World;

/// The numbers of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Protocol {
    /// Unscored trials at the beginning of each repeat.
    pub warmup: usize,
    /// Scored trials of each repeat; the hierarchy keeps learning.
    pub trials: usize,
    /// Number of fresh hierarchies.
    pub repeats: usize,
    /// Separately trained sets of primitive subtasks, of which at most `repeats` are trained;
    /// repeat `i` uses set `i % primitive_sets`.
    pub primitive_sets: usize,
}

/// The scored trials of one fresh hierarchy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Repeat {
    /// Time steps of each scored trial.
    pub steps: Vec<u32>,
    /// Number of scored trials in which the task was completed.
    pub delivered: usize,
    /// Index of the set of primitive subtasks, from 0.
    #[serde(rename = "bank")]
    pub primitive_set: usize,
}

/// The result of an evaluation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// The structure as text.
    pub tree: String,
    /// All repeats.
    pub repeats: Vec<Repeat>,
    /// Mean time steps of a scored trial.
    pub mean: f64,
    /// Standard error of the mean; `None` for a single repeat.
    ///
    /// Repeats that share a set of primitive subtasks are correlated, so the variance between
    /// sets counts in full.
    pub standard_error: Option<f64>,
    /// Share of the scored trials in which the task was completed.
    pub delivered_share: f64,
    /// Control steps of all trials including warm-up, without the training of primitive
    /// subtasks.
    pub control_steps: u64,
}

/// An evaluation with the returns of its scored trials.
///
/// In foraging time steps are the fitness; in other worlds returns say more.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scored {
    /// The evaluation.
    #[serde(flatten)]
    pub evaluation: Evaluation,
    /// Return (sum of rewards) of each scored trial, by repeat.
    pub returns: Vec<Vec<f64>>,
    /// Mean return of a scored trial.
    pub mean_return: f64,
    /// Standard error of the mean return, computed like that of the time steps.
    pub return_standard_error: Option<f64>,
    /// The learning curve over all trials, warm-up included.
    #[serde(skip)]
    pub curve: Vec<CurvePoint>,
}

/// Evaluates the structure `tree`; calls `progress` with the number of repeats done so far.
///
/// Each repeat creates an untrained hierarchy of the structure, lets it learn for the warm-up
/// trials and scores the following ones.
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
    // A set beyond the number of repeats would be trained for nothing.
    let sets = (0..protocol.primitive_sets.min(protocol.repeats))
        .map(|set| experiment.train(seed, set as u64, workers, gate))
        .collect::<Result<Vec<_>, _>>()?;
    let done = AtomicUsize::new(0);
    let repeats = workers.map((0..protocol.repeats).collect(), |repeat| {
        let set = &sets[repeat % sets.len()];
        let scored = one_repeat(experiment, seed, tree, protocol, repeat, set, gate)?;
        progress(done.fetch_add(1, Ordering::Relaxed) + 1);
        Ok(scored)
    })?;
    let control_steps = repeats.iter().map(|scored| scored.control_steps).sum();
    let means = |of: fn(&ScoredRepeat) -> f64| -> Vec<(usize, f64)> {
        let means = repeats
            .iter()
            .map(|scored| (scored.repeat.primitive_set, of(scored)));
        means.collect()
    };
    let steps = means(|scored| mean_of(scored.repeat.steps.iter().map(|&steps| f64::from(steps))));
    let returns = means(|scored| mean_of(scored.returns.iter().copied()));
    let delivered: usize = repeats.iter().map(|scored| scored.repeat.delivered).sum();
    let lived = repeats.iter().map(|scored| {
        let set = scored.repeat.primitive_set;
        (set, scored.lived.clone())
    });
    let curve = curve(&lived.collect::<Vec<_>>());
    let (repeats, all_returns) = repeats
        .into_iter()
        .map(|scored| (scored.repeat, scored.returns))
        .unzip();
    Ok(Scored {
        evaluation: Evaluation {
            tree: to_text(tree, experiment.catalogue()),
            mean: mean_of(steps.iter().map(|(_, mean)| *mean)),
            standard_error: standard_error(&steps),
            delivered_share: delivered as f64 / (protocol.repeats * protocol.trials) as f64,
            repeats,
            control_steps,
        },
        returns: all_returns,
        mean_return: mean_of(returns.iter().map(|(_, mean)| *mean)),
        return_standard_error: standard_error(&returns),
        curve,
    })
}

/// A repeat with the numbers that [`Repeat`] leaves out.
struct ScoredRepeat {
    repeat: Repeat,
    /// Return of each scored trial.
    returns: Vec<f64>,
    /// Control steps of all trials.
    control_steps: u64,
    /// All trials.
    lived: Lived,
}

fn one_repeat<W: World>(
    experiment: &Experiment<W>,
    seed: u64,
    tree: &Tree,
    protocol: &Protocol,
    repeat: usize,
    primitives: &PrimitiveSet,
    gate: &Gate,
) -> Result<ScoredRepeat, Stopped> {
    let limit = experiment.scenario.evolution.trial_step_limit;
    let mut rng = stream(seed, 0, repeat as u64, Purpose::Evaluation);
    let untrained = experiment.untrained(tree.clone());
    let mut agent = experiment.agent(untrained, primitives.clone());
    let mut scored = ScoredRepeat {
        repeat: Repeat {
            steps: Vec::with_capacity(protocol.trials),
            delivered: 0,
            primitive_set: repeat % protocol.primitive_sets,
        },
        returns: Vec::with_capacity(protocol.trials),
        control_steps: 0,
        lived: Lived::new(protocol.warmup + protocol.trials),
    };
    for trial in 0..protocol.warmup + protocol.trials {
        let start = experiment.world.draw_start(&mut rng);
        let over = agent.run_trial(&start, limit, &mut rng, gate)?;
        scored.control_steps += u64::from(over.steps);
        scored.lived.add(trial, over.steps, over.done);
        if trial >= protocol.warmup {
            scored.repeat.steps.push(over.steps);
            scored.repeat.delivered += usize::from(over.done);
            scored.returns.push(over.reward);
        }
    }
    Ok(scored)
}
