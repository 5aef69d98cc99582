//! A transparent wall stops the robot and its proximity rays, but not sight.

use maxq_lab::random::{Purpose, stream};
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::{BATTERY_VISIBLE, ForagingWorld, Pose, SEARCHING};
use nalgebra::{Point2, Vector2};

use super::geometry::RADIUS;
use super::model;

/// The ray straight ahead.
const AHEAD: usize = 2;
const WALL_X: f64 = 1500.0;

/// An arena of environment 1 with commands, a battery at (2000, 1000), and a wall from its southern to
/// its northern side.
fn walled(transparent: bool) -> ForagingWorld {
    let mut model = model("environment-1");
    model.commands = true;
    model.arena.batteries_mm = vec![[2000.0, 1000.0]];
    let wall = [WALL_X, 0.0, WALL_X, 3000.0];
    let walls = if transparent {
        &mut model.arena.transparent_walls_mm
    } else {
        &mut model.arena.walls_mm
    };
    walls.push(wall);
    ForagingWorld::new(&model).unwrap()
}

#[test]
fn a_transparent_wall_stops_bodies_and_rays_but_not_sight() {
    for transparent in [true, false] {
        let world = walled(transparent);
        let forward = world.catalogue().find("Forward").unwrap();
        let mut rng = stream(1, 0, 0, Purpose::Trials);
        // 200 mm between the body and the wall.
        let start = Pose {
            position: Point2::new(WALL_X - RADIUS - 200.0, 1000.0),
            heading: Vector2::x(),
        };
        let mut state = world.begin(&start, &mut rng);
        for _ in 0..20 {
            let gap = WALL_X - RADIUS - state.pose.position.x;
            let bound = |noise: f64| (gap * noise).clamp(70.0, 350.0);
            let reading = f64::from(state.proximity_mm[AHEAD]);
            assert!((bound(0.9) - 1e-3..=bound(1.1) + 1e-3).contains(&reading));
            let seen = if transparent {
                BATTERY_VISIBLE
            } else {
                SEARCHING
            };
            assert_eq!(world.state_type(&state), seen);
            if let Some(target) = state.target {
                let distance = 2000.0 - state.pose.position.x;
                assert!((f64::from(target.distance_mm) / distance - 1.0).abs() < 0.1 + 1e-5);
            }
            world.step(&mut state, forward, 0, &mut rng);
        }
        let gap = WALL_X - RADIUS - state.pose.position.x;
        assert!(
            (0.0..1e-3).contains(&gap),
            "it stands {gap} mm from the wall"
        );
    }
}
