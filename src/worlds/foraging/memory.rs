//! The robot's memory of places within a trial, kept by dead reckoning (Thesis chapter 5).

use nalgebra::{Point2, Vector2};
use rand::RngExt;

use super::motion::{in_frame, rotate};
use super::sensors::TargetReading;
use super::{ForagingState, ForagingWorld, Pose, Task};
use crate::random::Stream;

/// A robot this close to a remembered place, in millimetres, that faces it and sees nothing
/// there, forgets it.
const FORGET_WITHIN_MM: f64 = 200.0;
/// Largest angle to a remembered place at which the robot faces it.
const FACING_DEG: f64 = 57.0;

/// Places in the frame of the robot: in millimetres, the heading along +x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Memory {
    /// Where it last saw a battery.
    pub battery: Option<Vector2<f64>>,
    /// Where it last saw the nest.
    pub nest: Option<Vector2<f64>>,
}

/// The movement of a robot in one time step, in the frame that it had before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Movement {
    /// The displacement in millimetres.
    pub(super) displacement: Vector2<f64>,
    /// The new heading, a unit vector.
    pub(super) heading: Vector2<f64>,
}

impl Movement {
    /// Returns the movement as the robot measures it: an arc that is longer or shorter by a
    /// random share of at most `noise`.
    pub(super) fn measured(self, noise: f64, rng: &mut Stream) -> Self {
        if noise == 0.0 {
            return self;
        }
        let share = 1.0 + noise * (2.0 * rng.random::<f64>() - 1.0);
        let turn = libm::atan2(self.heading.y, self.heading.x) * share;
        let (sin, cos) = libm::sincos(turn);
        Self {
            displacement: self.displacement * share,
            heading: Vector2::new(cos, sin),
        }
    }
}

impl Memory {
    /// Returns the place that a task needs.
    fn of(&self, task: Task) -> Option<Vector2<f64>> {
        match task {
            Task::EmptyHanded => self.battery,
            Task::Carrying(_) | Task::Delivered(_) => self.nest,
        }
    }

    /// Moves the remembered places as the robot moves.
    pub(super) fn shift(&mut self, movement: Movement) {
        for place in [&mut self.battery, &mut self.nest].into_iter().flatten() {
            *place = in_frame(*place - movement.displacement, movement.heading);
        }
    }
}

impl ForagingWorld {
    /// Brings the memory of a robot up to date with what it sees in `state`. An empty-handed
    /// robot looks for the nest too, which takes one more reading.
    pub(super) fn remember(&self, state: &mut ForagingState, mut memory: Memory, rng: &mut Stream) {
        let searches = state.task == Task::EmptyHanded;
        let nest = if searches {
            look(&mut memory.battery, state.target);
            let (arena, pose) = (&self.arena, &state.pose);
            let nest = arena.nest_index();
            let seen = self.sensors.see(arena, pose.position, pose.heading, nest);
            seen.map(|sighting| self.sensors.read(&sighting, rng))
        } else {
            state.target
        };
        look(&mut memory.nest, nest);
        state.memory = memory;
        let place = memory.of(state.task);
        let hidden = place.filter(|_| state.target.is_none());
        state.recalled = hidden.map(|place| {
            let distance = place.norm();
            self.sensors.recall(angle_deg(place), distance, rng)
        });
    }

    /// Returns where a robot remembers the target of its task, while it does not see it.
    pub(super) fn remembered(&self, state: &ForagingState) -> Option<Point2<f64>> {
        let place = state.memory.of(state.task);
        let place = place.filter(|_| state.recalled.is_some())?;
        let Pose { position, heading } = state.pose;
        Some(position + rotate(place, heading))
    }

    /// Returns the memory of a robot that knows where the closest battery and the nest are.
    pub(super) fn full_memory(&self, pose: &Pose) -> Memory {
        let place = |target| in_frame(self.arena.target(target) - pose.position, pose.heading);
        let batteries = (0..self.arena.batteries.len()).map(place);
        Memory {
            battery: batteries.min_by(|a, b| a.norm().total_cmp(&b.norm())),
            nest: Some(place(self.arena.nest_index())),
        }
    }

    /// Returns the movement between two poses, in the frame of the first.
    pub(super) fn movement(before: &Pose, after: &Pose) -> Movement {
        Movement {
            displacement: in_frame(after.position - before.position, before.heading),
            heading: in_frame(after.heading, before.heading),
        }
    }

    /// Returns the memory of a robot that has seen a random battery and the nest before, with
    /// probability 1/2 each.
    pub(super) fn some_memory(&self, pose: &Pose, rng: &mut Stream) -> Memory {
        let battery = rng.random_range(0..self.arena.batteries.len());
        let mut place = |target| {
            let offset = self.arena.target(target) - pose.position;
            rng.random::<bool>().then(|| in_frame(offset, pose.heading))
        };
        Memory {
            battery: place(battery),
            nest: place(self.arena.nest_index()),
        }
    }
}

/// Remembers a place that is seen, or forgets it where it should be seen and is not.
fn look(place: &mut Option<Vector2<f64>>, seen: Option<TargetReading>) {
    match seen {
        Some(reading) => {
            let (sin, cos) = libm::sincos(f64::from(reading.angle_deg).to_radians());
            *place = Some(Vector2::new(cos, sin) * f64::from(reading.distance_mm));
        }
        None => {
            let gone = |place: &mut Vector2<f64>| {
                place.norm() <= FORGET_WITHIN_MM && angle_deg(*place).abs() <= FACING_DEG
            };
            place.take_if(gone);
        }
    }
}

/// Returns the angle to a place in the frame of the robot.
fn angle_deg(place: Vector2<f64>) -> f64 {
    libm::atan2(place.y, place.x).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, stream};

    fn reading(angle_deg: f32, distance_mm: f32) -> Option<TargetReading> {
        Some(TargetReading {
            angle_deg,
            distance_mm,
        })
    }

    #[test]
    fn a_remembered_place_moves_against_the_robot() {
        let mut memory = Memory::default();
        look(&mut memory.nest, reading(0.0, 1000.0));
        // A quarter turn to the left after 400 mm ahead: the place is 600 mm to the right.
        memory.shift(Movement {
            displacement: Vector2::new(400.0, 0.0),
            heading: Vector2::new(0.0, 1.0),
        });
        let place = memory.nest.unwrap();
        assert!((place - Vector2::new(0.0, -600.0)).norm() < 1e-9, "{place}");
        assert_eq!(memory.battery, None);
    }

    #[test]
    fn a_place_is_forgotten_where_it_should_be_seen() {
        for (at, seen, remembered) in [
            (reading(0.0, 150.0), None, false),
            (reading(50.0, 150.0), None, false),
            (reading(60.0, 150.0), None, true),
            (reading(0.0, 250.0), None, true),
            (reading(0.0, 150.0), reading(5.0, 150.0), true),
        ] {
            let mut place = None;
            look(&mut place, at);
            look(&mut place, seen);
            assert_eq!(place.is_some(), remembered, "{at:?}, {seen:?}");
        }
    }

    #[test]
    fn odometry_errors_have_the_size_of_the_noise() {
        let mut rng = stream(1, 0, 0, Purpose::Trials);
        let true_movement = Movement {
            displacement: Vector2::new(60.0, 0.0),
            heading: Vector2::new(0.0, 1.0),
        };
        let exact = true_movement.measured(0.0, &mut rng);
        assert_eq!(exact.displacement, true_movement.displacement);
        let lengths: Vec<f64> = (0..2000)
            .map(|_| true_movement.measured(0.1, &mut rng).displacement.norm())
            .collect();
        let mean = lengths.iter().sum::<f64>() / 2000.0;
        assert!((mean - 60.0).abs() < 0.3, "{mean}");
        assert!(lengths.iter().all(|length| (54.0..=66.0).contains(length)));
    }
}
