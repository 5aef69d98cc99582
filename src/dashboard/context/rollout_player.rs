//! The rollout player: a rollout of the inspected individual, at a chosen speed.

use std::collections::VecDeque;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use crate::evolution::EvolutionState;
use crate::hierarchy::Tree;
use crate::lab::AnyExperiment;
use crate::lab::inspection::{InspectedIndividual, PolicyMap, Rollout, Start, StepTrace};

/// Speeds of a rollout, as multiples of real time.
pub const SPEEDS: [u32; 10] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
/// Index of the initial speed, at which motion can be seen and a trial takes a second or two.
const FIRST_SPEED: usize = 3;

/// Duration of a time step in a world without real time, in seconds.
const NOMINAL_STEP_S: f64 = 0.2;

/// Up to this speed every time step is drawn, and the end of a trial is held for a moment.
const SLOW: u32 = 50;
const HOLD: Duration = Duration::from_millis(700);

/// Time after which a rollout gives way to a new best individual, even within a trial.
const PATIENCE: Duration = Duration::from_secs(5);

/// Most time steps between two frames.
const MOST_STEPS: u32 = 5_000;

/// Number of recorded time steps.
const RECORDED: usize = 500;

/// The individual of a rollout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subject {
    /// The generation that the individual was taken from.
    pub generation: u64,
    /// The id of the individual.
    pub id: u64,
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "individual {}, generation {}", self.id, self.generation)
    }
}

/// A recorded time step.
struct Recorded {
    trace: StepTrace,
    /// The policy in each cell after the step; `None` in a world without cells.
    cells: Option<PolicyMap>,
}

/// A rollout of the inspected individual.
///
/// The player works on a copy with its own random stream, so that watching never affects
/// evolution.
pub struct RolloutPlayer {
    experiment: &'static dyn AnyExperiment,
    population: Option<Arc<EvolutionState>>,
    /// The generation that is being loaded, and the last generation that could not be loaded.
    requested: Option<u64>,
    failed: Option<(u64, String)>,
    /// The generation that was asked for when the population of another was loaded.
    stands_for: Option<u64>,
    subject: Option<Subject>,
    rollout: Option<Box<dyn Rollout>>,
    /// Recorded steps, the latest first.
    recorded: VecDeque<Recorded>,
    restarts: u64,
    /// The start state of trials, if the user has set one.
    start: Option<Start>,
    halted: bool,
    speed: usize,
    steps_due: f64,
    shown_for: Duration,
    held_for: Duration,
}

impl RolloutPlayer {
    pub(in crate::dashboard) fn new(experiment: &'static dyn AnyExperiment) -> Self {
        Self {
            experiment,
            population: None,
            requested: None,
            failed: None,
            stands_for: None,
            subject: None,
            rollout: None,
            recorded: VecDeque::new(),
            restarts: 0,
            start: None,
            halted: false,
            speed: FIRST_SPEED,
            steps_due: 0.0,
            shown_for: Duration::ZERO,
            held_for: Duration::ZERO,
        }
    }

    /// Returns the loaded population, with everything that it has learned.
    #[must_use]
    pub fn population(&self) -> Option<&Arc<EvolutionState>> {
        self.population.as_ref()
    }

    /// The individual of a rollout.
    #[must_use]
    pub fn subject(&self) -> Option<Subject> {
        self.subject
    }

    /// Returns the individual, with what it had learned before the rollout.
    #[must_use]
    pub fn individual(&self) -> Option<InspectedIndividual<'_>> {
        InspectedIndividual::with_id(self.population.as_deref()?, self.subject?.id)
    }

    /// Returns the hierarchy of the individual.
    #[must_use]
    pub fn tree(&self) -> Option<&Tree> {
        Some(self.individual()?.individual.hierarchy.tree())
    }

    /// Returns the rollout.
    #[must_use]
    pub fn rollout(&self) -> Option<&dyn Rollout> {
        self.rollout.as_deref()
    }

    /// Returns a recorded time step with everything that decided it, `back` steps before the
    /// latest.
    ///
    /// A rollout above real-time drawing speed records one step per frame.
    #[must_use]
    pub fn trace(&self, back: usize) -> Option<&StepTrace> {
        Some(&self.recorded.get(back)?.trace)
    }

    /// Returns the policy in each cell after the step `back` steps before the latest,
    /// everything but the agent's position as it was then.
    ///
    /// `None` in a world without cells.
    #[must_use]
    pub fn cells(&self, back: usize) -> Option<&PolicyMap> {
        self.recorded.get(back)?.cells.as_ref()
    }

    /// Returns the number of recorded steps.
    #[must_use]
    pub fn recorded_steps(&self) -> usize {
        self.recorded.len()
    }

    /// Returns the positions of the agent in the trial of a recorded step, up to that step, the
    /// latest last.
    ///
    /// The current trial has all its positions, an earlier one those that were recorded.
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

    /// Returns why the population could not be loaded.
    #[must_use]
    pub fn load_error(&self) -> Option<&str> {
        self.failed.as_ref().map(|(_, why)| why.as_str())
    }

    /// Returns whether the rollout is halted.
    #[must_use]
    pub fn halted(&self) -> bool {
        self.halted
    }

    /// Halts or resumes the rollout.
    pub fn toggle_halt(&mut self) {
        self.halted = !self.halted;
        self.steps_due = 0.0;
    }

    /// Halts the rollout.
    pub fn halt(&mut self) {
        self.halted = true;
        self.steps_due = 0.0;
    }

    /// Returns the speed of the rollout, as a multiple of real time.
    #[must_use]
    pub fn speed(&self) -> u32 {
        SPEEDS[self.speed.min(SPEEDS.len() - 1)]
    }

    /// Returns whether the speed can be raised, or lowered.
    #[must_use]
    pub fn can_change_speed(&self, faster: bool) -> bool {
        let end = if faster { SPEEDS.len() - 1 } else { 0 };
        self.speed != end
    }

    /// Raises or lowers the speed.
    pub fn change_speed(&mut self, faster: bool) {
        self.speed = if faster {
            (self.speed + 1).min(SPEEDS.len() - 1)
        } else {
            self.speed.saturating_sub(1)
        };
    }

    /// Halts the rollout and takes one recorded time step.
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

    /// Lets all trials of all rollouts start at `start`.
    pub(in crate::dashboard) fn start_at(&mut self, start: Start) {
        self.start = Some(start);
    }

    /// Starts a new rollout of the same individual: with another random stream, and without
    /// what it learned in the last one.
    pub fn restart(&mut self) {
        self.restarts += 1;
        self.begin();
    }

    /// Abandons the current trial and starts the next.
    pub fn next_trial(&mut self) {
        if let Some(rollout) = &mut self.rollout {
            rollout.begin_trial();
        }
    }

    /// Receives a loaded population, or why it could not be loaded.
    pub(in crate::dashboard) fn receive(
        &mut self,
        generation: u64,
        state: Result<Arc<EvolutionState>, String>,
    ) {
        if self.requested == Some(generation) {
            self.requested = None;
        }
        match state {
            Ok(state) => {
                self.failed = None;
                self.stands_for = Some(generation).filter(|_| state.generation != generation);
                self.population = Some(state);
            }
            Err(why) => self.failed = Some((generation, why)),
        }
    }

    /// Switches to the inspected individual; returns the generation that must be loaded for it.
    ///
    /// `by_choice` means that the user chose the individual. Otherwise evolution did, and the
    /// current trial may end first.
    pub(in crate::dashboard) fn switch_to(
        &mut self,
        wanted: Option<Subject>,
        by_choice: bool,
    ) -> Option<u64> {
        let wanted = self.available(wanted?);
        let here = self.subject;
        if here == Some(wanted) {
            return None;
        }
        if !by_choice && here.is_some() && !self.gives_way() {
            return None;
        }
        let loaded = self.population.as_ref().map(|state| state.generation);
        if loaded != Some(wanted.generation) {
            let failed = self.failed.as_ref().map(|(generation, _)| *generation);
            if failed == Some(wanted.generation) {
                self.subject = None;
                self.rollout = None;
                return None;
            }
            if self.requested == Some(wanted.generation) {
                return None;
            }
            self.requested = Some(wanted.generation);
            return self.requested;
        }
        self.subject = Some(wanted);
        // An individual that survives into the next generation continues its rollout.
        if by_choice || here.is_none_or(|here| here.id != wanted.id) {
            self.begin();
        } else {
            self.shown_for = Duration::ZERO;
        }
        None
    }

    /// Returns the individual to show for the wanted one: if the loaded population stands in for
    /// that of its generation, the one of the same id, or else the best.
    fn available(&self, wanted: Subject) -> Subject {
        let stands_in = self.stands_for == Some(wanted.generation);
        let Some(state) = self.population.as_ref().filter(|_| stands_in) else {
            return wanted;
        };
        let is_there = InspectedIndividual::with_id(state, wanted.id).is_some();
        let best = state.individuals.first();
        Subject {
            generation: state.generation,
            id: match best {
                Some(best) if !is_there => best.id,
                _ => wanted.id,
            },
        }
    }

    fn gives_way(&self) -> bool {
        let ended = self
            .rollout
            .as_ref()
            .is_none_or(|rollout| rollout.status().ended.is_some());
        !self.halted && (ended || self.shown_for >= PATIENCE)
    }

    fn begin(&mut self) {
        let (experiment, number, start) = (self.experiment, self.restarts, self.start);
        let rollout = self
            .individual()
            .map(|individual| experiment.rollout(individual, number, start));
        self.rollout = rollout;
        self.recorded.clear();
        self.steps_due = 0.0;
        self.shown_for = Duration::ZERO;
        self.held_for = Duration::ZERO;
    }

    /// Lets time pass; returns whether anything has changed.
    pub(in crate::dashboard) fn tick(&mut self, elapsed: Duration) -> bool {
        let speed = self.speed();
        let (false, Some(rollout)) = (self.halted, &self.rollout) else {
            return false;
        };
        self.shown_for += elapsed;
        if rollout.status().ended.is_some() && speed <= SLOW {
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
        self.steps_due += elapsed.as_secs_f64() * f64::from(speed) / step_s;
        let steps = (self.steps_due as u32).min(MOST_STEPS);
        if steps == 0 {
            return false;
        }
        self.steps_due = self.steps_due.fract();
        if speed > SLOW {
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
