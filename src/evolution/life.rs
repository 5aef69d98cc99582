//! One individual's generation: its trials.

use rand::seq::SliceRandom;

use super::experiment::Experiment;
use super::individual::{Individual, Origin};
use super::record::TrialRecord;
use crate::learning::{Gate, Hierarchy, Skills, Stopped};
use crate::random::{Purpose, Stream, stream};
use crate::worlds::World;

/// Where the trials of a generation start, the same for every individual.
#[derive(Clone, Debug)]
pub(super) struct Starts<S> {
    unscored: Vec<S>,
    scored: Vec<S>,
}

impl<S> Starts<S> {
    pub(super) fn draw<W: World<Start = S>>(
        experiment: &Experiment<W>,
        seed: u64,
        generation: u64,
    ) -> Self {
        let mut rng = stream(seed, generation, 0, Purpose::StartPoses);
        let half = experiment.scenario.evolution.trials_per_generation / 2;
        let mut draw = || {
            (0..half)
                .map(|_| experiment.world.draw_start(&mut rng))
                .collect()
        };
        Self {
            unscored: draw(),
            scored: draw(),
        }
    }
}

/// What came of an individual's generation.
#[derive(Clone, Debug)]
pub(super) struct Life {
    /// Its hierarchy with what it has learned.
    pub(super) hierarchy: Hierarchy,
    /// The primitive subtasks, changed if they go on learning.
    pub(super) skills: Skills,
    /// The scored trials, in the order in which they were run.
    pub(super) scored: Vec<TrialRecord>,
    /// Time steps of all trials.
    pub(super) control_steps: u64,
}

impl Life {
    /// Time steps over the scored trials; smaller is better (Thesis 4.2).
    pub(super) fn fitness(&self) -> u64 {
        self.scored.iter().map(|trial| u64::from(trial.steps)).sum()
    }
}

/// Whether an individual runs only the scored half of the trials: it has learned in
/// the generation before and shall have no advantage (Thesis 3.2).
pub(super) fn is_experienced(individual: &Individual) -> bool {
    individual.origin == Origin::Reproduced
}

/// Lets an individual live through a generation (Algorithm 3.1, line 3): each half of
/// the trials in an order of its own, reproduced ones only the scored half.
pub(super) fn live<W: World>(
    experiment: &Experiment<W>,
    individual: &Individual,
    skills: Skills,
    starts: &Starts<W::Start>,
    seed: u64,
    generation: u64,
    gate: &Gate,
) -> Result<Life, Stopped> {
    let limit = experiment.scenario.evolution.trial_step_limit;
    let mut rng = stream(seed, generation, individual.id, Purpose::Life);
    let mut agent = experiment.agent(individual.hierarchy.clone(), skills);
    let mut half = |starts: &[W::Start]| -> Result<Vec<TrialRecord>, Stopped> {
        let order = shuffled(starts.len(), &mut rng);
        let trials = order.into_iter().map(|index| {
            let trial = agent.run_trial(&starts[index], limit, &mut rng, gate)?;
            Ok(TrialRecord {
                steps: trial.steps,
                delivered: trial.done,
            })
        });
        trials.collect()
    };
    let unscored = match is_experienced(individual) {
        true => Vec::new(),
        false => half(&starts.unscored)?,
    };
    let scored = half(&starts.scored)?;
    let control_steps = unscored
        .iter()
        .chain(&scored)
        .map(|trial| u64::from(trial.steps))
        .sum();
    let (hierarchy, skills) = agent.into_parts();
    Ok(Life {
        hierarchy,
        skills,
        scored,
        control_steps,
    })
}

fn shuffled(count: usize, rng: &mut Stream) -> Vec<usize> {
    let mut order: Vec<_> = (0..count).collect();
    order.shuffle(rng);
    order
}
