//! Invariants of random walks: bodies, state types, captures, deliveries, rewards.

use maxq_lab::random::{Purpose, Stream, stream};
use maxq_lab::worlds::foraging::defaults::COMMANDS;
use maxq_lab::worlds::foraging::{ForagingState, ForagingWorld, Pose, Task};
use maxq_lab::worlds::{SubtaskId, World};
use nalgebra::{Point2, Vector2};
use rand::RngExt;

use super::geometry::{RADIUS, clearance, crosses, sees, state_type, target_seen};
use super::{SCENARIOS, model, some_action, world};

/// One step of a walk.
struct Step {
    before: ForagingState,
    primitive: SubtaskId,
    action: usize,
    reward: f32,
    after: ForagingState,
}

/// Walks for a number of steps. A new trial starts after a delivery, and at random. Targets are
/// approached often enough to be reached.
fn walk(world: &ForagingWorld, seed: u64, steps: usize, mut visit: impl FnMut(&Step)) {
    let mut rng = stream(seed, 0, 0, Purpose::Trials);
    let mut state = world.begin(&world.draw_start(&mut rng), &mut rng);
    let mut held: Option<(SubtaskId, usize)> = None;
    for _ in 0..steps {
        let before = state;
        let (primitive, action) = match held.filter(|_| rng.random::<f32>() < 0.7) {
            Some(held) => held,
            None => towards_target(&state).unwrap_or_else(|| some_action(world, &state, &mut rng)),
        };
        let reward = world.step(&mut state, primitive, action, &mut rng);
        visit(&Step {
            before,
            primitive,
            action,
            reward,
            after: state,
        });
        // An action is repeated only while its subtask is active.
        let active = world.catalogue().subtask(primitive).active;
        held = Some((primitive, action)).filter(|_| active.contains(world.state_type(&state)));
        if matches!(state.task, Task::Delivered(_)) || rng.random::<f32>() < 0.001 {
            held = None;
            state = world.begin(&world.draw_start(&mut rng), &mut rng);
        }
    }
}

/// Returns an action towards a target that is near.
fn towards_target(state: &ForagingState) -> Option<(SubtaskId, usize)> {
    use maxq_lab::worlds::foraging::{APPROACH_BATTERY, APPROACH_NEST};
    let target = state.target.filter(|target| target.distance_mm < 900.0)?;
    let approach = match state.task {
        Task::EmptyHanded => APPROACH_BATTERY,
        _ => APPROACH_NEST,
    };
    let action = match target.angle_deg {
        angle if angle > 15.0 => 1,
        angle if angle < -15.0 => 2,
        _ => 0,
    };
    Some((approach, action))
}

#[test]
fn no_body_is_ever_inside_a_wall_or_crosses_one() {
    for scenario in SCENARIOS {
        let world = world(scenario);
        let (mut touching, mut nearest) = (0, f64::INFINITY);
        walk(&world, 1, 20_000, |step| {
            let (a, b) = (step.before.pose.position, step.after.pose.position);
            let clear = clearance(world.arena(), b);
            nearest = nearest.min(clear);
            touching += usize::from(clear < RADIUS + 1e-5);
            for wall in world.arena().walls.iter().filter(|_| a != b) {
                assert_ne!(crosses(a, b, wall), Some(true), "{a} to {b} in {scenario}");
            }
            assert!((step.after.pose.heading.norm() - 1.0).abs() < 1e-12);
        });
        assert!(nearest >= RADIUS - 1e-7, "{nearest} in {scenario}");
        assert!(touching > 1000, "{touching} contacts in {scenario}");
    }
}

#[test]
fn state_types_are_those_of_the_true_geometry() {
    for scenario in SCENARIOS {
        let world = world(scenario);
        let (mut seen, mut borders) = ([0; 6], 0);
        walk(&world, 2, 20_000, |step| {
            match state_type(&world, &step.after) {
                Some(expected) => {
                    assert_eq!(world.state_type(&step.after).number(), expected);
                    seen[expected] += 1;
                }
                None => borders += 1,
            }
        });
        assert!(
            seen[1..5].iter().all(|&count| count > 100),
            "{seen:?} in {scenario}"
        );
        assert!(
            seen[5] > 3 && borders < 20,
            "{seen:?}, {borders} borders in {scenario}"
        );
    }
}

#[test]
fn the_target_is_the_closest_visible_battery_or_the_nest() {
    for scenario in SCENARIOS {
        let world = world(scenario);
        let mut choices = 0;
        walk(&world, 3, 20_000, |step| {
            let state = &step.after;
            let Some(seen) = target_seen(world.arena(), &state.pose, state.task) else {
                return;
            };
            let batteries = 0..world.arena().batteries.len();
            let visible = |b| sees(world.arena(), &state.pose, b).flatten().is_some();
            if state.task == Task::EmptyHanded && batteries.filter(|&b| visible(b)).count() > 1 {
                choices += 1;
            }
            let (Some(sight), Some(reading)) = (seen, state.target) else {
                return assert!(seen.is_none() && state.target.is_none());
            };
            // Readings are within a tenth of the truth, and angles within the field of view.
            let angle = f64::from(reading.angle_deg);
            let off = (f64::from(reading.distance_mm) / sight.distance - 1.0).abs();
            let off_deg = (angle - sight.angle_deg).abs();
            assert!(off <= 0.1 + 1e-5, "{reading:?} for {sight:?}");
            assert!(
                off_deg <= 0.1 * sight.angle_deg.abs() + 1e-4,
                "{reading:?} for {sight:?}"
            );
            assert!(angle.abs() <= 60.0 && reading.distance_mm <= 3500.0);
        });
        assert!(choices > 50, "{choices} choices of a battery in {scenario}");
    }
}

#[test]
fn capture_and_delivery_happen_exactly_within_their_distances() {
    for scenario in SCENARIOS {
        let world = world(scenario);
        let (mut captures, mut deliveries) = (0, 0);
        walk(&world, 4, 40_000, |step| {
            // What the robot sees after its move decides, in the task before it.
            let task = step.before.task;
            let Some(seen) = target_seen(world.arena(), &step.after.pose, task) else {
                return;
            };
            let expected = match (task, seen) {
                (Task::EmptyHanded, Some(sight)) if sight.distance <= 160.0 => {
                    captures += 1;
                    Task::Carrying(sight.target)
                }
                (Task::Carrying(battery), Some(sight)) if sight.distance <= 200.0 => {
                    deliveries += 1;
                    Task::Delivered(battery)
                }
                _ => task,
            };
            assert_eq!(step.after.task, expected, "in {scenario}");
        });
        assert!(
            captures > 10 && deliveries > 5,
            "{captures}, {deliveries} in {scenario}"
        );
    }
}

/// The readings after the action decide. After a capture the battery has no reading left: its true
/// angle bounds the reward.
#[test]
fn rewards_are_those_of_equation_4_1() {
    for scenario in SCENARIOS {
        let world = world(scenario);
        let (mut failures, mut reached) = (0, 0);
        walk(&world, 5, 30_000, |step| {
            let name = step.primitive.name(world.catalogue());
            let nearest = step
                .after
                .proximity_mm
                .iter()
                .copied()
                .fold(f32::INFINITY, f32::min);
            let captured = step.before.task == Task::EmptyHanded
                && matches!(step.after.task, Task::Carrying(_));
            if step.action == 0 && COMMANDS.iter().any(|(command, _)| *command == name) {
                return assert_eq!(step.reward, 0.0);
            }
            // Recall imitates, by what the robot remembers before it acts.
            let name = match (name, step.before.task, step.before.recalled) {
                ("Recall", Task::EmptyHanded, Some(_)) => "ApproachBattery",
                ("Recall", _, Some(_)) => "ApproachNest",
                ("Recall", _, None) => "Wander",
                _ => name,
            };
            let recalls = step.primitive.name(world.catalogue()) == "Recall";
            let of_angle = |angle: f64| match name {
                "Turn" => -0.25 - angle.abs() / 80.0,
                _ => -angle.abs() / 60.0,
            };
            let reward = f64::from(step.reward);
            assert!((-1.0 - 1e-6..=0.0).contains(&reward));
            let expected = match name {
                "Avoid" | "Wander" if nearest <= 70.0 => -1.0,
                "Avoid" => [-0.5, -0.5, -0.75, -0.75, -0.875][step.action],
                "Wander" => [-0.25, -0.45, -0.45, -0.67, -0.67][step.action],
                _ if captured => {
                    let seen = target_seen(world.arena(), &step.after.pose, Task::EmptyHanded);
                    let Some(Some(sight)) = seen else { return };
                    let noisy = |noise: f64| (sight.angle_deg * noise).clamp(-60.0, 60.0);
                    let bounds = [of_angle(noisy(1.1)) - 1e-5, of_angle(noisy(0.9)) + 1e-5];
                    assert!(
                        (bounds[0]..=bounds[1]).contains(&reward),
                        "{reward} of {sight:?}"
                    );
                    reached += 1;
                    return;
                }
                _ => step
                    .after
                    .target
                    .or(step.after.recalled.filter(|_| recalls))
                    .map_or(-1.0, |target| of_angle(target.angle_deg.into())),
            };
            failures += usize::from(expected == -1.0);
            assert!(
                (reward - expected).abs() < 1e-6,
                "{name}: {reward}, not {expected}"
            );
        });
        assert!(
            failures > 100 && reached > 5,
            "{failures}, {reached} in {scenario}"
        );
    }
}

/// Table 4.4, integrated by small steps: no closed form to share a mistake with.
#[test]
fn actions_are_exact_arcs_in_the_open() {
    const PARTS: u32 = 20_000;
    let (world, model) = (world("environment-1"), model("environment-1"));
    let p = &model.primitives;
    let table: [(&str, &[[f64; 2]]); 5] = [
        ("Avoid", &p.avoid.actions_mm_per_s),
        ("Wander", &p.wander.actions_mm_per_s),
        ("ApproachBattery", &p.approach_battery.actions_mm_per_s),
        ("ApproachNest", &p.approach_nest.actions_mm_per_s),
        ("Turn", &p.turn.actions_mm_per_s),
    ];
    assert_eq!(
        table[1].1[3],
        [600.0, 100.0],
        "(right, left), Wander's fourth"
    );
    let mut rng = stream(6, 0, 0, Purpose::Trials);
    for (name, actions) in table {
        for (action, [right, left]) in actions.iter().enumerate() {
            let angle: f64 = rng.random::<f64>() * 6.0;
            let start = Pose {
                position: Point2::new(1200.0, 1700.0),
                heading: Vector2::new(angle.cos(), angle.sin()),
            };
            let (mut position, mut heading) = (start.position, angle);
            let dt = 0.1 / f64::from(PARTS);
            for _ in 0..PARTS {
                let turn = (right - left) / 150.0 * dt;
                let middle = heading + turn / 2.0;
                let forward = (right + left) / 2.0 * dt;
                position += Vector2::new(middle.cos(), middle.sin()) * forward;
                heading += turn;
            }
            let mut state = world.begin(&start, &mut rng);
            let primitive = world.catalogue().find(name).unwrap();
            world.step(&mut state, primitive, action, &mut rng);
            assert!(
                (state.pose.position - position).norm() < 1e-6,
                "{name} {action}"
            );
            let expected = Vector2::new(heading.cos(), heading.sin());
            assert!(
                (state.pose.heading - expected).norm() < 1e-9,
                "{name} {action}"
            );
        }
    }
}

#[test]
fn the_heading_follows_the_arc_and_the_body_never_goes_further() {
    let (world, model) = (world("environment-3"), model("environment-3"));
    let p = &model.primitives;
    let speeds = [
        &p.avoid.actions_mm_per_s,
        &p.wander.actions_mm_per_s,
        &p.approach_battery.actions_mm_per_s,
        &p.approach_nest.actions_mm_per_s,
        &p.turn.actions_mm_per_s,
    ];
    let mut stopped = 0;
    walk(&world, 7, 30_000, |step| {
        let first = world.catalogue().primitives().next().unwrap().index();
        let [right, left] = speeds[step.primitive.index() - first][step.action];
        let angle = |pose: &Pose| pose.heading.y.atan2(pose.heading.x);
        let turned = angle(&step.after.pose) - angle(&step.before.pose);
        let expected = (right - left) / 150.0 * 0.1;
        assert!((turned - expected).sin().abs() < 1e-9 && (turned - expected).cos() > 0.0);
        // The chord of the arc.
        let chord = match expected {
            0.0 => (right + left) / 2.0 * 0.1,
            turn => (right + left) / 2.0 * 0.1 * (turn / 2.0).sin() / (turn / 2.0),
        };
        let moved = (step.after.pose.position - step.before.pose.position).norm();
        assert!(moved <= chord.abs() + 1e-9, "{moved} of {chord}");
        stopped += usize::from(moved < chord.abs() - 1.0);
    });
    assert!(stopped > 1000);
}

#[test]
fn the_same_seed_gives_the_same_walk() {
    let world = world("environment-3");
    let bits = |seed| {
        let mut all = Vec::new();
        walk(&world, seed, 3000, |step| {
            let pose = &step.after.pose;
            all.extend([pose.position.x, pose.position.y, pose.heading.x].map(f64::to_bits));
            all.extend(step.after.proximity_mm.map(|mm| u64::from(mm.to_bits())));
            all.push(u64::from(step.reward.to_bits()));
        });
        all
    };
    assert_eq!(bits(11), bits(11));
    assert_ne!(bits(11), bits(12));
}

#[test]
fn starts_are_free_empty_handed_and_everywhere() {
    for scenario in SCENARIOS {
        let world = world(scenario);
        let mut rng: Stream = stream(8, 0, 0, Purpose::StartPoses);
        let mut quarters = [0; 8];
        for _ in 0..4000 {
            let start = world.draw_start(&mut rng);
            assert!(clearance(world.arena(), start.position) >= RADIUS);
            let state = world.begin(&start, &mut rng);
            assert_eq!((state.pose, state.task), (start, Task::EmptyHanded));
            let half = |value: f64, size: f64| usize::from(value > size / 2.0);
            let [x, y] = [start.position.x, start.position.y];
            quarters[2 * half(x, world.arena().size.x) + half(y, world.arena().size.y)] += 1;
            quarters[4 + 2 * half(start.heading.x, 0.0) + half(start.heading.y, 0.0)] += 1;
        }
        // Walls take little room: a quarter each, 150 being five standard deviations.
        assert!(
            quarters.iter().all(|count| (850..1150).contains(count)),
            "{quarters:?}"
        );
    }
}
