//! The rules that a scenario obeys, one small function for each part of it.
//!
//! Rules on hierarchies need the world's subtasks and are checked where the
//! hierarchies are read (`evolution`).

use std::fmt::Display;
use std::ops::RangeInclusive;

use super::{
    ArenaModel, CliffModel, EvolutionModel, FeatureModel, FenceModel, ForagingModel, LearningModel,
    MovementModel, PrimitiveLearning, Problem, RobotModel, Scenario, SensorModel, TargetModel,
    TaxiModel, TrainingModel, WorldModel,
};

/// Wheel speed limit of the Cyber Rodent in mm/s, Thesis 4.2.
const WHEEL_SPEED_LIMIT: f64 = 1300.0;
/// Bounds what a hostile file can make the program allocate or compute.
const MAX_WALLS: usize = 2000;
const MAX_BATTERIES: usize = 64;
const MAX_SLITS: usize = 200;
const MAX_FEATURES: usize = 1 << 14;
const MAX_TREE_BYTES: usize = 4096;
const MAX_DESCRIPTION_BYTES: usize = 2000;

/// Every rule that `scenario` breaks.
pub(super) fn problems(scenario: &Scenario) -> Vec<Problem> {
    let mut check = Check::default();
    check.range("format", scenario.format, super::FORMAT..=super::FORMAT);
    name(&mut check, &scenario.name);
    check.range(
        "description (bytes)",
        scenario.description.len(),
        0..=MAX_DESCRIPTION_BYTES,
    );
    match &scenario.world {
        WorldModel::Foraging(model) => check.within("world.foraging", |c| foraging(c, model)),
        WorldModel::Taxi(model) => check.within("world.taxi", |c| taxi(c, model)),
        WorldModel::Cliff(model) => check.within("world.cliff", |c| cliff(c, model)),
    }
    let trained = matches!(scenario.world, WorldModel::Foraging(_));
    check.within("learning", |c| learning(c, &scenario.learning, trained));
    check.within("evolution", |c| evolution(c, &scenario.evolution));
    check.problems
}

/// Collects problems; knows the place it is at.
#[derive(Default)]
struct Check {
    place: String,
    problems: Vec<Problem>,
}

impl Check {
    fn within(&mut self, part: &str, rules: impl FnOnce(&mut Self)) {
        let outer = self.place.clone();
        self.place = self.at(part);
        rules(self);
        self.place = outer;
    }

    fn at(&self, part: &str) -> String {
        if self.place.is_empty() || part.is_empty() || part.starts_with('[') {
            format!("{}{part}", self.place)
        } else {
            format!("{}.{part}", self.place)
        }
    }

    fn rule(&mut self, holds: bool, part: &str, found: impl Display, allowed: impl Display) {
        if !holds {
            self.problems.push(Problem {
                place: self.at(part),
                found: found.to_string(),
                allowed: allowed.to_string(),
            });
        }
    }

    /// `found` lies in `allowed`; a NaN lies nowhere.
    fn range<T: PartialOrd + Display>(&mut self, part: &str, found: T, allowed: RangeInclusive<T>) {
        let holds = allowed.contains(&found);
        let words = format!("{} to {}", allowed.start(), allowed.end());
        self.rule(holds, part, found, words);
    }

    fn point(&mut self, part: &str, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        let holds = (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
        let allowed = format!("inside the arena, [0 to {width}, 0 to {height}]");
        self.rule(holds, part, format!("[{x}, {y}]"), allowed);
    }
}

fn name(check: &mut Check, name: &str) {
    let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_.".contains(c);
    let holds =
        (1..=64).contains(&name.len()) && name.chars().all(letter) && !name.starts_with(['.', '-']);
    check.rule(
        holds,
        "name",
        format!("{name:?}"),
        "1 to 64 of a-z, 0-9, '-', '_' and '.', not starting with '.' or '-'",
    );
}

fn foraging(check: &mut Check, model: &ForagingModel) {
    check.within("arena", |c| arena(c, &model.arena, model.robot.radius_mm));
    check.within("robot", |c| robot(c, &model.robot));
    check.within("sensors", |c| sensors(c, &model.sensors));
    check.within("features", |c| features(c, &model.features));
    check.range("time_step_s", model.time_step_s, 0.001..=1.0);
    let p = &model.primitives;
    let t = &model.primitive_training;
    check.within("primitives", |c| {
        c.within("avoid", |c| movement(c, &p.avoid));
        c.within("wander", |c| movement(c, &p.wander));
        c.within("approach_battery", |c| target(c, &p.approach_battery));
        c.within("approach_nest", |c| target(c, &p.approach_nest));
        c.within("turn", |c| target(c, &p.turn));
    });
    check.within("primitive_training", |c| {
        c.within("avoid", |c| training(c, &t.avoid));
        c.within("wander", |c| training(c, &t.wander));
        c.within("approach_battery", |c| training(c, &t.approach_battery));
        c.within("approach_nest", |c| training(c, &t.approach_nest));
        c.within("turn", |c| training(c, &t.turn));
    });
}

fn arena(check: &mut Check, arena: &ArenaModel, radius: f64) {
    let smallest = 4.0 * radius.clamp(0.0, 1000.0);
    check.range("size_mm[0]", arena.size_mm[0], smallest..=20_000.0);
    check.range("size_mm[1]", arena.size_mm[1], smallest..=20_000.0);
    let pieces = arena.fences.iter().map(|fence| fence.slits_at_mm.len() + 1);
    let walls = arena.walls_mm.len() + pieces.sum::<usize>();
    check.range("walls_mm and fences (solid pieces)", walls, 0..=MAX_WALLS);
    for (i, [x1, y1, x2, y2]) in arena.walls_mm.iter().copied().enumerate() {
        check.within(&format!("walls_mm[{i}]"), |c| {
            segment(c, ["", ""], [x1, y1], [x2, y2], arena.size_mm);
        });
    }
    for (i, model) in arena.fences.iter().enumerate() {
        check.within(&format!("fences[{i}]"), |c| fence(c, model, arena.size_mm));
    }
    let batteries = arena.batteries_mm.len();
    check.range("batteries_mm (number)", batteries, 1..=MAX_BATTERIES);
    for (i, &battery) in arena.batteries_mm.iter().enumerate() {
        check.point(&format!("batteries_mm[{i}]"), battery, arena.size_mm);
    }
    check.point("nest_mm", arena.nest_mm, arena.size_mm);
}

fn segment(check: &mut Check, parts: [&str; 2], from: [f64; 2], to: [f64; 2], size: [f64; 2]) {
    check.point(parts[0], from, size);
    check.point(parts[1], to, size);
    let apart = from != to;
    check.rule(
        apart,
        parts[1],
        format!("{to:?}"),
        "another point than the first end",
    );
}

fn fence(check: &mut Check, fence: &FenceModel, size: [f64; 2]) {
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

fn robot(check: &mut Check, robot: &RobotModel) {
    check.range("radius_mm", robot.radius_mm, 1.0..=1000.0);
    check.range("wheel_base_mm", robot.wheel_base_mm, 1.0..=2000.0);
    check.range(
        "capture_distance_mm",
        robot.capture_distance_mm,
        1.0..=20_000.0,
    );
    check.range(
        "delivery_distance_mm",
        robot.delivery_distance_mm,
        1.0..=20_000.0,
    );
}

fn sensors(check: &mut Check, sensors: &SensorModel) {
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
    check.range(
        "vision_half_angle_deg",
        sensors.vision_half_angle_deg,
        1.0..=89.0,
    );
    check.range("vision_range_mm", sensors.vision_range_mm, 1.0..=50_000.0);
    check.range("noise", sensors.noise, 0.0..=0.9);
}

fn features(check: &mut Check, features: &FeatureModel) {
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

fn reward(check: &mut Check, part: &str, reward: f64) {
    check.range(part, reward, -1000.0..=1000.0);
}

fn movement(check: &mut Check, model: &MovementModel) {
    actions(check, &model.actions_mm_per_s);
    let (rewards, expected) = (model.rewards.len(), model.actions_mm_per_s.len());
    check.rule(
        rewards == expected,
        "rewards (number)",
        rewards,
        format!("{expected}, one for each action"),
    );
    for (i, &value) in model.rewards.iter().enumerate() {
        reward(check, &format!("rewards[{i}]"), value);
    }
    reward(check, "failure_reward", model.failure_reward);
}

fn target(check: &mut Check, model: &TargetModel) {
    actions(check, &model.actions_mm_per_s);
    reward(check, "reward_offset", model.reward_offset);
    check.range(
        "reward_divisor_deg",
        model.reward_divisor_deg,
        0.1..=100_000.0,
    );
    reward(check, "failure_reward", model.failure_reward);
}

fn training(check: &mut Check, model: &TrainingModel) {
    check.range("steps", model.steps, 0..=10_000_000);
    check.range("episode_steps", model.episode_steps, 1..=1_000_000);
    check.range(
        "temperature_decrease",
        model.temperature_decrease,
        0.0..=1.0,
    );
}

fn taxi(check: &mut Check, model: &TaxiModel) {
    check.range("slip", model.slip, 0.0..=1.0);
    check.range("change_of_mind", model.change_of_mind, 0.0..=1.0);
    reward(check, "step_reward", model.step_reward);
    reward(check, "delivery_reward", model.delivery_reward);
    reward(check, "illegal_reward", model.illegal_reward);
}

fn cliff(check: &mut Check, model: &CliffModel) {
    check.range("width", model.width, 3..=64);
    check.range("height", model.height, 2..=64);
    reward(check, "step_reward", model.step_reward);
    reward(check, "fall_reward", model.fall_reward);
    check.range("rbf_width_cells", model.rbf_width_cells, 0.1..=10.0);
}

fn learning(check: &mut Check, learning: &LearningModel, trained: bool) {
    let learns = trained || learning.primitive_learning != PrimitiveLearning::Frozen;
    check.rule(
        learns,
        "primitive_learning",
        "\"frozen\"",
        "\"individual\" or \"shared\": the primitive subtasks of this world are not trained beforehand",
    );
    check.range("learning_rate", learning.learning_rate, 0.0..=1.0);
    check.range("discount", learning.discount, 0.0..=1.0);
    check.range(
        "temperature_limit",
        learning.temperature_limit,
        0.001..=1000.0,
    );
    let limit = learning.temperature_limit.clamp(0.001, 1000.0);
    check.range(
        "initial_temperature",
        learning.initial_temperature,
        limit..=1000.0,
    );
    check.range(
        "temperature_decrease",
        learning.temperature_decrease,
        0.0..=1.0,
    );
    check.range("probability_limit", learning.probability_limit, 0.0..=1.0);
    check.range("epsilon", learning.epsilon, 0.0..=1.0);
    check.range("pseudo_penalty", learning.pseudo_penalty, 0.0..=1000.0);
    check.range(
        "initial_parameter",
        learning.initial_parameter,
        -1000.0..=1000.0,
    );
}

fn evolution(check: &mut Check, evolution: &EvolutionModel) {
    let size = evolution.population_size;
    check.range("population_size", size, 4..=1024);
    let reproduced = evolution.reproduced;
    let survivors = size.saturating_sub(reproduced);
    check.range(
        "reproduced",
        reproduced,
        1..=(size / 2).saturating_sub(1).max(1),
    );
    check.rule(
        survivors.is_multiple_of(2),
        "population_size minus reproduced",
        survivors,
        "an even number, because crossover makes pairs",
    );
    check.range(
        "tournament_size",
        evolution.tournament_size,
        1..=survivors.max(1),
    );
    let trials = evolution.trials_per_generation;
    check.range("trials_per_generation", trials, 2..=1024);
    check.rule(
        trials.is_multiple_of(2),
        "trials_per_generation",
        trials,
        "an even number, because half of them is scored",
    );
    check.range("maximum_depth", evolution.maximum_depth, 2..=8);
    check.range("generation_limit", evolution.generation_limit, 1..=100_000);
    check.range("trial_step_limit", evolution.trial_step_limit, 1..=100_000);
    check.range("policy_samples", evolution.policy_samples, 1..=10_000);
    let trees = evolution.initial_population.len();
    check.rule(
        trees == size,
        "initial_population (number)",
        trees,
        format!("{size}, the population_size"),
    );
    for (i, tree) in evolution.initial_population.iter().enumerate() {
        let part = format!("initial_population[{i}] (bytes)");
        check.range(&part, tree.len(), 1..=MAX_TREE_BYTES);
    }
}
