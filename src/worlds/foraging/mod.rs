//! The foraging task (Thesis 4.1 to 4.3): find a battery, capture it, bring it home.
//!
//! # Arena
//! A closed rectangle with straight inner walls; a wall blocks bodies, proximity
//! rays and sight. Batteries and the nest block nothing. Units are millimetres,
//! seconds and radians; heading 0 points along +x, positive angles are
//! counter-clockwise, to the robot's left.
//!
//! # Robot
//! A disc with two driven wheels. An action is a pair (right, left) of wheel speeds
//! held for one time step and followed exactly along its arc; the disc slides along
//! walls and never enters one, while the heading always follows the arc.
//!
//! # Readings
//! Five proximity rays measured from the body's surface, and the angle and distance
//! of the target: the closest visible battery while empty-handed, the nest while
//! carrying. A reading r becomes r (1 + u), u uniform in plus or minus the noise,
//! and is then clipped to its range. Visibility, collision, capture and delivery are
//! judged on the true geometry.
//!
//! # State types (Thesis Table 4.1)
//! 1: empty-handed, no battery visible. 2: empty-handed, battery visible.
//! 3: carrying, nest not visible. 4: carrying, nest visible.
//!
//! # Start, reward, end
//! A trial starts at a random free pose, empty-handed, all batteries in place. A
//! visible battery within the capture distance is captured; a carrying robot whose
//! visible nest is within the delivery distance has delivered, and the trial ends.
//! Delivery needs a step that began carrying. Rewards are those of Thesis Eq. 4.1 on
//! the readings after the action; for the step that captures or delivers, on the
//! target just reached.

use nalgebra::{Point2, Vector2};
use rand::RngExt;

mod arena;
mod catalogue;
pub mod defaults;
mod motion;
mod probes;
mod rays;
mod rules;
mod scene;
mod sensors;
mod settings;

pub use arena::{Arena, Wall};
pub use catalogue::{
    ANGLE, APPROACH_BATTERY, APPROACH_NEST, AVOID, BATTERY_VISIBLE, CARRYING, DELIVERED, DISTANCE,
    INPUTS, NEST_VISIBLE, PROXIMITY_SENSORS, SEARCHING, TURN, WANDER,
};
pub use sensors::TargetReading;
pub use settings::{
    ArenaSettings, FeatureSettings, FenceSettings, ForagingSettings, MovementSettings,
    PrimitiveSettings, PrimitiveTraining, RbfWidth, RobotSettings, SensorSettings, TargetSettings,
};

use arena::Reach;
use motion::{Arc, slide};
use sensors::{Sensors, Sighting};

use super::{Catalogue, Probe, Settings, StateType, SubtaskId, TrainingSettings, World};
use crate::random::{Purpose, Stream, stream};
use crate::rules::{Check, Problem};

/// Draws after which a search for a pose gives up. In a usable arena a search takes
/// a handful of draws.
const MAX_DRAWS: usize = 20_000;

/// Where the robot is and where it heads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Centre of the body in millimetres.
    pub position: Point2<f64>,
    /// Unit vector.
    pub heading: Vector2<f64>,
}

/// What the robot does in the task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// It looks for a battery.
    EmptyHanded,
    /// It carries the battery with this index.
    Carrying(usize),
    /// It has delivered the battery with this index.
    Delivered(usize),
}

/// The state of one robot and its readings.
#[derive(Clone, Copy, Debug)]
pub struct ForagingState {
    /// Where the robot is.
    pub pose: Pose,
    /// What it does.
    pub task: Task,
    /// Proximity readings in millimetres, in the order of the scenario's sensors.
    pub proximity_mm: [f32; PROXIMITY_SENSORS],
    /// The reading of the target, if one is visible.
    pub target: Option<TargetReading>,
}

/// The reward of a primitive subtask (Thesis Eq. 4.1).
#[derive(Clone, Debug)]
enum Reward {
    /// Of the action, unless a wall is too near: Avoid, Wander.
    Movement { actions: Vec<f32>, failure: f32 },
    /// Of the angle to the target: Approach battery, Approach nest, Turn.
    Target {
        offset: f32,
        divisor_deg: f32,
        failure: f32,
    },
}

/// A primitive subtask: what its actions do and how they are rewarded.
#[derive(Clone, Debug)]
struct Primitive {
    arcs: Vec<Arc>,
    reward: Reward,
    training: TrainingSettings,
}

/// The foraging world of a scenario.
#[derive(Clone, Debug)]
pub struct ForagingWorld {
    catalogue: Catalogue,
    arena: Arena,
    sensors: Sensors,
    radius: f64,
    capture_distance: f64,
    delivery_distance: f64,
    time_step_s: f64,
    /// Avoid, Wander, Approach battery, Approach nest, Turn.
    primitives: [Primitive; 5],
    /// A pose known to be free, for arenas so crowded that chance finds none.
    some_pose: Pose,
}

impl ForagingWorld {
    /// The world of settings that obey the rules.
    ///
    /// # Errors
    /// When the arena has no room for the robot.
    pub fn new(settings: &ForagingSettings) -> Result<Self, Problem> {
        let primitives = primitives(settings);
        let longest = primitives
            .iter()
            .flat_map(|primitive| primitive.arcs.iter().map(Arc::length))
            .fold(0.0, f64::max);
        let radius = settings.robot.radius_mm;
        let reach = Reach {
            touch: radius + longest,
            proximity: Sensors::proximity_reach(&settings.sensors, radius),
        };
        let mut world = Self {
            catalogue: catalogue::catalogue(settings),
            arena: Arena::new(&settings.arena, reach),
            sensors: Sensors::new(&settings.sensors, radius),
            radius,
            capture_distance: settings.robot.capture_distance_mm,
            delivery_distance: settings.robot.delivery_distance_mm,
            time_step_s: settings.time_step_s,
            primitives,
            some_pose: Pose {
                position: Point2::origin(),
                heading: Vector2::x(),
            },
        };
        let mut rng = stream(0, 0, 0, Purpose::StartPoses);
        world.some_pose = world.find_pose(&mut rng).ok_or_else(|| {
            let found =
                format!("no free place for a robot of radius {radius} mm in {MAX_DRAWS} draws");
            Problem::new("arena", found, "an arena with room to start in")
        })?;
        Ok(world)
    }

    /// Walls, batteries and nest.
    #[must_use]
    pub fn arena(&self) -> &Arena {
        &self.arena
    }

    /// Radius of the robot's body in millimetres.
    #[must_use]
    pub fn robot_radius_mm(&self) -> f64 {
        self.radius
    }

    fn find_pose(&self, rng: &mut Stream) -> Option<Pose> {
        (0..MAX_DRAWS).find_map(|_| {
            let share = Vector2::new(rng.random::<f64>(), rng.random::<f64>());
            let (sin, cos) = libm::sincos(rng.random::<f64>() * std::f64::consts::TAU);
            let position = Point2::from(share.component_mul(&self.arena.size));
            self.arena.is_free(position, self.radius).then_some(Pose {
                position,
                heading: Vector2::new(cos, sin),
            })
        })
    }

    /// The target that counts in this task, if it is seen, and its index.
    fn see_target(&self, pose: &Pose, task: Task) -> Option<(usize, Sighting)> {
        let see = |target| {
            let sighting = self
                .sensors
                .see(&self.arena, pose.position, pose.heading, target);
            sighting.map(|sighting| (target, sighting))
        };
        match task {
            Task::EmptyHanded => (0..self.arena.batteries.len())
                .filter_map(see)
                .min_by(|(_, a), (_, b)| a.distance.total_cmp(&b.distance)),
            Task::Carrying(_) | Task::Delivered(_) => see(self.arena.nest_index()),
        }
    }

    fn sensed(&self, pose: Pose, task: Task, rng: &mut Stream) -> ForagingState {
        let seen = self.see_target(&pose, task);
        self.sensed_with(pose, task, seen.map(|(_, sighting)| sighting), rng)
    }

    fn sensed_with(
        &self,
        pose: Pose,
        task: Task,
        seen: Option<Sighting>,
        rng: &mut Stream,
    ) -> ForagingState {
        let Pose { position, heading } = pose;
        ForagingState {
            pose,
            task,
            proximity_mm: self.sensors.proximity(&self.arena, position, heading, rng),
            target: seen.map(|sighting| self.sensors.read(&sighting, rng)),
        }
    }

    fn moved(&self, pose: &Pose, arc: &Arc) -> Pose {
        let motion = arc.displacement(pose.heading);
        let walls = self.arena.touchable(pose.position);
        Pose {
            position: slide(pose.position, motion, self.radius, walls),
            heading: arc.turned(pose.heading),
        }
    }

    fn primitive(&self, id: SubtaskId) -> &Primitive {
        &self.primitives[id.index() - AVOID.index()]
    }

    fn reward(
        &self,
        reward: &Reward,
        action: usize,
        proximity_mm: &[f32; PROXIMITY_SENSORS],
        target: Option<TargetReading>,
    ) -> f32 {
        match reward {
            Reward::Movement { actions, failure } => {
                let smallest = proximity_mm.iter().fold(f32::INFINITY, |a, &b| a.min(b));
                if smallest <= self.sensors.proximity_range[0] {
                    *failure
                } else {
                    actions[action]
                }
            }
            Reward::Target {
                offset,
                divisor_deg,
                failure,
            } => target.map_or(*failure, |target| {
                offset - target.angle_deg.abs() / divisor_deg
            }),
        }
    }

    /// Readings scaled to [0, 1] over their ranges; 0 for a target that is not seen.
    fn inputs(
        &self,
        proximity_mm: &[f32; PROXIMITY_SENSORS],
        target: Option<TargetReading>,
    ) -> [f32; INPUTS] {
        let mut inputs = [0.0; INPUTS];
        let [low, high] = self.sensors.proximity_range;
        for (input, reading) in inputs.iter_mut().zip(proximity_mm) {
            *input = (reading - low) / (high - low);
        }
        if let Some(target) = target {
            let half = self.sensors.vision_half_angle_deg;
            inputs[ANGLE] = (target.angle_deg + half) / (2.0 * half);
            inputs[DISTANCE] = target.distance_mm / self.sensors.vision_range as f32;
        }
        inputs
    }

    fn is_target_seeking(primitive: SubtaskId) -> bool {
        matches!(primitive, APPROACH_BATTERY | APPROACH_NEST | TURN)
    }
}

fn primitives(settings: &ForagingSettings) -> [Primitive; 5] {
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
        training: training.clone(),
    };
    let target = |subtask: &TargetSettings, training: &TrainingSettings| Primitive {
        arcs: arcs(&subtask.actions_mm_per_s),
        reward: Reward::Target {
            offset: subtask.reward_offset as f32,
            divisor_deg: subtask.reward_divisor_deg as f32,
            failure: subtask.failure_reward as f32,
        },
        training: training.clone(),
    };
    let (p, t) = (&settings.primitives, &settings.primitive_training);
    [
        movement(&p.avoid, &t.avoid),
        movement(&p.wander, &t.wander),
        target(&p.approach_battery, &t.approach_battery),
        target(&p.approach_nest, &t.approach_nest),
        target(&p.turn, &t.turn),
    ]
}

impl Settings for ForagingSettings {
    type World = ForagingWorld;

    fn check(&self, check: &mut Check) {
        rules::rules(check, self);
    }

    fn build(&self) -> Result<ForagingWorld, Problem> {
        ForagingWorld::new(self)
    }

    fn trains_primitives(&self) -> bool {
        true
    }
}

impl World for ForagingWorld {
    type Start = Pose;
    type State = ForagingState;
    type Percept = [f32; INPUTS];

    fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    fn draw_start(&self, rng: &mut Stream) -> Pose {
        self.find_pose(rng).unwrap_or(self.some_pose)
    }

    fn begin(&self, start: &Pose, rng: &mut Stream) -> ForagingState {
        self.sensed(*start, Task::EmptyHanded, rng)
    }

    fn step(
        &self,
        state: &mut ForagingState,
        primitive: SubtaskId,
        action: usize,
        rng: &mut Stream,
    ) -> f32 {
        let subtask = self.primitive(primitive);
        let pose = self.moved(&state.pose, &subtask.arcs[action]);
        let seen = self.see_target(&pose, state.task);
        let (task, reached) = match (state.task, seen) {
            (Task::EmptyHanded, Some((battery, sighting)))
                if sighting.distance <= self.capture_distance =>
            {
                (Task::Carrying(battery), Some(sighting))
            }
            (Task::Carrying(battery), Some((_, sighting)))
                if sighting.distance <= self.delivery_distance =>
            {
                (Task::Delivered(battery), Some(sighting))
            }
            (task, _) => (task, None),
        };
        let captured = matches!((state.task, task), (Task::EmptyHanded, Task::Carrying(_)));
        *state = if captured {
            self.sensed(pose, task, rng)
        } else {
            self.sensed_with(pose, task, seen.map(|(_, sighting)| sighting), rng)
        };
        let rewarded = match reached {
            Some(battery) if captured => Some(self.sensors.read(&battery, rng)),
            _ => state.target,
        };
        self.reward(&subtask.reward, action, &state.proximity_mm, rewarded)
    }

    fn state_type(&self, state: &ForagingState) -> StateType {
        match (state.task, state.target) {
            (Task::EmptyHanded, None) => SEARCHING,
            (Task::EmptyHanded, Some(_)) => BATTERY_VISIBLE,
            (Task::Carrying(_), None) => CARRYING,
            (Task::Carrying(_), Some(_)) => NEST_VISIBLE,
            (Task::Delivered(_), _) => DELIVERED,
        }
    }

    fn percept(&self, state: &ForagingState) -> [f32; INPUTS] {
        self.inputs(&state.proximity_mm, state.target)
    }

    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<[f32; INPUTS]> {
        let task = match state_type {
            CARRYING | NEST_VISIBLE => Task::Carrying(0),
            _ => Task::EmptyHanded,
        };
        (0..MAX_DRAWS).find_map(|_| {
            let state = self.sensed(self.draw_start(rng), task, rng);
            (self.state_type(&state) == state_type).then(|| self.percept(&state))
        })
    }

    fn probes(&self, primitive: SubtaskId) -> Vec<Probe<[f32; INPUTS]>> {
        if Self::is_target_seeking(primitive) {
            self.angle_probes()
        } else {
            self.proximity_probes(None)
        }
    }

    fn training(&self, primitive: SubtaskId) -> Option<&TrainingSettings> {
        Some(&self.primitive(primitive).training)
    }

    fn begin_training(&self, primitive: SubtaskId, rng: &mut Stream) -> Option<ForagingState> {
        let carrying = match primitive {
            APPROACH_NEST => true,
            TURN => rng.random::<bool>(),
            _ => false,
        };
        let task = if carrying {
            Task::Carrying(0)
        } else {
            Task::EmptyHanded
        };
        let wanted = Self::is_target_seeking(primitive);
        (0..MAX_DRAWS).find_map(|_| {
            let state = self.sensed(self.draw_start(rng), task, rng);
            (!wanted || state.target.is_some()).then_some(state)
        })
    }

    fn training_goes_on(
        &self,
        primitive: SubtaskId,
        before: &ForagingState,
        after: &mut ForagingState,
    ) -> bool {
        if Self::is_target_seeking(primitive) {
            // Over when the target is lost, or captured, or reached.
            return after.task == before.task && after.target.is_some();
        }
        after.task = Task::EmptyHanded;
        true
    }
}
