//! Rollouts: an individual acts while somebody watches.

use std::collections::VecDeque;

use super::policy_map::{MapView, PolicyMap, policy_map};
use super::trial_lengths::TrialLengths;
use super::{InspectedIndividual, Start};
use crate::evolution::{Experiment, TrialRecord};
use crate::learning::{Agent, Explanation, Observer, Trial};
use crate::random::Stream;
use crate::worlds::scene::{Scenic, Snapshot};

/// Trials that the status remembers.
const HISTORY: usize = 256;
/// Places of the present trial that the status remembers.
const TRAIL: usize = 4096;

/// A copy of an individual that acts and learns, trial after trial.
///
/// After the end of a trial its last state stays; the next step begins the next trial.
pub trait Rollout: Send {
    /// Advances by one time step and returns everything that decided it and that it changed.
    ///
    /// Returns `None` if the hierarchy can do nothing, which the typing rules exclude.
    fn step(&mut self) -> Option<StepTrace>;

    /// Advances by `steps` time steps, with the same result as that many calls of
    /// [`Rollout::step`], but faster.
    fn advance(&mut self, steps: u32);

    /// Abandons the present trial and begins the next.
    fn begin_trial(&mut self);

    /// Returns what the present state looks like.
    fn snapshot(&self) -> Snapshot;

    /// Returns the status.
    fn status(&self) -> &RolloutStatus;

    /// Returns the temperature of each node; `None` for primitive subtasks.
    fn temperatures(&self) -> Vec<Option<f32>>;

    /// Returns what the agent would do in each cell with its present knowledge, in the present
    /// variant; `None` where the world has no cells.
    fn cells(&self) -> Option<PolicyMap>;
}

/// The status of a rollout.
#[derive(Clone, Debug, PartialEq)]
pub struct RolloutStatus {
    /// Number of the present trial, from 1.
    pub trial: u64,
    /// Time steps of the present trial.
    pub steps: u32,
    /// Result of the present trial, if it has ended.
    pub ended: Option<TrialRecord>,
    /// Results of the latest trials, including the present one if it has ended; the oldest first.
    pub history: VecDeque<TrialRecord>,
    /// Mean lengths of all trials that have ended.
    pub lengths: TrialLengths,
    /// The nodes from the root to the primitive subtask that acted last; the root alone before
    /// the first step.
    pub path: Vec<usize>,
    /// The action that was executed last.
    pub action: Option<usize>,
    /// The reward of that action.
    pub reward: Option<f32>,
    /// Number of invocations of each node.
    pub visits: Vec<u64>,
    /// Places of the agent in the present trial; the latest last.
    pub trail: VecDeque<[f64; 2]>,
}

/// One time step of a rollout.
#[derive(Clone, Debug, PartialEq)]
pub struct StepTrace {
    /// Number of the trial, from 1.
    pub trial: u64,
    /// Number of the step in it, from 1.
    pub step: u32,
    /// The state before the step.
    pub before: Snapshot,
    /// The state after the step.
    pub after: Snapshot,
    /// The choices, the action, the reward and the updates.
    pub explanation: Explanation,
    /// Result of the trial, if it ended with this step.
    pub ended: Option<TrialRecord>,
}

impl RolloutStatus {
    fn invoke(&mut self, node: usize, child: usize) {
        let depth = self.path.iter().position(|&on_path| on_path == node);
        self.path.truncate(depth.map_or(0, |depth| depth + 1));
        self.path.push(child);
        self.visits[child] += 1;
    }

    fn act(&mut self, action: usize, reward: f32) {
        self.action = Some(action);
        self.reward = Some(reward);
    }
}

/// Updates the status while an agent acts.
struct StatusObserver<'s>(&'s mut RolloutStatus);

impl<W: Scenic> Observer<W> for StatusObserver<'_> {
    fn chose(&mut self, node: usize, child: usize) {
        self.0.invoke(node, child);
    }

    fn acted(&mut self, _node: usize, action: usize, reward: f32, _state: &W::State) {
        self.0.act(action, reward);
    }
}

/// A rollout in a world.
pub(in crate::lab) struct WorldRollout<W: Scenic + 'static> {
    experiment: &'static Experiment<W>,
    agent: Agent<'static, W>,
    trial: Trial<W::State>,
    start: Option<Start>,
    rng: Stream,
    composite: Vec<bool>,
    status: RolloutStatus,
}

impl<W: Scenic> WorldRollout<W> {
    pub(in crate::lab) fn new(
        experiment: &'static Experiment<W>,
        individual: InspectedIndividual<'_>,
        start: Option<Start>,
        mut rng: Stream,
    ) -> Self {
        let hierarchy = individual.individual.hierarchy.clone();
        let composite: Vec<_> = hierarchy.values().iter().map(Option::is_some).collect();
        let mut agent = experiment.agent(hierarchy, individual.primitives.clone());
        let trial = begin(&experiment.world, &mut agent, start, &mut rng);
        let mut rollout = Self {
            status: RolloutStatus {
                trial: 0,
                steps: 0,
                ended: None,
                history: VecDeque::new(),
                lengths: TrialLengths::default(),
                path: Vec::new(),
                action: None,
                reward: None,
                visits: vec![0; composite.len()],
                trail: VecDeque::new(),
            },
            experiment,
            agent,
            trial,
            start,
            rng,
            composite,
        };
        rollout.note_beginning();
        rollout
    }

    fn limit(&self) -> u32 {
        self.experiment.scenario.evolution.trial_step_limit
    }

    fn note_beginning(&mut self) {
        let status = &mut self.status;
        status.trial += 1;
        status.steps = 0;
        status.ended = None;
        status.path = vec![0];
        status.action = None;
        status.reward = None;
        status.visits[0] += 1;
        status.trail.clear();
        self.note_place();
    }

    fn note_place(&mut self) {
        let trail = &mut self.status.trail;
        if trail.len() == TRAIL {
            trail.pop_front();
        }
        trail.push_back(self.experiment.world.position(&self.trial.state));
    }

    fn note_step(&mut self) {
        self.note_place();
        self.status.steps = self.trial.steps;
        if !self.trial.done && self.trial.steps < self.limit() {
            return;
        }
        let record = TrialRecord {
            steps: self.trial.steps,
            delivered: self.trial.done,
        };
        self.status.ended = Some(record);
        self.status.lengths.add(record.steps);
        if self.status.history.len() == HISTORY {
            self.status.history.pop_front();
        }
        self.status.history.push_back(record);
    }

    fn begin_next_trial_if_ended(&mut self) {
        if self.status.ended.is_some() {
            self.begin_trial();
        }
    }
}

impl<W: Scenic> Rollout for WorldRollout<W> {
    fn step(&mut self) -> Option<StepTrace> {
        self.begin_next_trial_if_ended();
        let (limit, before) = (self.limit(), self.snapshot());
        let trial = &mut self.trial;
        let explained = self.agent.advance_explained(trial, limit, &mut self.rng);
        let explanation = explained?;
        for level in explanation.levels.iter().filter(|level| level.chose) {
            self.status.invoke(level.node, level.active);
        }
        self.status
            .act(explanation.action.chosen, explanation.reward);
        self.note_step();
        Some(StepTrace {
            trial: self.status.trial,
            step: self.status.steps,
            before,
            after: self.snapshot(),
            explanation,
            ended: self.status.ended,
        })
    }

    fn advance(&mut self, steps: u32) {
        for _ in 0..steps {
            self.begin_next_trial_if_ended();
            let limit = self.limit();
            let observer = &mut StatusObserver(&mut self.status);
            self.agent
                .advance(&mut self.trial, limit, &mut self.rng, observer);
            self.note_step();
        }
    }

    fn begin_trial(&mut self) {
        let world = &self.experiment.world;
        self.trial = begin(world, &mut self.agent, self.start, &mut self.rng);
        self.note_beginning();
    }

    fn snapshot(&self) -> Snapshot {
        self.experiment.world.snapshot(&self.trial.state)
    }

    fn status(&self) -> &RolloutStatus {
        &self.status
    }

    fn temperatures(&self) -> Vec<Option<f32>> {
        let nodes = self.composite.iter().enumerate();
        nodes
            .map(|(node, composite)| composite.then(|| self.agent.temperature(node)))
            .collect()
    }

    fn cells(&self) -> Option<PolicyMap> {
        let world = &self.experiment.world;
        let [columns, rows] = world.scenery().grid?;
        let view = MapView {
            heading: 0.0,
            variant: self.snapshot().variant,
            columns,
            rows,
        };
        Some(policy_map(world, &mut self.agent.policy(), view, 0))
    }
}

/// Begins a trial in `start` if the agent can be there, else at random.
fn begin<W: Scenic>(
    world: &W,
    agent: &mut Agent<'static, W>,
    start: Option<Start>,
    rng: &mut Stream,
) -> Trial<W::State> {
    let given = start.and_then(|start| world.state_at(start.at, start.heading, start.variant, rng));
    match given {
        Some(state) => agent.begin_in(state),
        None => agent.begin(&world.draw_start(rng), rng),
    }
}
