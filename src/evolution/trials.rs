//! The trials of one individual in a generation (Algorithm 3.1, line 3).

use rand::seq::SliceRandom;

use super::experiment::Experiment;
use super::individual::{Individual, Origin};
use super::record::{MOST_LISTED, TrialRecord, UnlistedTrials};
use super::turns::PooledTask;
use crate::learning::{Agent, Gate, Hierarchy, PrimitiveSet, Stopped};
use crate::random::{Purpose, Stream, stream};
use crate::worlds::World;

/// The starts of a generation's trials, the same for every individual: those of the unscored
/// half, then those of the scored half.
#[derive(Clone, Debug)]
pub(super) struct TrialStarts<S> {
    all: Vec<S>,
}

impl<S> TrialStarts<S> {
    pub(super) fn draw<W: World<Start = S>>(
        experiment: &Experiment<W>,
        seed: u64,
        generation: u64,
    ) -> Self {
        let mut rng = stream(seed, generation, 0, Purpose::StartPoses);
        let trials = experiment.scenario.evolution.trials_per_generation;
        let draws = (0..trials).map(|_| experiment.world.draw_start(&mut rng));
        Self {
            all: draws.collect(),
        }
    }

    fn half(&self) -> usize {
        self.all.len() / 2
    }
}

/// The results of an individual's trials.
#[derive(Clone, Debug)]
pub(super) struct TrialResults {
    /// Its hierarchy with what it has learned.
    pub(super) hierarchy: Hierarchy,
    /// The primitive set, which changes only where primitive subtasks learn.
    pub(super) primitives: PrimitiveSet,
    /// The scored trials.
    pub(super) scored: ScoredTrials,
    /// Time steps of all trials.
    pub(super) control_steps: u64,
}

impl TrialResults {
    /// Returns the time steps over the scored trials. Smaller is better (Thesis 4.2).
    pub(super) fn fitness(&self) -> u64 {
        let listed = self
            .scored
            .listed
            .iter()
            .map(|trial| u64::from(trial.steps));
        listed.sum::<u64>() + self.scored.unlisted.map_or(0, |unlisted| unlisted.steps)
    }
}

/// The scored trials of an individual, in the order in which they were run.
#[derive(Clone, Debug, Default)]
pub(super) struct ScoredTrials {
    pub(super) listed: Vec<TrialRecord>,
    pub(super) unlisted: Option<UnlistedTrials>,
}

impl ScoredTrials {
    fn add(&mut self, trial: TrialRecord) {
        if self.listed.len() < MOST_LISTED {
            self.listed.push(trial);
            return;
        }
        let unlisted = self.unlisted.get_or_insert_default();
        unlisted.trials += 1;
        unlisted.delivered += usize::from(trial.delivered);
        unlisted.steps += u64::from(trial.steps);
    }
}

/// Returns whether an individual runs only the scored half of the trials.
///
/// A reproduced individual learned in the generation before; this takes its advantage away
/// (Thesis 3.2).
pub(super) fn is_experienced(individual: &Individual) -> bool {
    individual.origin == Origin::Reproduced
}

/// An individual's trials, run one by one.
///
/// Each half is run in an order of the individual's own. An experienced individual runs only
/// the scored half.
pub(super) struct IndividualTrials<'g, W: World> {
    generation: &'g Generation<'g, W>,
    individual: &'g Individual,
    primitives: &'g PrimitiveSet,
    /// Made by the thread that runs the first trial.
    agent: Option<Agent<'g, W>>,
    rng: Stream,
    first: usize,
    next: usize,
    /// The order of the trials in the present half.
    order: Vec<usize>,
    scored: ScoredTrials,
    control_steps: u64,
}

/// What all individuals of a generation share.
pub(super) struct Generation<'g, W: World> {
    pub(super) experiment: &'g Experiment<W>,
    pub(super) starts: &'g TrialStarts<W::Start>,
    pub(super) seed: u64,
    pub(super) number: u64,
    pub(super) gate: &'g Gate,
    /// Called after every trial.
    pub(super) trial_ended: &'g (dyn Fn() + Sync),
}

impl<'g, W: World> IndividualTrials<'g, W> {
    pub(super) fn new(
        generation: &'g Generation<'g, W>,
        individual: &'g Individual,
        primitives: &'g PrimitiveSet,
    ) -> Self {
        let skips = is_experienced(individual);
        let first = if skips { generation.starts.half() } else { 0 };
        let (seed, number) = (generation.seed, generation.number);
        Self {
            generation,
            individual,
            primitives,
            agent: None,
            rng: stream(seed, number, individual.id, Purpose::Trials),
            first,
            next: first,
            order: Vec::new(),
            scored: ScoredTrials::default(),
            control_steps: 0,
        }
    }

    /// Runs all trials that are left.
    pub(super) fn run(mut self) -> Result<TrialResults, Stopped> {
        while self.left().is_some() {
            self.turn()?;
        }
        Ok(self.into_results())
    }

    pub(super) fn into_results(mut self) -> TrialResults {
        let agent = self.agent.take().unwrap_or_else(|| self.new_agent());
        let (hierarchy, primitives) = agent.into_parts();
        TrialResults {
            hierarchy,
            primitives,
            scored: self.scored,
            control_steps: self.control_steps,
        }
    }

    fn new_agent(&self) -> Agent<'g, W> {
        let hierarchy = self.individual.hierarchy.clone();
        let experiment = self.generation.experiment;
        experiment.agent(hierarchy, self.primitives.clone())
    }
}

impl<W: World> PooledTask for IndividualTrials<'_, W> {
    type Error = Stopped;

    /// Estimates the control steps left. Future trials are taken to be as long as the mean of
    /// the past ones and one at the limit, so that an individual whose first trial is short
    /// is not left until the end.
    fn left(&self) -> Option<f64> {
        let evolution = &self.generation.experiment.scenario.evolution;
        let left = self.generation.starts.all.len() - self.next;
        let past = self.next - self.first;
        let steps = self.control_steps as f64 + f64::from(evolution.trial_step_limit);
        let mean = steps / (past + 1) as f64;
        (left > 0).then_some(left as f64 * mean)
    }

    /// Runs one trial.
    fn turn(&mut self) -> Result<(), Stopped> {
        let generation = self.generation;
        let half = generation.starts.half();
        let is_scored = self.next >= half;
        let half_start = if is_scored { half } else { 0 };
        if self.next == half_start {
            self.order = shuffled(half, &mut self.rng);
        }
        let start = &generation.starts.all[half_start + self.order[self.next - half_start]];
        let limit = generation.experiment.scenario.evolution.trial_step_limit;
        let mut agent = self.agent.take().unwrap_or_else(|| self.new_agent());
        let trial = agent.run_trial(start, limit, &mut self.rng, generation.gate)?;
        self.agent = Some(agent);
        self.control_steps += u64::from(trial.steps);
        if is_scored {
            self.scored.add(TrialRecord {
                steps: trial.steps,
                delivered: trial.done,
            });
        }
        self.next += 1;
        (generation.trial_ended)();
        Ok(())
    }
}

fn shuffled(count: usize, rng: &mut Stream) -> Vec<usize> {
    let mut order: Vec<_> = (0..count).collect();
    order.shuffle(rng);
    order
}
