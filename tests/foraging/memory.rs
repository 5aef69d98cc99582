//! What the robot remembers, and Recall, which goes there.

use maxq_lab::evolution::{Experiment, Workers};
use maxq_lab::learning::Gate;
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::{
    ForagingState, ForagingWorld, MemorySettings, Pose, SEARCHING, Task,
};
use nalgebra::{Point2, Vector2};
use rand::RngExt;

use super::geometry::sees;
use super::{model, some_action};

/// A scenario's arena for a robot with commands and a memory.
fn remembering(scenario: &str, odometry_noise: f64) -> ForagingWorld {
    let mut model = model(scenario);
    model.commands = true;
    model.memory = Some(MemorySettings { odometry_noise });
    ForagingWorld::new(&model).unwrap()
}

/// A place in the frame of the robot, as a place in the arena.
fn in_arena(pose: &Pose, place: Vector2<f64>) -> Point2<f64> {
    let ahead = pose.heading;
    pose.position + ahead * place.x + Vector2::new(-ahead.y, ahead.x) * place.y
}

#[test]
fn an_empty_handed_robot_remembers_the_nest_that_it_saw() {
    let world = remembering("environment-1", 0.0);
    let nest = world.arena().nest;
    let mut rng = stream(1, 0, 0, Purpose::Trials);
    let mut seen = 0;
    for _ in 0..2000 {
        let state = world.begin(&world.draw_start(&mut rng), &mut rng);
        let Some(sight) = sees(world.arena(), &state.pose, world.arena().nest_index()) else {
            continue;
        };
        assert_eq!(state.memory.nest.is_some(), sight.is_some());
        let (Some(sight), Some(place)) = (sight, state.memory.nest) else {
            continue;
        };
        seen += 1;
        assert!((place.norm() / sight.distance - 1.0).abs() <= 0.1 + 1e-5);
        let angle = place.y.atan2(place.x).to_degrees();
        assert!((angle - sight.angle_deg).abs() <= 0.1 * sight.angle_deg.abs() + 1e-3);
        let off = (in_arena(&state.pose, place) - nest).norm();
        assert!(off <= 0.15 * sight.distance, "{off} mm off");
        assert_eq!(state.task, Task::EmptyHanded);
    }
    assert!(seen > 300, "{seen}");
}

/// The noise of a reading stays as it was when the place was last seen.
#[test]
fn exact_odometry_keeps_a_remembered_place() {
    let (exact, _) = largest_drift(0.0);
    assert!(exact < 1e-6, "{exact} mm");
    let (wrong, steps) = largest_drift(0.2);
    assert!(wrong > 10.0, "{wrong} mm in {steps} steps");
}

/// Walks at random in environment 3, whose walls hide the nest and the batteries. Returns the
/// largest distance between a place that the robot remembers and the place that it read when it
/// last saw it, and the number of steps in which a place was out of sight and remembered.
///
/// A place may be forgotten only where it should be seen and is not.
fn largest_drift(odometry_noise: f64) -> (f64, usize) {
    let world = remembering("environment-3", odometry_noise);
    let mut rng = stream(2, 0, 0, Purpose::Trials);
    let mut state = world.begin(&world.draw_start(&mut rng), &mut rng);
    let (mut drift, mut steps, mut forgotten) = (0.0, 0, 0);
    let mut read: Option<Point2<f64>> = None;
    for step in 0..20_000 {
        let visible = sees(world.arena(), &state.pose, world.arena().nest_index());
        match (visible, state.memory.nest) {
            (Some(Some(_)), Some(place)) => read = Some(in_arena(&state.pose, place)),
            (Some(None), Some(place)) => {
                let known = read.expect("nothing is remembered that was never seen");
                drift = f64::max(drift, (in_arena(&state.pose, place) - known).norm());
                steps += 1;
                let faces = place.y.atan2(place.x).to_degrees().abs() <= 57.0;
                assert!(place.norm() > 200.0 || !faces, "{place} should be seen");
            }
            (Some(Some(_)), None) => panic!("what is seen is remembered"),
            (_, None) => {
                if let Some(known) = read.take().filter(|_| odometry_noise == 0.0) {
                    forgotten += 1;
                    let offset = known - state.pose.position;
                    let ahead = state.pose.heading.dot(&offset) / offset.norm();
                    assert!(offset.norm() <= 200.0 && ahead >= 57.0_f64.to_radians().cos());
                }
            }
            (None, Some(_)) => read = state.memory.nest.map(|place| in_arena(&state.pose, place)),
        }
        let (primitive, action) = some_action(&world, &state, &mut rng);
        world.step(&mut state, primitive, action, &mut rng);
        if matches!(state.task, Task::Delivered(_)) || step % 400 == 399 {
            state = world.begin(&world.draw_start(&mut rng), &mut rng);
            read = None;
        }
    }
    assert!(steps > 3000, "{steps} steps, {forgotten} forgotten");
    (drift, steps)
}

/// A wall hides the battery that the robot has seen. The greedy action of Approach battery at what
/// the robot perceives leads it there.
#[test]
fn recall_drives_to_a_remembered_battery_that_is_out_of_sight() {
    let mut scenario = Scenario::load("environment-1").unwrap();
    let mut settings = model("environment-1");
    settings.commands = true;
    settings.memory = Some(MemorySettings {
        odometry_noise: 0.0,
    });
    settings.arena.batteries_mm = vec![[2500.0, 1500.0]];
    settings.arena.walls_mm = vec![[1900.0, 600.0, 1900.0, 1450.0]];
    scenario.world = maxq_lab::worlds::WorldSettings::Foraging(Box::new(settings.clone()));
    let world = ForagingWorld::new(&settings).unwrap();
    let experiment = Experiment::new(scenario, world).unwrap();
    let workers = Workers::new(1).unwrap();
    let primitives = experiment.train(1, 0, &workers, &Gate::default()).unwrap();
    let (world, catalogue) = (&experiment.world, experiment.catalogue());
    let [forward, recall, approach] =
        ["Forward", "Recall", "ApproachBattery"].map(|name| catalogue.find(name).unwrap());
    let all = primitives.all().iter();
    let approach = all.clone().find(|one| one.subtask == approach).unwrap();
    let battery = world.arena().batteries[0];
    let distance = |state: &ForagingState| (battery - state.pose.position).norm();
    for seed in 0..20 {
        let mut rng = stream(seed, 0, 0, Purpose::Trials);
        let (sin, cos) = (-60.0 + 5.0 * rng.random::<f64>()).to_radians().sin_cos();
        let start = Pose {
            position: Point2::new(1000.0, 1800.0),
            heading: Vector2::new(cos, sin),
        };
        let mut state = world.begin(&start, &mut rng);
        assert!(state.memory.battery.is_some() && state.target.is_some());
        // It drives past, until the wall stands between.
        for _ in 0..13 {
            world.step(&mut state, forward, 0, &mut rng);
        }
        assert_eq!((world.state_type(&state), state.target), (SEARCHING, None));
        let before = distance(&state);
        for _ in 0..7 {
            assert!(state.recalled.is_some(), "it remembers");
            assert_eq!(world.state_type(&state), SEARCHING, "out of sight");
            let percept = world.percept(&state);
            let values = approach.action_values(&experiment.encoder, &percept);
            let best = values.iter().copied().fold(f32::MIN, f32::max);
            let greedy = values.iter().position(|&value| value == best).unwrap();
            world.step(&mut state, recall, greedy, &mut rng);
        }
        let after = distance(&state);
        assert!(after < before - 100.0, "{before} to {after} mm");
    }
}
