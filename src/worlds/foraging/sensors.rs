//! The sensors of the robot: five proximity rays, and vision.

use nalgebra::{Point2, Vector2};
use rand::RngExt;

use super::SensorSettings;
use super::arena::Arena;
use super::catalogue::PROXIMITY_SENSORS;
use super::motion::rotate;
use super::rays::Rays;
use crate::random::Stream;

/// A reading of the vision system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetReading {
    /// Angle to the target in degrees, positive to the left, noise included.
    pub angle_deg: f32,
    /// Distance to the target in millimetres, noise included.
    pub distance_mm: f32,
}

/// The true position of a target relative to the robot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sighting {
    pub(super) distance: f64,
    /// The target in the frame of the robot, heading along +x.
    relative: Vector2<f64>,
}

/// The sensors of the robot.
#[derive(Clone, Debug)]
pub(super) struct Sensors {
    /// Directions of the proximity rays in the frame of the robot.
    pub(super) rays: [Vector2<f64>; PROXIMITY_SENSORS],
    body_radius: f64,
    pub(super) proximity_range: [f32; 2],
    pub(super) vision_half_angle_deg: f32,
    vision_half_angle_cos: f64,
    pub(super) vision_range: f64,
    noise: f32,
}

impl Sensors {
    pub(super) fn new(settings: &SensorSettings, body_radius: f64) -> Self {
        Self {
            rays: settings.proximity_angles_deg.map(|angle| {
                let (sin, cos) = libm::sincos(angle.to_radians());
                Vector2::new(cos, sin)
            }),
            body_radius,
            proximity_range: settings.proximity_range_mm.map(|range| range as f32),
            vision_half_angle_deg: settings.vision_half_angle_deg as f32,
            vision_half_angle_cos: libm::cos(settings.vision_half_angle_deg.to_radians()),
            vision_range: settings.vision_range_mm,
            noise: settings.noise as f32,
        }
    }

    /// Returns the largest distance from the robot's centre at which a wall can change a proximity
    /// reading. Noise comes before clipping.
    pub(super) fn proximity_reach(settings: &SensorSettings, body_radius: f64) -> f64 {
        body_radius + settings.proximity_range_mm[1] / (1.0 - settings.noise)
    }

    /// Returns the proximity readings in millimetres from the body's surface, in the order of the
    /// scenario's sensors.
    pub(super) fn proximity(
        &self,
        arena: &Arena,
        position: Point2<f64>,
        heading: Vector2<f64>,
        rng: &mut Stream,
    ) -> [f32; PROXIMITY_SENSORS] {
        let rays = Rays::new(self.rays.map(|ray| rotate(ray, heading)));
        let distances = rays.cast(position, arena.near(position));
        let [low, high] = self.proximity_range;
        distances.map(|distance| {
            if distance.is_infinite() {
                return high;
            }
            self.noisy((distance - self.body_radius) as f32, rng)
                .clamp(low, high)
        })
    }

    /// Returns the true position of a target if the robot sees it.
    pub(super) fn see(
        &self,
        arena: &Arena,
        position: Point2<f64>,
        heading: Vector2<f64>,
        target: usize,
    ) -> Option<Sighting> {
        let offset = arena.target(target) - position;
        let distance = offset.norm();
        let ahead = heading.dot(&offset);
        let in_view =
            distance <= self.vision_range && ahead >= self.vision_half_angle_cos * distance;
        (in_view && arena.in_sight(position, target)).then(|| Sighting {
            distance,
            relative: Vector2::new(ahead, heading.perp(&offset)),
        })
    }

    /// Returns the noisy reading of a visible target.
    pub(super) fn read(&self, sighting: &Sighting, rng: &mut Stream) -> TargetReading {
        let limit = self.vision_half_angle_deg;
        let angle = libm::atan2f(sighting.relative.y as f32, sighting.relative.x as f32);
        let range = self.vision_range as f32;
        TargetReading {
            angle_deg: self.noisy(angle.to_degrees(), rng).clamp(-limit, limit),
            distance_mm: self.noisy(sighting.distance as f32, rng).clamp(0.0, range),
        }
    }

    /// Returns a remembered place as if it were seen: with the noise of a reading, and at most
    /// at the edge of the field of view.
    pub(super) fn recall(&self, angle_deg: f64, distance: f64, rng: &mut Stream) -> TargetReading {
        let limit = self.vision_half_angle_deg;
        TargetReading {
            angle_deg: self.noisy(angle_deg as f32, rng).clamp(-limit, limit),
            distance_mm: self
                .noisy(distance as f32, rng)
                .clamp(0.0, self.vision_range as f32),
        }
    }

    fn noisy(&self, reading: f32, rng: &mut Stream) -> f32 {
        reading * (1.0 + self.noise * (2.0 * rng.random::<f32>() - 1.0))
    }
}
