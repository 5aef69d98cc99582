//! Motion of the robot: exact arcs, and sliding along walls.

use nalgebra::{Point2, Vector2};

use super::arena::Wall;

/// Distance in millimetres between a disc and a wall at which they touch.
const CONTACT_TOLERANCE_MM: f64 = 1e-6;
/// Motion into a wall below this share of the whole motion is rounding error.
const INWARD_TOLERANCE: f64 = 1e-12;
/// Number of contacts in one time step after which the rest of the motion is dropped.
const MAX_CONTACTS: usize = 4;

/// The exact arc of a two-wheeled robot in one time step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    /// Displacement in the frame of the robot at the start, with the heading along +x.
    chord: Vector2<f64>,
    /// Cosine and sine of the change of heading.
    turn: Vector2<f64>,
}

impl Arc {
    /// Computes the arc of wheel speeds `[right, left]` in mm/s held for `duration` seconds.
    pub(super) fn new([right, left]: [f64; 2], wheel_base_mm: f64, duration: f64) -> Self {
        let forward = (right + left) / 2.0 * duration;
        let angle = (right - left) / wheel_base_mm * duration;
        let (sin, cos) = libm::sincos(angle);
        let chord = if angle == 0.0 {
            Vector2::new(forward, 0.0)
        } else {
            let radius = forward / angle;
            Vector2::new(radius * sin, radius * (1.0 - cos))
        };
        Self {
            chord,
            turn: Vector2::new(cos, sin),
        }
    }

    /// Returns the displacement of a robot with this heading (a unit vector).
    pub(super) fn displacement(&self, heading: Vector2<f64>) -> Vector2<f64> {
        rotate(self.chord, heading)
    }

    /// Returns the heading after the arc.
    pub(super) fn turned(&self, heading: Vector2<f64>) -> Vector2<f64> {
        let turned = rotate(self.turn, heading);
        // One Newton step towards length 1, so that rounding errors do not add up over a trial.
        turned * (1.5 - 0.5 * turned.norm_squared())
    }

    /// Returns the length of the displacement in millimetres.
    pub(super) fn length(&self) -> f64 {
        self.chord.norm()
    }
}

/// Rotates `vector` from the frame whose x axis is the unit vector `heading`.
pub(super) fn rotate(vector: Vector2<f64>, heading: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(
        vector.x * heading.x - vector.y * heading.y,
        vector.x * heading.y + vector.y * heading.x,
    )
}

/// Returns `vector` in the frame whose x axis is the unit vector `heading`: undoes [`rotate`].
pub(super) fn in_frame(vector: Vector2<f64>, heading: Vector2<f64>) -> Vector2<f64> {
    rotate(vector, Vector2::new(heading.x, -heading.y))
}

/// Moves a disc from `position` by `motion`, and returns its position afterwards.
///
/// The disc moves up to the first contact with a wall. There the component of the remaining
/// motion into the wall is removed, and the disc moves on. A wall in contact stops inward motion
/// only: the disc slides along walls, turns corners, and comes to rest in a slit narrower than
/// itself.
pub(super) fn slide<'w>(
    mut position: Point2<f64>,
    mut motion: Vector2<f64>,
    radius: f64,
    walls: impl Iterator<Item = &'w Wall> + Clone,
) -> Point2<f64> {
    for _ in 0..MAX_CONTACTS {
        let distance = motion.norm();
        if distance == 0.0 {
            break;
        }
        let first = walls
            .clone()
            .filter_map(|wall| {
                let time = contact(position, motion, distance, radius, wall);
                time.map(|time| (time, wall))
            })
            .min_by(|(a, _), (b, _)| a.total_cmp(b));
        let Some((time, wall)) = first else {
            return position + motion;
        };
        position += motion * time;
        motion *= 1.0 - time;
        let normal = (position - wall.nearest(position)).normalize();
        let inward = motion.dot(&normal);
        if inward < 0.0 {
            motion -= normal * inward;
        }
    }
    position
}

/// Returns the share of `motion`, of this length, after which the disc first touches `wall` and
/// would enter it.
#[inline(always)]
fn contact(
    position: Point2<f64>,
    motion: Vector2<f64>,
    length: f64,
    radius: f64,
    wall: &Wall,
) -> Option<f64> {
    let offset = position - wall.nearest(position);
    let distance_squared = offset.norm_squared();
    if distance_squared > square(radius + length) {
        return None;
    }
    if distance_squared <= square(radius + CONTACT_TOLERANCE_MM) {
        let inward = motion.dot(&offset);
        let tolerance = INWARD_TOLERANCE * length * distance_squared.sqrt();
        return (inward < -tolerance).then_some(0.0);
    }
    // The disc touches the wall when its centre enters the capsule of this radius around the wall.
    [
        enter_side(position, motion, radius, wall),
        enter_circle(position - wall.start, motion, radius),
        enter_circle(position - wall.end(), motion, radius),
    ]
    .into_iter()
    .flatten()
    .min_by(f64::total_cmp)
}

fn square(number: f64) -> f64 {
    number * number
}

/// Returns the time at which a centre outside the band around the wall's line enters it beside
/// the wall.
fn enter_side(
    position: Point2<f64>,
    motion: Vector2<f64>,
    radius: f64,
    wall: &Wall,
) -> Option<f64> {
    let along = wall.span / wall.length;
    let from_start = position - wall.start;
    let height = along.perp(&from_start);
    let approach = -along.perp(&motion) * height.signum();
    if height.abs() < radius || approach <= 0.0 {
        return None;
    }
    let time = (height.abs() - radius) / approach;
    let foot = along.dot(&(from_start + motion * time));
    (time <= 1.0 && (0.0..=wall.length).contains(&foot)).then_some(time)
}

/// Returns the time at which a point outside a circle, at `offset` from its centre, enters it.
fn enter_circle(offset: Vector2<f64>, motion: Vector2<f64>, radius: f64) -> Option<f64> {
    let speed_squared = motion.norm_squared();
    let inward = motion.dot(&offset);
    let outside = offset.norm_squared() - radius * radius;
    let discriminant = inward * inward - speed_squared * outside;
    if inward >= 0.0 || outside < 0.0 || discriminant < 0.0 {
        return None;
    }
    // The smaller root in the form that does not cancel.
    let time = outside / (discriminant.sqrt() - inward);
    (time <= 1.0).then_some(time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RADIUS: f64 = 75.0;

    fn wall(x1: f64, y1: f64, x2: f64, y2: f64) -> Wall {
        Wall::new([x1, y1, x2, y2])
    }

    fn distance(position: Point2<f64>, wall: &Wall) -> f64 {
        (position - wall.nearest(position)).norm()
    }

    #[test]
    fn arcs_are_exact() {
        let straight = Arc::new([600.0, 600.0], 150.0, 0.1);
        assert_eq!(straight.chord, Vector2::new(60.0, 0.0));
        // One wheel standing: the centre circles around it at half the wheel base.
        let pivot = Arc::new([900.0, 0.0], 150.0, 0.1);
        let angle = 0.6_f64;
        assert!((pivot.chord.x - 75.0 * angle.sin()).abs() < 1e-12);
        assert!((pivot.chord.y - 75.0 * (1.0 - angle.cos())).abs() < 1e-12);
        assert!(pivot.turn.y > 0.0, "a faster right wheel turns to the left");
        let spin = Arc::new([300.0, -300.0], 150.0, 0.1);
        assert_eq!(spin.length(), 0.0);
        let mut heading = Vector2::new(1.0, 0.0);
        for _ in 0..100_000 {
            heading = spin.turned(heading);
        }
        assert!((heading.norm() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_disc_slides_along_a_wall_and_stops_in_a_corner() {
        let floor = wall(0.0, 0.0, 1000.0, 0.0);
        let side = wall(300.0, 0.0, 300.0, 500.0);
        let end = slide(
            Point2::new(100.0, 100.0),
            Vector2::new(60.0, -60.0),
            RADIUS,
            [&floor].into_iter(),
        );
        assert!((end - Point2::new(160.0, RADIUS)).norm() < 1e-9);
        let end = slide(
            Point2::new(200.0, 100.0),
            Vector2::new(60.0, -60.0),
            RADIUS,
            [&floor, &side].into_iter(),
        );
        assert!((end - Point2::new(300.0 - RADIUS, RADIUS)).norm() < 1e-9);
    }

    #[test]
    fn a_slit_holds_a_disc_until_its_heading_is_off_by_enough() {
        // At rest in a slit of width g the contacts are asin(g / 2r) off the heading.
        let gap = 54.0;
        let left = wall(-500.0, 0.0, -gap / 2.0, 0.0);
        let right = wall(gap / 2.0, 0.0, 500.0, 0.0);
        let limit = (gap / (2.0 * RADIUS)).asin();
        let distance_after = |angle: f64| {
            let motion = Vector2::new(angle.sin(), -angle.cos()) * 45.0;
            let mut position = Point2::new(0.0, 70.0);
            for _ in 0..100 {
                position = slide(position, motion, RADIUS, [&left, &right].into_iter());
            }
            position.x.abs()
        };
        assert!(distance_after(0.0) < gap / 2.0);
        assert!(distance_after(0.4 * limit) < gap / 2.0);
        assert!(distance_after(limit + 0.02) > 200.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn no_motion_enters_or_crosses_a_wall(
            walls in prop::collection::vec(prop::array::uniform4(0.0..600.0_f64), 1..8),
            start in prop::array::uniform2(0.0..600.0_f64),
            steps in prop::collection::vec((0.0..std::f64::consts::TAU, 0.0..130.0_f64), 1..40),
        ) {
            let walls: Vec<_> = walls.into_iter().map(Wall::new).collect();
            let mut position = Point2::from(start);
            let walls: Vec<_> =
                walls.into_iter().filter(|wall| distance(position, wall) >= RADIUS).collect();
            for (angle, length) in steps {
                let motion = Vector2::new(angle.cos(), angle.sin()) * length;
                let next = slide(position, motion, RADIUS, walls.iter());
                prop_assert!((next - position).norm() <= length * (1.0 + 1e-9));
                for wall in &walls {
                    prop_assert!(distance(next, wall) >= RADIUS - 1e-7);
                    prop_assert!(!wall.crosses(position, next));
                }
                position = next;
            }
        }
    }
}
