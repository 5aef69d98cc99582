//! The settings of the foraging task.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::defaults as d;
use crate::worlds::{Exploration, TrainingSettings};

/// A robot finds a battery, captures it and brings it to the nest (Thesis 4.2).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForagingSettings {
    /// Walls, batteries and the nest.
    pub arena: ArenaSettings,
    /// Body of the robot, and the distances at which it captures and delivers.
    #[serde(default)]
    pub robot: RobotSettings,
    /// Proximity sensors, vision and their noise.
    #[serde(default)]
    pub sensors: SensorSettings,
    /// Actions and rewards of the five primitive subtasks (Thesis Table 4.4, Eq. 4.1).
    #[serde(default)]
    pub primitives: PrimitiveSettings,
    /// Numbers of RBF centres (Thesis Table 4.6).
    #[serde(default)]
    pub features: FeatureSettings,
    /// How the primitive subtasks are trained before evolution starts.
    #[serde(default)]
    pub primitive_training: PrimitiveTraining,
    /// Length of a time step in seconds.
    #[serde(default = "time_step")]
    pub time_step_s: f64,
    /// Whether commands to the wheels are primitive subtasks beside the five behaviours: Forward,
    /// Left, Right, HardLeft, HardRight, SpinLeft, SpinRight and Back (Thesis 3.1: "in the
    /// standard MAXQ method each primitive action corresponds to exactly one command"). They are
    /// not trained: each has one action.
    #[serde(default)]
    pub commands: bool,
    /// The robot's memory of places, with the primitive subtask Recall; `null` for none. The
    /// thesis suggests it as future work (chapter 5).
    #[serde(default)]
    pub memory: Option<MemorySettings>,
}

/// A robot that remembers, within a trial, where it last saw the nest and a battery, and keeps
/// the places by dead reckoning.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MemorySettings {
    /// Relative error of the travelled arc in each time step: the arc is taken to be 1 + u times
    /// as long, u uniform between minus and plus this value. Errors add up.
    pub odometry_noise: f64,
}

fn time_step() -> f64 {
    d::TIME_STEP_S
}

/// A closed rectangle from the origin to `size_mm`: walls, batteries and nest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArenaSettings {
    /// Extent along x and y. The four outer walls stand on its edges.
    #[serde(default = "arena_size")]
    pub size_mm: [f64; 2],
    /// Inner walls, each a segment `[x1, y1, x2, y2]`.
    #[serde(default)]
    pub walls_mm: Vec<[f64; 4]>,
    /// Inner walls with slits in them.
    #[serde(default)]
    pub fences: Vec<FenceSettings>,
    /// Transparent inner walls, each a segment `[x1, y1, x2, y2]`: they stop bodies and proximity
    /// rays, not sight. A target behind one is seen but cannot be reached straight on.
    #[serde(default)]
    pub transparent_walls_mm: Vec<[f64; 4]>,
    /// Centres of the battery packs, `[x, y]`.
    pub batteries_mm: Vec<[f64; 2]>,
    /// Centre of the nest, `[x, y]`.
    pub nest_mm: [f64; 2],
}

fn arena_size() -> [f64; 2] {
    [d::ARENA_SIDE_MM; 2]
}

/// A straight wall with slits. The robot sees through every slit, but fits only through wide ones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FenceSettings {
    /// One end, `[x, y]`.
    pub from_mm: [f64; 2],
    /// The other end, `[x, y]`.
    pub to_mm: [f64; 2],
    /// Width of every slit.
    pub slit_width_mm: f64,
    /// Distances of the slits' centres from `from_mm`, ascending.
    pub slits_at_mm: Vec<f64>,
}

impl FenceSettings {
    /// Returns the distance between the ends in millimetres.
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        let [x1, y1] = self.from_mm;
        let [x2, y2] = self.to_mm;
        ((x2 - x1) * (x2 - x1) + (y2 - y1) * (y2 - y1)).sqrt()
    }

    /// Returns the solid pieces between the slits, as walls `[x1, y1, x2, y2]`.
    #[must_use]
    pub fn pieces(&self) -> Vec<[f64; 4]> {
        let length = self.length_mm();
        let half = self.slit_width_mm / 2.0;
        let starts = std::iter::once(0.0).chain(self.slits_at_mm.iter().map(|at| at + half));
        let ends = self
            .slits_at_mm
            .iter()
            .map(|at| at - half)
            .chain(std::iter::once(length));
        let point = |along: f64| {
            let share = along / length;
            [0, 1].map(|axis| self.from_mm[axis] + share * (self.to_mm[axis] - self.from_mm[axis]))
        };
        starts
            .zip(ends)
            .map(|(start, end)| {
                let ([x1, y1], [x2, y2]) = (point(start), point(end));
                [x1, y1, x2, y2]
            })
            .collect()
    }
}

/// The robot: a disc with two driven wheels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RobotSettings {
    /// Radius of the body.
    pub radius_mm: f64,
    /// Distance between the wheels.
    pub wheel_base_mm: f64,
    /// Distance between the centres at which a visible battery is captured.
    pub capture_distance_mm: f64,
    /// Distance between the centres at which a carrying robot reaches a visible nest.
    pub delivery_distance_mm: f64,
}

impl Default for RobotSettings {
    fn default() -> Self {
        Self {
            radius_mm: d::ROBOT_RADIUS_MM,
            wheel_base_mm: d::WHEEL_BASE_MM,
            capture_distance_mm: d::CAPTURE_DISTANCE_MM,
            delivery_distance_mm: d::DELIVERY_DISTANCE_MM,
        }
    }
}

/// The sensors of the robot (Thesis 4.1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SensorSettings {
    /// Directions of the five proximity sensors, relative to the heading, positive
    /// to the left.
    pub proximity_angles_deg: [f64; 5],
    /// Smallest and largest proximity reading, measured from the body's surface.
    pub proximity_range_mm: [f64; 2],
    /// A target is visible within this angle of the heading.
    pub vision_half_angle_deg: f64,
    /// A target is visible within this distance of the robot's centre.
    pub vision_range_mm: f64,
    /// Relative noise: a reading is multiplied by 1 + u, u uniform between minus and plus this
    /// value, and then clipped to its range.
    pub noise: f64,
}

impl Default for SensorSettings {
    fn default() -> Self {
        Self {
            proximity_angles_deg: d::PROXIMITY_ANGLES_DEG,
            proximity_range_mm: d::PROXIMITY_RANGE_MM,
            vision_half_angle_deg: d::VISION_HALF_ANGLE_DEG,
            vision_range_mm: d::VISION_RANGE_MM,
            noise: d::SENSOR_NOISE,
        }
    }
}

/// The five primitive subtasks (Thesis Tables 4.3 and 4.4, Eq. 4.1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PrimitiveSettings {
    /// Avoid hitting walls.
    pub avoid: MovementSettings,
    /// Explore the environment.
    pub wander: MovementSettings,
    /// Approach and capture a battery.
    pub approach_battery: TargetSettings,
    /// Bring the battery to the nest.
    pub approach_nest: TargetSettings,
    /// Rotate to a battery or the nest.
    pub turn: TargetSettings,
}

impl Default for PrimitiveSettings {
    fn default() -> Self {
        let approach = TargetSettings {
            actions_mm_per_s: d::APPROACH_ACTIONS.to_vec(),
            reward_offset: 0.0,
            reward_divisor_deg: d::APPROACH_REWARD_DIVISOR_DEG,
            failure_reward: d::FAILURE_REWARD,
        };
        Self {
            avoid: MovementSettings {
                actions_mm_per_s: d::AVOID_ACTIONS.to_vec(),
                rewards: d::AVOID_REWARDS.to_vec(),
                failure_reward: d::FAILURE_REWARD,
            },
            wander: MovementSettings {
                actions_mm_per_s: d::WANDER_ACTIONS.to_vec(),
                rewards: d::WANDER_REWARDS.to_vec(),
                failure_reward: d::FAILURE_REWARD,
            },
            approach_battery: approach.clone(),
            approach_nest: approach,
            turn: TargetSettings {
                actions_mm_per_s: d::TURN_ACTIONS.to_vec(),
                reward_offset: d::TURN_REWARD_OFFSET,
                reward_divisor_deg: d::TURN_REWARD_DIVISOR_DEG,
                failure_reward: d::FAILURE_REWARD,
            },
        }
    }
}

/// A primitive subtask that is rewarded for its movement: Avoid, Wander.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MovementSettings {
    /// Actions as `[right, left]` wheel speeds, in that order.
    pub actions_mm_per_s: Vec<[f64; 2]>,
    /// Reward of each action while no wall is too near.
    pub rewards: Vec<f64>,
    /// Reward if any proximity reading is the smallest possible.
    pub failure_reward: f64,
}

/// A primitive subtask that is rewarded for a small angle to its target: Approach
/// battery, Approach nest, Turn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetSettings {
    /// Actions as `[right, left]` wheel speeds, in that order.
    pub actions_mm_per_s: Vec<[f64; 2]>,
    /// The reward is `reward_offset` minus the angle over `reward_divisor_deg`.
    pub reward_offset: f64,
    /// The angle to the target, in degrees, is divided by this.
    pub reward_divisor_deg: f64,
    /// Reward when the target is not visible.
    pub failure_reward: f64,
}

/// Numbers of RBF centres along each input (Thesis Table 4.6).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FeatureSettings {
    /// Centres for each proximity sensor. Their product over five sensors is the width of Find
    /// battery, Find nest, Avoid and Wander, and of each state type's block in Capture, Deliver
    /// and Root.
    pub proximity_centres: usize,
    /// Centres over the angle in Visible battery and Visible nest.
    pub angle_centres: usize,
    /// Centres over the distance in Visible battery and Visible nest.
    pub distance_centres: usize,
    /// Centres over the angle in Approach battery and Approach nest.
    pub approach_centres: usize,
    /// Centres over the angle in Turn.
    pub turn_centres: usize,
    /// What "the variance of the RBFs is sqrt(2) times their spacing" (Thesis 4.4) means.
    pub rbf_width: RbfWidth,
}

impl Default for FeatureSettings {
    fn default() -> Self {
        Self {
            proximity_centres: d::PROXIMITY_CENTRES,
            angle_centres: d::ANGLE_CENTRES,
            distance_centres: d::DISTANCE_CENTRES,
            approach_centres: d::APPROACH_CENTRES,
            turn_centres: d::TURN_CENTRES,
            rbf_width: RbfWidth::default(),
        }
    }
}

/// Width of the Gaussian features, from the spacing h of their centres on [0, 1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RbfWidth {
    /// sigma = sqrt(2) h.
    #[default]
    Spacing,
    /// sigma^2 = sqrt(2) h.
    Variance,
}

/// Training of each primitive subtask, alone and in the scenario's own arena.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PrimitiveTraining {
    /// Training of Avoid.
    pub avoid: TrainingSettings,
    /// Training of Wander.
    pub wander: TrainingSettings,
    /// Training of Approach battery.
    pub approach_battery: TrainingSettings,
    /// Training of Approach nest.
    pub approach_nest: TrainingSettings,
    /// Training of Turn.
    pub turn: TrainingSettings,
}

impl Default for PrimitiveTraining {
    fn default() -> Self {
        let exploring = TrainingSettings {
            steps: d::TRAINING_STEPS,
            episode_steps: d::EXPLORING_EPISODE_STEPS,
            exploration: Exploration::Uniform,
            temperature_decrease: d::EXPLORING_TEMPERATURE_DECREASE,
        };
        let targeting = TrainingSettings {
            steps: d::TRAINING_STEPS,
            episode_steps: d::TARGET_EPISODE_STEPS,
            exploration: Exploration::Softmax,
            temperature_decrease: d::TARGET_TEMPERATURE_DECREASE,
        };
        Self {
            avoid: exploring.clone(),
            wander: exploring,
            approach_battery: targeting.clone(),
            approach_nest: targeting.clone(),
            turn: targeting,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Returns the settings of a shipped environment.
    pub(in super::super) fn environment(number: usize) -> ForagingSettings {
        let scenarios = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios");
        let text = std::fs::read_to_string(format!("{scenarios}/environment-{number}.json"));
        let mut scenario: serde_json::Value = serde_json::from_str(&text.unwrap()).unwrap();
        serde_json::from_value(scenario["world"]["foraging"].take()).unwrap()
    }

    #[test]
    fn a_fence_is_cut_at_its_slits() {
        let fence = FenceSettings {
            from_mm: [2000.0, 1400.0],
            to_mm: [2000.0, 2000.0],
            slit_width_mm: 44.0,
            slits_at_mm: vec![60.0, 180.0],
        };
        assert_eq!(
            fence.pieces(),
            [
                [2000.0, 1400.0, 2000.0, 1438.0],
                [2000.0, 1482.0, 2000.0, 1558.0],
                [2000.0, 1602.0, 2000.0, 2000.0],
            ]
        );
    }
}
