//! The definitions of the foraging world, by brute force over all walls.

use maxq_lab::worlds::foraging::{Arena, ForagingState, ForagingWorld, Pose, Task, Wall};
use nalgebra::{Point2, Vector2};

/// Rounding may put geometry this near to a border on either side of it.
pub const BORDER: f64 = 1e-6;

pub const RADIUS: f64 = 75.0;
pub const RAYS_DEG: [f64; 5] = [90.0, 30.0, 0.0, -30.0, -90.0];
const VISION_DEG: f64 = 60.0;
const VISION_MM: f64 = 3500.0;

/// The position of a target relative to the robot.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    pub target: usize,
    pub distance: f64,
    pub angle_deg: f64,
}

/// Returns the distance from a point to a wall.
pub fn distance(point: Point2<f64>, wall: &Wall) -> f64 {
    let share = (point - wall.start).dot(&wall.span) / wall.span.norm_squared();
    (point - (wall.start + wall.span * share.clamp(0.0, 1.0))).norm()
}

/// Returns the distance to the nearest wall.
pub fn clearance(arena: &Arena, point: Point2<f64>) -> f64 {
    let distances = arena.walls.iter().map(|wall| distance(point, wall));
    distances.fold(f64::INFINITY, f64::min)
}

/// Returns the signed distances of points from the line through a and b.
fn sides(a: Point2<f64>, b: Point2<f64>, points: [Point2<f64>; 2]) -> [f64; 2] {
    let along = (b - a).normalize();
    points.map(|point| along.perp(&(point - a)))
}

/// Returns whether a wall crosses the line from a to b; `None` if rounding decides.
pub fn crosses(a: Point2<f64>, b: Point2<f64>, wall: &Wall) -> Option<bool> {
    let [s, t] = sides(a, b, [wall.start, wall.end()]);
    let [u, v] = sides(wall.start, wall.end(), [a, b]);
    let apart = |x: f64, y: f64| (x > BORDER && y > BORDER) || (x < -BORDER && y < -BORDER);
    let across = |x: f64, y: f64| x.abs() > BORDER && y.abs() > BORDER && x.signum() != y.signum();
    if apart(s, t) || apart(u, v) {
        return Some(false);
    }
    (across(s, t) && across(u, v)).then_some(true)
}

/// Returns the target if the robot sees it; `None` at a border.
pub fn sees(arena: &Arena, pose: &Pose, target: usize) -> Option<Option<Sight>> {
    let offset = arena.target(target) - pose.position;
    let angle = |v: Vector2<f64>| v.y.atan2(v.x);
    let turn = angle(offset) - angle(pose.heading);
    let angle_deg = turn.sin().atan2(turn.cos()).to_degrees();
    let distance = offset.norm();
    if (angle_deg.abs() - VISION_DEG).abs() < BORDER || (distance - VISION_MM).abs() < BORDER {
        return None;
    }
    if angle_deg.abs() > VISION_DEG || distance > VISION_MM {
        return Some(None);
    }
    let mut blocked = Some(false);
    for wall in arena.walls.iter().filter(|wall| !wall.transparent) {
        match crosses(pose.position, arena.target(target), wall) {
            Some(true) => return Some(None),
            Some(false) => {}
            None => blocked = None,
        }
    }
    blocked.map(|_| {
        Some(Sight {
            target,
            distance,
            angle_deg,
        })
    })
}

/// Returns the closest visible battery while empty-handed, else the nest if it is visible; `None`
/// at a border.
pub fn target_seen(arena: &Arena, pose: &Pose, task: Task) -> Option<Option<Sight>> {
    if task != Task::EmptyHanded {
        return sees(arena, pose, arena.batteries.len());
    }
    let mut closest: Option<Sight> = None;
    for battery in 0..arena.batteries.len() {
        if let Some(sight) = sees(arena, pose, battery)? {
            let nearer = closest.is_none_or(|other| sight.distance < other.distance);
            closest = if nearer { Some(sight) } else { closest };
        }
    }
    Some(closest)
}

/// Returns the true distance from the body's surface to the nearest wall along a ray; `None` if the
/// ray grazes the end of a wall.
pub fn proximity(arena: &Arena, pose: &Pose, ray_deg: f64) -> Option<f64> {
    let (sin, cos) = ray_deg.to_radians().sin_cos();
    let (x, y) = (pose.heading.x, pose.heading.y);
    let ray = Vector2::new(x * cos - y * sin, x * sin + y * cos);
    let far = pose.position + ray * 10_000.0;
    let mut nearest = f64::INFINITY;
    for wall in &arena.walls {
        if crosses(pose.position, far, wall)? {
            let start = wall.start - pose.position;
            nearest = nearest.min(start.perp(&wall.span) / ray.perp(&wall.span));
        }
    }
    Some(nearest - RADIUS)
}

/// Returns the state type of Thesis Table 4.1, numbered from 1; `None` at a border.
pub fn state_type(world: &ForagingWorld, state: &ForagingState) -> Option<usize> {
    let seen = target_seen(world.arena(), &state.pose, state.task)?.is_some();
    Some(match state.task {
        Task::EmptyHanded => 1 + usize::from(seen),
        Task::Carrying(_) => 3 + usize::from(seen),
        Task::Delivered(_) => 5,
    })
}
