//! What the foraging task looks like.

use nalgebra::{Point2, Vector2};

use super::catalogue::INPUTS;
use super::motion::rotate;
use super::{
    APPROACH_BATTERY, APPROACH_NEST, BATTERY_VISIBLE, ForagingState, ForagingWorld, NEST_VISIBLE,
    Pose, TURN, Task,
};
use crate::random::Stream;
use crate::worlds::scene::{Mark, Reading, Role, Scenery, Scenic, Snapshot, Sweep, View};
use crate::worlds::{Kind, StateType, SubtaskId, World};

/// Variants of [`Scenic::state_at`].
const VARIANTS: [&str; 2] = ["empty-handed", "carrying"];
/// Further variants of a robot with memory, in the same order: it remembers where the closest
/// battery and the nest are.
const REMINDED: [&str; 2] = ["empty-handed with memory", "carrying with memory"];

impl Scenic for ForagingWorld {
    fn scenery(&self) -> Scenery {
        let arena = &self.arena;
        let walls = |transparent| {
            let walls = arena.walls.iter();
            let walls = walls.filter(move |wall| wall.transparent == transparent);
            let ends = |wall: &super::Wall| [wall.start, wall.end()].map(|end| [end.x, end.y]);
            walls.map(ends).collect()
        };
        Scenery {
            extent: arena.size.into(),
            unit: String::from("mm"),
            grid: None,
            walls: walls(false),
            transparent_walls: walls(true),
            places: vec![Mark {
                role: Role::Goal,
                label: String::from("nest"),
                at: arena.nest.into(),
            }],
            moves: Vec::new(),
            time_step_s: Some(self.time_step_s),
        }
    }

    fn snapshot(&self, state: &ForagingState) -> Snapshot {
        let ForagingState { pose, task, .. } = *state;
        let seen = self.see_target(&pose, task);
        let carried = match task {
            Task::Carrying(battery) => Some(battery),
            Task::EmptyHanded | Task::Delivered(_) => None,
        };
        let gone = match task {
            Task::EmptyHanded => None,
            Task::Carrying(battery) | Task::Delivered(battery) => Some(battery),
        };
        let batteries = self.arena.batteries.iter().enumerate();
        Snapshot {
            at: pose.position.into(),
            radius: self.radius,
            heading: Some(libm::atan2(pose.heading.y, pose.heading.x)),
            carries: carried.map(battery_label),
            marks: batteries
                .filter(|&(index, _)| Some(index) != gone)
                .map(|(index, at)| Mark {
                    role: Role::Object,
                    label: battery_label(index),
                    at: (*at).into(),
                })
                .collect(),
            view: Some(View {
                half_angle: f64::from(self.sensors.vision_half_angle_deg).to_radians(),
                range: self.sensors.vision_range,
            }),
            sees: seen.map(|(target, _)| self.arena.target(target).into()),
            remembers: self.remembered(state).map(Into::into),
            rays: self.measured_rays(state),
            readings: self.readings(state),
            state_type: self.state_type(state),
            variant: self.variant(state),
        }
    }

    fn position(&self, state: &ForagingState) -> [f64; 2] {
        state.pose.position.into()
    }

    fn variants(&self) -> Vec<String> {
        let reminded = REMINDED.iter().filter(|_| self.memory.is_some());
        let all = VARIANTS.iter().chain(reminded);
        all.copied().map(String::from).collect()
    }

    fn state_at(
        &self,
        at: [f64; 2],
        heading: f64,
        variant: usize,
        rng: &mut Stream,
    ) -> Option<ForagingState> {
        let position = Point2::from(at);
        let size = self.arena.size;
        let inside = at[0] >= 0.0 && at[0] <= size.x && at[1] >= 0.0 && at[1] <= size.y;
        if !inside || !self.arena.is_free(position, self.radius) {
            return None;
        }
        let task = if variant.is_multiple_of(VARIANTS.len()) {
            Task::EmptyHanded
        } else {
            Task::Carrying(0)
        };
        let (sin, cos) = libm::sincos(heading);
        let pose = Pose {
            position,
            heading: Vector2::new(cos, sin),
        };
        let mut state = self.sensed(pose, task, rng);
        if variant >= VARIANTS.len() {
            let memory = self.full_memory(&pose);
            self.remember(&mut state, memory, rng);
        }
        Some(state)
    }

    fn sweeps(&self, subtask: SubtaskId, state_type: StateType) -> Vec<Sweep<[f32; INPUTS]>> {
        let catalogue = self.catalogue();
        let described = catalogue.subtask(subtask);
        let sees_target = matches!(state_type, BATTERY_VISIBLE | NEST_VISIBLE);
        match (&described.kind, subtask) {
            (_, APPROACH_BATTERY | APPROACH_NEST | TURN) => vec![self.angle_sweep()],
            (Kind::Composite { .. }, _) if self.looks_at_target(subtask) && sees_target => {
                vec![self.pattern_sweep(state_type), self.target_sweep()]
            }
            _ => vec![self.pattern_sweep(state_type)],
        }
    }
}

impl ForagingWorld {
    /// Returns whether the values of a subtask depend on the target.
    fn looks_at_target(&self, subtask: SubtaskId) -> bool {
        let map = self.catalogue.subtask(subtask).map;
        let axes = self.catalogue.maps[map.index()].axes();
        axes.iter().any(|axis| axis.input == super::ANGLE)
    }

    /// Returns the index of the variant that a state belongs to.
    fn variant(&self, state: &ForagingState) -> usize {
        let (carries, remembers) = match state.task {
            Task::EmptyHanded => (0, state.recalled.is_some()),
            Task::Carrying(_) => (1, state.recalled.is_some()),
            Task::Delivered(_) => (1, self.memory.is_some()),
        };
        carries + usize::from(remembers) * VARIANTS.len()
    }

    /// Returns each proximity ray, from the body's surface to the measured distance.
    fn measured_rays(&self, state: &ForagingState) -> Vec<[[f64; 2]; 2]> {
        let directions = self.sensors.rays.iter().zip(state.proximity_mm);
        directions
            .map(|(&ray, reading)| {
                let direction = rotate(ray, state.pose.heading);
                let reach = [self.radius, self.radius + f64::from(reading)];
                reach.map(|length| (state.pose.position + direction * length).into())
            })
            .collect()
    }

    fn readings(&self, state: &ForagingState) -> Vec<Reading> {
        let reading = |name: String, value: Option<f32>| Reading {
            name,
            value: value.map(f64::from),
        };
        let angles = self.sensors.rays.map(|ray| {
            let angle = libm::atan2(ray.y, ray.x).to_degrees();
            // Without rounding, an error would show as -0.
            angle.round() as i64
        });
        let proximity = angles.iter().zip(state.proximity_mm);
        let mut readings: Vec<_> = proximity
            .map(|(angle, mm)| reading(format!("proximity_{angle:+}deg_mm"), Some(mm)))
            .collect();
        let target = state.target;
        readings.push(reading(
            String::from("target_angle_deg"),
            target.map(|t| t.angle_deg),
        ));
        readings.push(reading(
            String::from("target_distance_mm"),
            target.map(|t| t.distance_mm),
        ));
        if self.memory.is_some() {
            let recalled = state.recalled;
            readings.push(reading(
                String::from("recalled_angle_deg"),
                recalled.map(|r| r.angle_deg),
            ));
            readings.push(reading(
                String::from("recalled_distance_mm"),
                recalled.map(|r| r.distance_mm),
            ));
        }
        readings
    }
}

fn battery_label(index: usize) -> String {
    format!("battery {}", index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, stream};
    use crate::worlds::foraging::settings::tests::environment;
    use crate::worlds::foraging::{AVOID, CARRYING, SEARCHING};

    fn world() -> ForagingWorld {
        ForagingWorld::new(&environment(3)).unwrap()
    }

    #[test]
    fn snapshots_agree_with_their_states() {
        let world = world();
        let mut rng = stream(1, 0, 0, Purpose::Trials);
        let (mut seen, mut carried) = (0, 0);
        for round in 0..400 {
            let start = world.draw_start(&mut rng);
            let heading = libm::atan2(start.heading.y, start.heading.x);
            let variant = round % 2;
            let at = start.position.into();
            let mut state = world.state_at(at, heading, variant, &mut rng).unwrap();
            world.step(&mut state, AVOID, 0, &mut rng);
            if matches!(state.task, Task::Delivered(_)) {
                continue;
            }
            let shown = world.snapshot(&state);
            assert_eq!(shown.at, world.position(&state));
            assert_eq!(shown.state_type, world.state_type(&state));
            let (sin, cos) = libm::sincos(shown.heading.unwrap());
            assert!((state.pose.heading - Vector2::new(cos, sin)).norm() < 1e-9);
            let sees = matches!(shown.state_type, BATTERY_VISIBLE | NEST_VISIBLE);
            assert_eq!(shown.sees.is_some(), sees);
            assert_eq!(shown.readings[5].value.is_some(), sees);
            let carries = matches!(shown.state_type, CARRYING | NEST_VISIBLE);
            assert_eq!(shown.carries.is_some(), carries);
            let left = world.arena.batteries.len() - usize::from(carries);
            assert_eq!(shown.marks.len(), left);
            let [low, high] = world.sensors.proximity_range.map(f64::from);
            for [from, to] in shown.rays {
                let length = (Point2::from(to) - Point2::from(from)).norm();
                assert!((low - 1e-3..=high + 1e-3).contains(&length));
                let centre = (Point2::from(from) - state.pose.position).norm();
                assert!((centre - world.radius).abs() < 1e-9);
            }
            seen += usize::from(sees);
            carried += usize::from(carries);
        }
        assert!(seen > 20 && carried > 100);
    }

    #[test]
    fn a_robot_with_memory_shows_where_it_remembers_its_target() {
        let mut settings = environment(1);
        settings.memory = Some(Default::default());
        settings.arena.transparent_walls_mm = vec![[100.0, 2500.0, 500.0, 2500.0]];
        let world = ForagingWorld::new(&settings).unwrap();
        assert_eq!(world.variants()[3], "carrying with memory");
        let scenery = world.scenery();
        assert_eq!(scenery.walls.len(), world.arena.walls.len() - 1);
        assert_eq!(
            scenery.transparent_walls,
            [[[100.0, 2500.0], [500.0, 2500.0]]]
        );
        let mut rng = stream(1, 0, 0, Purpose::Trials);
        let nest: [f64; 2] = world.arena.nest.into();
        let mut hidden = 0;
        for heading in 0..8 {
            let at = [world.arena.size.x / 2.0, world.arena.size.y / 2.0];
            let heading = f64::from(heading);
            let mut state = world.state_at(at, heading, 3, &mut rng).unwrap();
            // Without odometry noise the place stays where it is while the robot moves.
            for _ in 0..3 {
                let shown = world.snapshot(&state);
                assert_eq!(shown.remembers.is_some(), shown.sees.is_none());
                assert_eq!(shown.variant, if shown.remembers.is_some() { 3 } else { 1 });
                assert_eq!(shown.readings[7].name, "recalled_angle_deg");
                assert_eq!(shown.readings[7].value.is_some(), shown.remembers.is_some());
                if let Some([x, y]) = shown.remembers {
                    assert!((x - nest[0]).hypot(y - nest[1]) < 1e-6, "{x} {y}");
                    hidden += 1;
                }
                world.step(&mut state, AVOID, 1, &mut rng);
                if state.target.is_some() {
                    break;
                }
            }
        }
        assert!(hidden > 8);
        let state = world.state_at([1500.0, 1500.0], 0.0, 1, &mut rng).unwrap();
        assert_eq!(world.snapshot(&state).remembers, None);
    }

    #[test]
    fn no_state_is_in_a_wall_or_outside() {
        let world = world();
        let mut rng = stream(1, 0, 0, Purpose::Trials);
        for at in [
            [1700.0, 600.0],
            [-500.0, 300.0],
            [3200.0, 300.0],
            [40.0, 900.0],
        ] {
            assert!(world.state_at(at, 0.0, 0, &mut rng).is_none());
        }
        let state = world.state_at([1500.0, 1500.0], 0.3, 0, &mut rng).unwrap();
        assert!([SEARCHING, BATTERY_VISIBLE].contains(&world.state_type(&state)));
    }
}
