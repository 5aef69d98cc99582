//! The rules for the settings of the foraging task, one function for each part.

use super::settings::{
    ArenaSettings, FeatureSettings, FenceSettings, ForagingSettings, MovementSettings,
    RobotSettings, SensorSettings, TargetSettings,
};
use crate::rules::Check;

/// Wheel speed limit of the Cyber Rodent in mm/s, Thesis 4.2.
const WHEEL_SPEED_LIMIT: f64 = 1300.0;
// These bound the memory and work that a hostile file can cause.
const MAX_WALLS: usize = 2000;
const MAX_BATTERIES: usize = 64;
const MAX_SLITS: usize = 200;
const MAX_FEATURES: usize = 1 << 14;

/// Checks every rule.
pub(super) fn rules(check: &mut Check, settings: &ForagingSettings) {
    check.within("arena", |c| {
        arena(c, &settings.arena, settings.robot.radius_mm)
    });
    check.within("robot", |c| robot(c, &settings.robot));
    check.within("sensors", |c| sensors(c, &settings.sensors));
    check.within("features", |c| features(c, &settings.features));
    check.range("time_step_s", settings.time_step_s, 0.001..=1.0);
    if let Some(memory) = &settings.memory {
        let noise = memory.odometry_noise;
        check.range("memory.odometry_noise", noise, 0.0..=0.9);
    }
    let p = &settings.primitives;
    let t = &settings.primitive_training;
    check.within("primitives", |c| {
        c.within("avoid", |c| movement(c, &p.avoid));
        c.within("wander", |c| movement(c, &p.wander));
        c.within("approach_battery", |c| target(c, &p.approach_battery));
        c.within("approach_nest", |c| target(c, &p.approach_nest));
        c.within("turn", |c| target(c, &p.turn));
    });
    check.within("primitive_training", |c| {
        c.within("avoid", |c| t.avoid.check(c));
        c.within("wander", |c| t.wander.check(c));
        c.within("approach_battery", |c| t.approach_battery.check(c));
        c.within("approach_nest", |c| t.approach_nest.check(c));
        c.within("turn", |c| t.turn.check(c));
    });
}

fn arena(check: &mut Check, arena: &ArenaSettings, radius: f64) {
    let smallest = 4.0 * radius.clamp(0.0, 1000.0);
    check.range("size_mm[0]", arena.size_mm[0], smallest..=20_000.0);
    check.range("size_mm[1]", arena.size_mm[1], smallest..=20_000.0);
    let pieces = arena.fences.iter().map(|fence| fence.slits_at_mm.len() + 1);
    let transparent = &arena.transparent_walls_mm;
    let walls = arena.walls_mm.len() + pieces.sum::<usize>() + transparent.len();
    check.range("walls_mm and fences (solid pieces)", walls, 0..=MAX_WALLS);
    for (name, walls) in [
        ("walls_mm", &arena.walls_mm),
        ("transparent_walls_mm", transparent),
    ] {
        for (i, [x1, y1, x2, y2]) in walls.iter().copied().enumerate() {
            check.within(&format!("{name}[{i}]"), |c| {
                segment(c, ["", ""], [x1, y1], [x2, y2], arena.size_mm);
            });
        }
    }
    for (i, settings) in arena.fences.iter().enumerate() {
        check.within(&format!("fences[{i}]"), |c| {
            fence(c, settings, arena.size_mm)
        });
    }
    let batteries = arena.batteries_mm.len();
    check.range("batteries_mm (number)", batteries, 1..=MAX_BATTERIES);
    for (i, &battery) in arena.batteries_mm.iter().enumerate() {
        point(check, &format!("batteries_mm[{i}]"), battery, arena.size_mm);
    }
    point(check, "nest_mm", arena.nest_mm, arena.size_mm);
}

fn segment(check: &mut Check, parts: [&str; 2], from: [f64; 2], to: [f64; 2], size: [f64; 2]) {
    point(check, parts[0], from, size);
    point(check, parts[1], to, size);
    let apart = from != to;
    check.rule(
        apart,
        parts[1],
        format!("{to:?}"),
        "another point than the first end",
    );
}

fn fence(check: &mut Check, fence: &FenceSettings, size: [f64; 2]) {
    segment(
        check,
        ["from_mm", "to_mm"],
        fence.from_mm,
        fence.to_mm,
        size,
    );
    check.range(
        "slits_at_mm (number)",
        fence.slits_at_mm.len(),
        0..=MAX_SLITS,
    );
    check.range("slit_width_mm", fence.slit_width_mm, 1.0..=20_000.0);
    let half = fence.slit_width_mm / 2.0;
    let mut solid_from = 0.0;
    let end = fence.length_mm();
    for (i, &at) in fence.slits_at_mm.iter().enumerate() {
        let holds = at - half > solid_from && at + half < end;
        let (low, high) = (solid_from + half, end - half);
        let part = format!("slits_at_mm[{i}]");
        check.rule(
            holds,
            &part,
            at,
            format!("between {low} and {high}, slits apart"),
        );
        solid_from = at + half;
    }
}

fn robot(check: &mut Check, robot: &RobotSettings) {
    check.ranges([
        ("radius_mm", robot.radius_mm, 1.0..=1000.0),
        ("wheel_base_mm", robot.wheel_base_mm, 1.0..=2000.0),
        (
            "capture_distance_mm",
            robot.capture_distance_mm,
            1.0..=20_000.0,
        ),
        (
            "delivery_distance_mm",
            robot.delivery_distance_mm,
            1.0..=20_000.0,
        ),
    ]);
}

fn sensors(check: &mut Check, sensors: &SensorSettings) {
    for (i, &angle) in sensors.proximity_angles_deg.iter().enumerate() {
        check.range(&format!("proximity_angles_deg[{i}]"), angle, -180.0..=180.0);
    }
    let [low, high] = sensors.proximity_range_mm;
    check.range("proximity_range_mm[0]", low, 0.0..=5000.0);
    check.range("proximity_range_mm[1]", high, 1.0..=5000.0);
    check.rule(
        low < high,
        "proximity_range_mm",
        format!("[{low}, {high}]"),
        "smallest below largest",
    );
    check.ranges([
        (
            "vision_half_angle_deg",
            sensors.vision_half_angle_deg,
            1.0..=89.0,
        ),
        ("vision_range_mm", sensors.vision_range_mm, 1.0..=50_000.0),
        ("noise", sensors.noise, 0.0..=0.9),
    ]);
}

fn features(check: &mut Check, features: &FeatureSettings) {
    check.range("proximity_centres", features.proximity_centres, 2..=4);
    check.range("angle_centres", features.angle_centres, 2..=32);
    check.range("distance_centres", features.distance_centres, 2..=32);
    check.range("approach_centres", features.approach_centres, 2..=128);
    check.range("turn_centres", features.turn_centres, 2..=128);
    let width = features
        .proximity_centres
        .saturating_pow(5)
        .saturating_mul(features.angle_centres)
        .saturating_mul(features.distance_centres);
    let part = "proximity_centres^5 x angle_centres x distance_centres";
    check.range(part, width, 1..=MAX_FEATURES);
}

fn actions(check: &mut Check, actions: &[[f64; 2]]) {
    check.range("actions_mm_per_s (number)", actions.len(), 1..=16);
    for (i, action) in actions.iter().enumerate() {
        for (j, &speed) in action.iter().enumerate() {
            let part = format!("actions_mm_per_s[{i}][{j}]");
            check.range(&part, speed, -WHEEL_SPEED_LIMIT..=WHEEL_SPEED_LIMIT);
        }
    }
}

fn movement(check: &mut Check, settings: &MovementSettings) {
    actions(check, &settings.actions_mm_per_s);
    let (rewards, expected) = (settings.rewards.len(), settings.actions_mm_per_s.len());
    check.rule(
        rewards == expected,
        "rewards (number)",
        rewards,
        format!("{expected}, one for each action"),
    );
    for (i, &value) in settings.rewards.iter().enumerate() {
        check.reward(&format!("rewards[{i}]"), value);
    }
    check.reward("failure_reward", settings.failure_reward);
}

fn target(check: &mut Check, settings: &TargetSettings) {
    actions(check, &settings.actions_mm_per_s);
    check.reward("reward_offset", settings.reward_offset);
    check.range(
        "reward_divisor_deg",
        settings.reward_divisor_deg,
        0.1..=100_000.0,
    );
    check.reward("failure_reward", settings.failure_reward);
}

fn point(check: &mut Check, part: &str, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
    let holds = (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
    let allowed = format!("inside the arena, [0 to {width}, 0 to {height}]");
    check.rule(holds, part, format!("[{x}, {y}]"), allowed);
}
