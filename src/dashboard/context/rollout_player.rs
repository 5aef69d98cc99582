//! The player: a rollout of the individual that is looked at.

use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use crate::evolution::EvolutionState;
use crate::hierarchy::Tree;
use crate::lab::AnyExperiment;
use crate::lab::inspection::{InspectedIndividual, PolicyMap, Rollout, Start, StepTrace};

/// Speeds of a rollout: times real time.
pub const SPEEDS: [u32; 10] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
/// A speed at which a robot is seen to move and a trial takes a second or two.
const FIRST_SPEED: usize = 3;

/// What a time step lasts in a world whose time is not real.
const NOMINAL_STEP_S: f64 = 0.2;

/// Up to this speed the end of a trial is held for a moment.
const UNHURRIED: u32 = 50;
const HOLD: Duration = Duration::from_millis(700);

/// Time after which a rollout gives way to the new best of evolution, in the middle of
/// a trial too.
const PATIENCE: Duration = Duration::from_secs(5);

/// Most time steps between two frames.
const MOST_STEPS: u32 = 5_000;

/// Time steps that are recorded.
const RECORDED: usize = 500;

/// Whose rollout it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subject {
    /// The generation that it was taken from.
    pub generation: u64,
    /// The individual.
    pub id: u64,
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "individual {}, generation {}", self.id, self.generation)
    }
}

/// A step that was recorded.
struct Recorded {
    trace: StepTrace,
    /// What the agent would do in each cell after it; `None` where the world has no cells.
    cells: Option<PolicyMap>,
}

/// A rollout of the individual that is looked at, on a copy with a random stream of its
/// own: watching never touches evolution.
pub struct RolloutPlayer {
    experiment: &'static dyn AnyExperiment,
    population: Option<Arc<EvolutionState>>,
    /// The generation that was asked for last, and why it is not there.
    asked: Option<u64>,
    refused: Option<(u64, String)>,
    subject: Option<Subject>,
    rollout: Option<Box<dyn Rollout>>,
    /// The latest first.
    recorded: VecDeque<Recorded>,
    number: u64,
    /// Where trials begin, if the person has said so.
    start: Option<Start>,
    halted: bool,
    speed: usize,
    owed: f64,
    shown_for: Duration,
    held_for: Duration,
}

impl RolloutPlayer {
    pub(in crate::dashboard) fn new(experiment: &'static dyn AnyExperiment) -> Self {
        Self {
            experiment,
            population: None,
            asked: None,
            refused: None,
            subject: None,
            rollout: None,
            recorded: VecDeque::new(),
            number: 0,
            start: None,
            halted: false,
            speed: FIRST_SPEED,
            owed: 0.0,
            shown_for: Duration::ZERO,
            held_for: Duration::ZERO,
        }
    }

    /// The population on the player, with everything that it has learned.
    #[must_use]
    pub fn population(&self) -> Option<&Arc<EvolutionState>> {
        self.population.as_ref()
    }

    /// Whose rollout it is.
    #[must_use]
    pub fn subject(&self) -> Option<Subject> {
        self.subject
    }

    /// The individual on the player, with what it had learned when it came there.
    #[must_use]
    pub fn individual(&self) -> Option<InspectedIndividual<'_>> {
        InspectedIndividual::with_id(self.population.as_deref()?, self.subject?.id)
    }

    /// The hierarchy of the individual on the player.
    #[must_use]
    pub fn tree(&self) -> Option<&Tree> {
        Some(self.individual()?.individual.hierarchy.tree())
    }

    /// The rollout.
    #[must_use]
    pub fn rollout(&self) -> Option<&dyn Rollout> {
        self.rollout.as_deref()
    }

    /// A time step with everything that decided it, the last but some: of a rollout that
    /// runs, one step a frame is recorded.
    #[must_use]
    pub fn trace(&self, back: usize) -> Option<&StepTrace> {
        Some(&self.recorded.get(back)?.trace)
    }

    /// What the agent would do in each cell, with what it had learned by the end of that step,
    /// all but its place being as it was then; `None` where the world has no cells.
    #[must_use]
    pub fn cells(&self, back: usize) -> Option<&PolicyMap> {
        self.recorded.get(back)?.cells.as_ref()
    }

    /// How many steps are recorded.
    #[must_use]
    pub fn recorded_steps(&self) -> usize {
        self.recorded.len()
    }

    /// Where the agent has been in the trial of a recorded step, up to that step, the latest
    /// place last: all places of the present trial, of an earlier one those that are recorded.
    #[must_use]
    pub fn trail(&self, back: usize) -> Vec<[f64; 2]> {
        let (Some(rollout), Some(trace)) = (&self.rollout, self.trace(back)) else {
            return Vec::new();
        };
        let status = rollout.status();
        if status.trial == trace.trial {
            let later = status.steps.saturating_sub(trace.step) as usize;
            let until = status.trail.len().saturating_sub(later);
            return status.trail.iter().take(until).copied().collect();
        }
        let before = self.recorded.iter().skip(back).map(|step| &step.trace);
        let trial = before.take_while(|before| before.trial == trace.trial);
        let mut trail: Vec<_> = trial
            .flat_map(|step| [step.after.at, step.before.at])
            .collect();
        trail.reverse();
        trail
    }

    /// Why there is nothing on the player.
    #[must_use]
    pub fn load_error(&self) -> Option<&str> {
        self.refused.as_ref().map(|(_, why)| why.as_str())
    }

    /// Whether the rollout is halted.
    #[must_use]
    pub fn halted(&self) -> bool {
        self.halted
    }

    /// Halts the rollout, or lets it go on.
    pub fn toggle_halt(&mut self) {
        self.halted = !self.halted;
        self.owed = 0.0;
    }

    /// Halts the rollout.
    pub fn halt(&mut self) {
        self.halted = true;
        self.owed = 0.0;
    }

    /// Speed of the rollout: times real time.
    #[must_use]
    pub fn speed(&self) -> u32 {
        SPEEDS[self.speed.min(SPEEDS.len() - 1)]
    }

    /// Whether it can be made faster, or slower.
    #[must_use]
    pub fn can_change_speed(&self, faster: bool) -> bool {
        let end = if faster { SPEEDS.len() - 1 } else { 0 };
        self.speed != end
    }

    /// Makes the rollout faster, or slower.
    pub fn change_speed(&mut self, faster: bool) {
        self.speed = match faster {
            true => (self.speed + 1).min(SPEEDS.len() - 1),
            false => self.speed.saturating_sub(1),
        };
    }

    /// Halts the rollout and takes one time step, with everything that decided it.
    pub fn step(&mut self) {
        self.halt();
        self.record();
    }

    fn record(&mut self) {
        let Some(rollout) = &mut self.rollout else {
            return;
        };
        if let Some(trace) = rollout.step() {
            let cells = rollout.cells();
            self.recorded.truncate(RECORDED - 1);
            self.recorded.push_front(Recorded { trace, cells });
        }
    }

    /// Lets all trials of all rollouts begin there.
    pub(in crate::dashboard) fn begin_at(&mut self, start: Start) {
        self.start = Some(start);
    }

    /// Begins another rollout of the same individual: another start, other chances, and
    /// nothing kept of what the last one learned.
    pub fn restart(&mut self) {
        self.number += 1;
        self.begin();
    }

    /// Gives the present trial up and begins the next.
    pub fn next_trial(&mut self) {
        if let Some(rollout) = &mut self.rollout {
            rollout.begin_trial();
        }
    }

    /// Takes in a population, or why there is none.
    pub(in crate::dashboard) fn receive(
        &mut self,
        generation: u64,
        state: Result<Arc<EvolutionState>, String>,
    ) {
        if self.asked == Some(generation) {
            self.asked = None;
        }
        match state {
            Ok(state) => {
                self.refused = None;
                self.population = Some(state);
            }
            Err(why) => self.refused = Some((generation, why)),
        }
    }

    /// Puts the individual on the player that the person looks at. `by_choice` tells
    /// whether the person chose it, or evolution went on by itself: then the trial on the
    /// player may end. Returns the generation to be loaded for it.
    pub(in crate::dashboard) fn want(
        &mut self,
        wanted: Option<Subject>,
        by_choice: bool,
    ) -> Option<u64> {
        let wanted = wanted?;
        let here = self.subject;
        if here == Some(wanted) {
            return None;
        }
        if !by_choice && here.is_some() && !self.gives_way() {
            return None;
        }
        let loaded = self.population.as_ref().map(|state| state.generation);
        if loaded != Some(wanted.generation) {
            let refused = self.refused.as_ref().map(|(generation, _)| *generation);
            if refused == Some(wanted.generation) {
                self.subject = None;
                self.rollout = None;
                return None;
            }
            if self.asked == Some(wanted.generation) {
                return None;
            }
            self.asked = Some(wanted.generation);
            return self.asked;
        }
        self.subject = Some(wanted);
        // An individual that lives on goes on with what it is doing.
        if by_choice || here.is_none_or(|here| here.id != wanted.id) {
            self.begin();
        } else {
            self.shown_for = Duration::ZERO;
        }
        None
    }

    fn gives_way(&self) -> bool {
        let ended = self
            .rollout
            .as_ref()
            .is_none_or(|rollout| rollout.status().ended.is_some());
        !self.halted && (ended || self.shown_for >= PATIENCE)
    }

    fn begin(&mut self) {
        let (experiment, number, start) = (self.experiment, self.number, self.start);
        let rollout = self
            .individual()
            .map(|individual| experiment.rollout(individual, number, start));
        self.rollout = rollout;
        self.recorded.clear();
        self.owed = 0.0;
        self.shown_for = Duration::ZERO;
        self.held_for = Duration::ZERO;
    }

    /// Lets time go by. Whether anything has changed.
    pub(in crate::dashboard) fn tick(&mut self, elapsed: Duration) -> bool {
        let speed = self.speed();
        let (false, Some(rollout)) = (self.halted, &self.rollout) else {
            return false;
        };
        self.shown_for += elapsed;
        if rollout.status().ended.is_some() && speed <= UNHURRIED {
            self.held_for += elapsed;
            if self.held_for < HOLD {
                return false;
            }
            self.held_for = Duration::ZERO;
        }
        let step_s = self
            .experiment
            .scenery()
            .time_step_s
            .unwrap_or(NOMINAL_STEP_S);
        self.owed += elapsed.as_secs_f64() * f64::from(speed) / step_s;
        let steps = (self.owed as u32).min(MOST_STEPS);
        if steps == 0 {
            return false;
        }
        self.owed = self.owed.fract();
        if speed > UNHURRIED {
            if let Some(rollout) = &mut self.rollout {
                rollout.advance(steps - 1);
            }
            self.record();
            return true;
        }
        for _ in 0..steps {
            self.record();
            if self.trace(0).is_some_and(|trace| trace.ended.is_some()) {
                break;
            }
        }
        true
    }
}
