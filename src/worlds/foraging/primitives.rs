//! What the primitive subtasks do: their actions, their rewards, and how they are trained.

use super::defaults::COMMANDS;
use super::motion::Arc;
use super::sensors::TargetReading;
use super::settings::{ForagingSettings, MovementSettings, TargetSettings};
use crate::worlds::TrainingSettings;

/// The reward of a primitive subtask (Thesis Eq. 4.1).
#[derive(Clone, Debug)]
pub(super) enum Reward {
    /// It depends on the action, unless a wall is too near: Avoid, Wander.
    Movement { actions: Vec<f32>, failure: f32 },
    /// It depends on the angle to the target: Approach battery, Approach nest, Turn.
    Target {
        offset: f32,
        divisor_deg: f32,
        failure: f32,
    },
    /// There is none: a command.
    Zero,
}

/// The actions of a primitive subtask, their rewards, and its training.
#[derive(Clone, Debug)]
pub(super) struct Primitive {
    pub(super) arcs: Vec<Arc>,
    pub(super) reward: Reward,
    pub(super) training: Option<TrainingSettings>,
}

impl Primitive {
    /// Returns the reward of an action (Thesis Eq. 4.1), from the readings after it.
    /// `is_blocked` says whether a proximity reading is the smallest possible.
    pub(super) fn reward(
        &self,
        action: usize,
        is_blocked: bool,
        target: Option<TargetReading>,
    ) -> f32 {
        match &self.reward {
            Reward::Movement { failure, .. } if is_blocked => *failure,
            Reward::Movement { actions, .. } => actions[action],
            Reward::Target {
                offset,
                divisor_deg,
                failure,
            } => target.map_or(*failure, |target| {
                offset - target.angle_deg.abs() / divisor_deg
            }),
            Reward::Zero => 0.0,
        }
    }
}

/// Returns the primitive subtasks of a scenario in the catalogue's order, without Recall.
pub(super) fn primitives(settings: &ForagingSettings) -> Vec<Primitive> {
    let arcs = |actions: &[[f64; 2]]| {
        let arc = |&speeds| Arc::new(speeds, settings.robot.wheel_base_mm, settings.time_step_s);
        actions.iter().map(arc).collect()
    };
    let movement = |subtask: &MovementSettings, training: &TrainingSettings| Primitive {
        arcs: arcs(&subtask.actions_mm_per_s),
        reward: Reward::Movement {
            actions: subtask
                .rewards
                .iter()
                .map(|&reward| reward as f32)
                .collect(),
            failure: subtask.failure_reward as f32,
        },
        training: Some(training.clone()),
    };
    let target = |subtask: &TargetSettings, training: &TrainingSettings| Primitive {
        arcs: arcs(&subtask.actions_mm_per_s),
        reward: Reward::Target {
            offset: subtask.reward_offset as f32,
            divisor_deg: subtask.reward_divisor_deg as f32,
            failure: subtask.failure_reward as f32,
        },
        training: Some(training.clone()),
    };
    let commands = COMMANDS.iter().filter(|_| settings.commands);
    let commands = commands.map(|(_, speeds)| Primitive {
        arcs: arcs(&[*speeds]),
        reward: Reward::Zero,
        training: None,
    });
    let (p, t) = (&settings.primitives, &settings.primitive_training);
    let behaviours = [
        movement(&p.avoid, &t.avoid),
        movement(&p.wander, &t.wander),
        target(&p.approach_battery, &t.approach_battery),
        target(&p.approach_nest, &t.approach_nest),
        target(&p.turn, &t.turn),
    ];
    behaviours.into_iter().chain(commands).collect()
}
