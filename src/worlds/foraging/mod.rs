//! The foraging task (Thesis 4.1 to 4.3). Its specification is on the page of
//! [the worlds](super).

use nalgebra::{Point2, Vector2};
use rand::RngExt;

mod arena;
mod catalogue;
pub mod defaults;
mod free_space;
mod memory;
mod motion;
mod primitives;
mod probes;
mod rays;
mod reach;
mod rules;
mod scene;
mod sensors;
mod settings;

pub use arena::{Arena, Wall};
pub use catalogue::{
    ANGLE, APPROACH_BATTERY, APPROACH_NEST, AVOID, BATTERY_VISIBLE, CARRYING, DELIVERED, DISTANCE,
    INPUTS, NEST_VISIBLE, PROXIMITY_SENSORS, REMEMBERS, SEARCHING, TURN, WANDER,
};
pub use memory::Memory;
pub use sensors::TargetReading;
pub use settings::{
    ArenaSettings, FeatureSettings, FenceSettings, ForagingSettings, MemorySettings,
    MovementSettings, PrimitiveSettings, PrimitiveTraining, RbfWidth, RobotSettings,
    SensorSettings, TargetSettings,
};

use arena::Reach;
use motion::{Arc, slide};
use primitives::{Primitive, primitives};
use reach::{Body, Survey};
use sensors::{Sensors, Sighting};

use super::{Catalogue, Probe, Settings, StateType, SubtaskId, TrainingSettings, World};
use crate::random::{Purpose, Stream, stream};
use crate::rules::{Check, Problem};

/// Largest number of draws in a search for a pose. In a usable arena a few are enough.
const MAX_DRAWS: usize = 20_000;

/// Position and heading of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Centre of the body in millimetres.
    pub position: Point2<f64>,
    /// The heading as a unit vector.
    pub heading: Vector2<f64>,
}

/// The progress of the robot in its task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// It searches for a battery.
    EmptyHanded,
    /// It carries the battery with this index.
    Carrying(usize),
    /// It has delivered the battery with this index.
    Delivered(usize),
}

/// The state of a robot, and its readings.
#[derive(Clone, Copy, Debug)]
pub struct ForagingState {
    /// Position and heading.
    pub pose: Pose,
    /// Its progress.
    pub task: Task,
    /// Proximity readings in millimetres, in the order of the scenario's sensors.
    pub proximity_mm: [f32; PROXIMITY_SENSORS],
    /// The reading of the target, if one is visible.
    pub target: Option<TargetReading>,
    /// What it remembers of the arena; nothing in a robot without memory.
    pub memory: Memory,
    /// The remembered place of a target out of sight, with the noise of a reading.
    pub recalled: Option<TargetReading>,
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
    /// Avoid, Wander, Approach battery, Approach nest, Turn, and the commands.
    primitives: Vec<Primitive>,
    memory: Option<MemorySettings>,
    /// A free pose, for a crowded arena in which a search fails.
    some_pose: Pose,
    /// What is odd about the arena.
    warnings: Vec<Problem>,
}

impl ForagingWorld {
    /// Makes the world of settings that obey the rules.
    ///
    /// # Errors
    /// Fails if the arena has no room for the robot.
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
            memory: settings.memory.clone(),
            some_pose: Pose {
                position: Point2::origin(),
                heading: Vector2::x(),
            },
            warnings: Vec::new(),
        };
        let mut rng = stream(0, 0, 0, Purpose::StartPoses);
        world.some_pose = world.find_pose(&mut rng).ok_or_else(|| {
            let found =
                format!("no free place for a robot of radius {radius} mm in {MAX_DRAWS} draws");
            Problem::new("arena", found, "an arena with room to start in")
        })?;
        Ok(world)
    }

    /// Returns walls, batteries and nest.
    #[must_use]
    pub fn arena(&self) -> &Arena {
        &self.arena
    }

    /// Returns the radius of the robot's body in millimetres.
    #[must_use]
    pub fn robot_radius_mm(&self) -> f64 {
        self.radius
    }

    /// Surveys what the robot can reach.
    fn survey(&self) -> Result<Survey<'_>, Problem> {
        let vision = self.sensors.vision_range;
        let body = Body {
            radius: self.radius,
            capture: self.capture_distance.min(vision),
            delivery: self.delivery_distance.min(vision),
        };
        Survey::new(&self.arena, body)
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

    /// Returns the index and the true position of the target of this task, if it is visible.
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
            memory: Memory::default(),
            recalled: None,
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

    /// Returns what a subtask does; `None` for Recall, which imitates others.
    fn primitive(&self, id: SubtaskId) -> Option<&Primitive> {
        self.primitives.get(id.index() - AVOID.index())
    }

    /// Returns what a subtask does in a state.
    fn acting(&self, id: SubtaskId, state: &ForagingState) -> &Primitive {
        let remembers = state.recalled.is_some();
        let acts_as = |id| {
            self.catalogue
                .acts_as(id, self.state_type(state), remembers)
        };
        let own = self.primitive(id);
        own.unwrap_or_else(|| &self.primitives[acts_as(id).index() - AVOID.index()])
    }

    /// Scales readings to [0, 1]. Without a target its inputs are 0.
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

impl Settings for ForagingSettings {
    type World = ForagingWorld;

    fn check(&self, check: &mut Check) {
        rules::rules(check, self);
    }

    fn build(&self) -> Result<ForagingWorld, Problem> {
        let mut world = ForagingWorld::new(self)?;
        world.warnings = match world.survey() {
            Ok(survey) => match survey.refusal() {
                Some(refusal) => return Err(refusal),
                None => survey.warnings(),
            },
            Err(unchecked) => vec![unchecked],
        };
        Ok(world)
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

    fn warnings(&self) -> &[Problem] {
        &self.warnings
    }

    fn draw_start(&self, rng: &mut Stream) -> Pose {
        self.find_pose(rng).unwrap_or(self.some_pose)
    }

    fn begin(&self, start: &Pose, rng: &mut Stream) -> ForagingState {
        let mut state = self.sensed(*start, Task::EmptyHanded, rng);
        if self.memory.is_some() {
            self.remember(&mut state, Memory::default(), rng);
        }
        state
    }

    fn step(
        &self,
        state: &mut ForagingState,
        primitive: SubtaskId,
        action: usize,
        rng: &mut Stream,
    ) -> f32 {
        let subtask = self.acting(primitive, state);
        let (old_pose, mut memory) = (state.pose, state.memory);
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
        let reached = reached.filter(|_| captured);
        let reached = reached.map(|battery| self.sensors.read(&battery, rng));
        if let Some(settings) = &self.memory {
            let movement = Self::movement(&old_pose, &pose);
            memory.shift(movement.measured(settings.odometry_noise, rng));
            self.remember(state, memory, rng);
        }
        // Recall alone is rewarded for what it remembers: to the others a target out of sight is a
        // failure.
        let recalled = state
            .recalled
            .filter(|_| self.primitive(primitive).is_none());
        let rewarded = reached.or(state.target).or(recalled);
        let smallest = state
            .proximity_mm
            .iter()
            .fold(f32::INFINITY, |a, &b| a.min(b));
        let is_blocked = smallest <= self.sensors.proximity_range[0];
        subtask.reward(action, is_blocked, rewarded)
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
        let mut inputs = self.inputs(&state.proximity_mm, state.target.or(state.recalled));
        let remembers = self.memory.is_some() && state.target.or(state.recalled).is_some();
        inputs[REMEMBERS] = f32::from(u8::from(remembers));
        inputs
    }

    fn sample(&self, state_type: StateType, rng: &mut Stream) -> Option<[f32; INPUTS]> {
        let task = match state_type {
            CARRYING | NEST_VISIBLE => Task::Carrying(0),
            _ => Task::EmptyHanded,
        };
        (0..MAX_DRAWS).find_map(|_| {
            let mut state = self.sensed(self.draw_start(rng), task, rng);
            if self.memory.is_some() {
                let memory = self.some_memory(&state.pose, rng);
                self.remember(&mut state, memory, rng);
            }
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
        self.primitive(primitive)?.training.as_ref()
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
            // The episode ends when the target is lost, captured or reached.
            return after.task == before.task && after.target.is_some();
        }
        after.task = Task::EmptyHanded;
        true
    }
}
