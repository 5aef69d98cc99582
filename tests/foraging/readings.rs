//! Readings: ranges, noise before clipping, sampling.

use maxq_lab::random::{Purpose, stream};
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::{
    ANGLE, BATTERY_VISIBLE, CARRYING, DISTANCE, ForagingState, ForagingWorld, NEST_VISIBLE, Pose,
    REMEMBERS, SEARCHING, Task,
};
use nalgebra::{Point2, Vector2};

use super::geometry::{RADIUS, RAYS_DEG, proximity};
use super::{SCENARIOS, model, some_action, world};

/// The ray straight ahead.
const AHEAD: usize = 2;

/// Returns readings of the sensor ahead, at this distance from a wall in environment 1.
fn ahead(gap_mm: f64) -> Vec<f64> {
    let world = world("environment-1");
    let pose = Pose {
        position: Point2::new(3000.0 - RADIUS - gap_mm, 1000.0),
        heading: Vector2::x(),
    };
    let mut rng = stream(1, 0, 0, Purpose::Trials);
    let mut reading = || world.begin(&pose, &mut rng).proximity_mm[AHEAD];
    (0..20_000).map(|_| f64::from(reading())).collect()
}

/// Whether the robot remembers the place that its task needs.
fn remembers(state: &ForagingState) -> bool {
    match state.task {
        Task::EmptyHanded => state.memory.battery.is_some(),
        _ => state.memory.nest.is_some(),
    }
}

fn share(values: &[f64], of: impl Fn(f64) -> bool) -> f64 {
    values.iter().filter(|&&value| of(value)).count() as f64 / values.len() as f64
}

#[test]
fn readings_and_percepts_are_in_their_ranges_and_near_the_truth() {
    for scenario in SCENARIOS {
        let world = world(scenario);
        let mut rng = stream(2, 0, 0, Purpose::Trials);
        let mut state = world.begin(&world.draw_start(&mut rng), &mut rng);
        let mut between = 0;
        for step in 0..20_000 {
            if step % 200 == 0 {
                state = world.begin(&world.draw_start(&mut rng), &mut rng);
            }
            for (reading, ray_deg) in state.proximity_mm.iter().zip(RAYS_DEG) {
                let reading = f64::from(*reading);
                assert!((70.0..=350.0).contains(&reading));
                between += usize::from(reading > 70.0 && reading < 350.0);
                if let Some(true_mm) = proximity(world.arena(), &state.pose, ray_deg) {
                    let bound = |noise: f64| (true_mm * noise).clamp(70.0, 350.0);
                    assert!(reading >= bound(0.9) - 1e-3 && reading <= bound(1.1) + 1e-3);
                }
            }
            let percept = world.percept(&state);
            assert!(percept.iter().all(|input| (0.0..=1.0).contains(input)));
            assert_eq!(percept[REMEMBERS] == 1.0, remembers(&state));
            if let Some(target) = state.target.or(state.recalled) {
                assert!((percept[ANGLE] - (target.angle_deg + 60.0) / 120.0).abs() < 1e-6);
                assert!((percept[DISTANCE] - target.distance_mm / 3500.0).abs() < 1e-6);
            } else {
                assert_eq!((percept[ANGLE], percept[DISTANCE]), (0.0, 0.0));
            }
            for (input, reading) in percept.iter().zip(state.proximity_mm) {
                assert!((input - (reading - 70.0) / 280.0).abs() < 1e-6);
            }
            let (primitive, action) = some_action(&world, &state, &mut rng);
            world.step(&mut state, primitive, action, &mut rng);
            if world.state_type(&state) == world.catalogue().terminal() {
                state = world.begin(&world.draw_start(&mut rng), &mut rng);
            }
        }
        assert!(
            between > 1000,
            "{between} readings inside the range in {scenario}"
        );
    }
}

#[test]
fn noise_is_uniform_in_a_tenth_of_the_reading() {
    let values: Vec<f64> = ahead(200.0).iter().map(|mm| mm / 200.0 - 1.0).collect();
    assert!(values.iter().all(|noise| noise.abs() <= 0.1 + 1e-6));
    // Ten bins of 2000 draws; 220 is five standard deviations.
    for bin in 0..10 {
        let low = -0.1 + 0.02 * f64::from(bin);
        let share = share(&values, |noise| low <= noise && noise < low + 0.02);
        assert!((share - 0.1).abs() < 0.011, "{share} from {low}");
    }
}

/// In the other order a sensor that touches a wall would read more than 70 mm half the time, and
/// Wander would not get its -1.
#[test]
fn noise_comes_before_clipping() {
    for touching in [0.0, 30.0, 63.0] {
        assert_eq!(share(&ahead(touching), |mm| mm == 70.0), 1.0, "{touching}");
    }
    // At 70 mm the lower half is clipped; the upper half reaches 77 mm.
    let at_the_end = ahead(70.0);
    assert!((share(&at_the_end, |mm| mm == 70.0) - 0.5).abs() < 0.02);
    assert!(at_the_end.iter().copied().fold(0.0, f64::max) > 76.9);
    // Beyond the range by less than the noise, which sometimes brings the reading into the range.
    let beyond = ahead(375.0);
    let expected = (350.0 / 375.0 - 0.9) / 0.2;
    assert!((share(&beyond, |mm| mm < 350.0) - expected).abs() < 0.02);
    assert_eq!(share(&ahead(390.0), |mm| mm == 350.0), 1.0);
}

#[test]
fn the_noise_of_readings_is_independent() {
    // The robot heads for a battery, along a wall that two sensors measure.
    let world = world("environment-1");
    let pose = Pose {
        position: Point2::new(1500.0, RADIUS + 100.0),
        heading: Vector2::x(),
    };
    let mut rng = stream(3, 0, 0, Purpose::Trials);
    let mut noise = || {
        let state = world.begin(&pose, &mut rng);
        let target = state.target.unwrap();
        let [_, _, _, slant, side] = state.proximity_mm;
        [slant, side, target.angle_deg, target.distance_mm].map(f64::from)
    };
    let rows: Vec<_> = (0..5000).map(|_| noise()).collect();
    for a in 0..4 {
        for b in 0..a {
            let r = correlation(&rows, a, b).abs();
            assert!(r < 0.08, "readings {a} and {b} correlate with {r}");
        }
    }
}

fn correlation(rows: &[[f64; 4]], a: usize, b: usize) -> f64 {
    let count = rows.len() as f64;
    let mean = |i: usize| rows.iter().map(|row| row[i]).sum::<f64>() / count;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let moment = |i: usize, j: usize, m: f64, n: f64| {
        rows.iter()
            .map(|row| (row[i] - m) * (row[j] - n))
            .sum::<f64>()
    };
    let spread = moment(a, a, mean_a, mean_a) * moment(b, b, mean_b, mean_b);
    assert!(spread > 0.0, "a reading without noise");
    moment(a, b, mean_a, mean_b) / spread.sqrt()
}

/// A box around each battery, or around the nest, has no room for the robot. What is inside is
/// never visible, so that no state of that type can be sampled.
#[test]
fn sampling_returns_states_of_the_type_asked_for() {
    let boxed = |centres: &[[f64; 2]]| {
        let mut model = model("environment-1");
        for [x, y] in centres {
            let (a, b, c, d) = (x - 40.0, y - 40.0, x + 40.0, y + 40.0);
            let walls = [[a, b, c, b], [c, b, c, d], [c, d, a, d], [a, d, a, b]];
            model.arena.walls_mm.extend(walls);
        }
        ForagingWorld::new(&model).unwrap()
    };
    let mut rng = stream(4, 0, 0, Purpose::PolicySamples);
    let arena = model("environment-1").arena;
    let (no_battery, no_nest) = (boxed(&arena.batteries_mm), boxed(&[arena.nest_mm]));
    for (world, impossible) in [(&no_battery, BATTERY_VISIBLE), (&no_nest, NEST_VISIBLE)] {
        for state_type in [SEARCHING, BATTERY_VISIBLE, CARRYING, NEST_VISIBLE] {
            for _ in 0..20 {
                let percept = world.sample(state_type, &mut rng);
                assert_eq!(percept.is_none(), state_type == impossible);
                let Some(percept) = percept else { break };
                let visible = [BATTERY_VISIBLE, NEST_VISIBLE].contains(&state_type);
                assert_eq!(percept[DISTANCE] > 0.0, visible);
            }
        }
    }
}
