//! Every rule of a scenario, with a setting that breaks it and the place that the error names.

use maxq_lab::scenario::{Scenario, ScenarioError};

use super::common::{output, program, short, smoke, stderr};
use super::{assert_says, refused};

/// A setting of `smoke`, and the place of the rule that it breaks.
const RULES: &[(&str, &str)] = &[
    ("format=2", "format"),
    ("name=Capital", "name"),
    ("name=", "name"),
    ("name=../up", "name"),
    ("name=.hidden", "name"),
    ("world.foraging.time_step_s=0", "world.foraging.time_step_s"),
    (
        "world.foraging.arena.size_mm=[299, 2000]",
        "world.foraging.arena.size_mm[0]",
    ),
    (
        "world.foraging.arena.size_mm=[2000, 20001]",
        "world.foraging.arena.size_mm[1]",
    ),
    (
        "world.foraging.arena.walls_mm=[[0, 0, 9, 9], [5, 5, 5, 5]]",
        "world.foraging.arena.walls_mm[1]",
    ),
    (
        "world.foraging.arena.walls_mm=[[0, 0, 2001, 9]]",
        "world.foraging.arena.walls_mm[0]",
    ),
    (
        "world.foraging.arena.walls_mm=[[-1, 0, 9, 9]]",
        "world.foraging.arena.walls_mm[0]",
    ),
    (
        "world.foraging.arena.batteries_mm=[]",
        "world.foraging.arena.batteries_mm (number)",
    ),
    (
        "world.foraging.arena.batteries_mm.1=[9, -1]",
        "world.foraging.arena.batteries_mm[1]",
    ),
    (
        "world.foraging.arena.nest_mm=[9, 2001]",
        "world.foraging.arena.nest_mm",
    ),
    (
        "world.foraging.robot.radius_mm=0",
        "world.foraging.robot.radius_mm",
    ),
    (
        "world.foraging.robot.wheel_base_mm=0",
        "world.foraging.robot.wheel_base_mm",
    ),
    (
        "world.foraging.robot.capture_distance_mm=0",
        "world.foraging.robot.capture_distance_mm",
    ),
    (
        "world.foraging.robot.delivery_distance_mm=1e9",
        "world.foraging.robot.delivery_distance_mm",
    ),
    (
        "world.foraging.sensors.proximity_angles_deg.4=181",
        "world.foraging.sensors.proximity_angles_deg[4]",
    ),
    (
        "world.foraging.sensors.proximity_range_mm=[-1, 350]",
        "world.foraging.sensors.proximity_range_mm[0]",
    ),
    (
        "world.foraging.sensors.proximity_range_mm=[70, 5001]",
        "world.foraging.sensors.proximity_range_mm[1]",
    ),
    (
        "world.foraging.sensors.proximity_range_mm=[350, 70]",
        "world.foraging.sensors.proximity_range_mm",
    ),
    (
        "world.foraging.sensors.vision_half_angle_deg=90",
        "world.foraging.sensors.vision_half_angle_deg",
    ),
    (
        "world.foraging.sensors.vision_range_mm=0",
        "world.foraging.sensors.vision_range_mm",
    ),
    (
        "world.foraging.sensors.noise=1",
        "world.foraging.sensors.noise",
    ),
    (
        "world.foraging.features.proximity_centres=5",
        "world.foraging.features.proximity_centres",
    ),
    (
        "world.foraging.features.angle_centres=1",
        "world.foraging.features.angle_centres",
    ),
    (
        "world.foraging.features.distance_centres=33",
        "world.foraging.features.distance_centres",
    ),
    (
        "world.foraging.features.approach_centres=129",
        "world.foraging.features.approach_centres",
    ),
    (
        "world.foraging.features.turn_centres=0",
        "world.foraging.features.turn_centres",
    ),
    (
        r#"world.foraging.features={"proximity_centres":4,"angle_centres":32}"#,
        "world.foraging.features.proximity_centres^5 x angle_centres x distance_centres",
    ),
    (
        "world.foraging.primitives.avoid.actions_mm_per_s=[]",
        "world.foraging.primitives.avoid.actions_mm_per_s (number)",
    ),
    (
        "world.foraging.primitives.wander.actions_mm_per_s.0=[1301, 0]",
        "world.foraging.primitives.wander.actions_mm_per_s[0][0]",
    ),
    (
        "world.foraging.primitives.turn.actions_mm_per_s.1=[0, -1301]",
        "world.foraging.primitives.turn.actions_mm_per_s[1][1]",
    ),
    (
        "world.foraging.primitives.avoid.rewards=[0]",
        "world.foraging.primitives.avoid.rewards (number)",
    ),
    (
        "world.foraging.primitives.avoid.rewards.2=1001",
        "world.foraging.primitives.avoid.rewards[2]",
    ),
    (
        "world.foraging.primitives.wander.failure_reward=-1001",
        "world.foraging.primitives.wander.failure_reward",
    ),
    (
        "world.foraging.primitives.turn.reward_offset=1001",
        "world.foraging.primitives.turn.reward_offset",
    ),
    (
        "world.foraging.primitives.approach_nest.reward_divisor_deg=0",
        "world.foraging.primitives.approach_nest.reward_divisor_deg",
    ),
    (
        "world.foraging.primitives.approach_battery.failure_reward=1e300",
        "world.foraging.primitives.approach_battery.failure_reward",
    ),
    (
        "world.foraging.primitive_training.avoid.steps=10000001",
        "world.foraging.primitive_training.avoid.steps",
    ),
    (
        "world.foraging.primitive_training.turn.episode_steps=0",
        "world.foraging.primitive_training.turn.episode_steps",
    ),
    (
        "world.foraging.primitive_training.wander.temperature_decrease=1.1",
        "world.foraging.primitive_training.wander.temperature_decrease",
    ),
    ("learning.learning_rate=1.1", "learning.learning_rate"),
    ("learning.discount=-0.1", "learning.discount"),
    ("learning.temperature_limit=0", "learning.temperature_limit"),
    (
        "learning.initial_temperature=0.01",
        "learning.initial_temperature",
    ),
    (
        "learning.temperature_decrease=2",
        "learning.temperature_decrease",
    ),
    ("learning.probability_limit=2", "learning.probability_limit"),
    ("learning.epsilon=-1", "learning.epsilon"),
    (
        "learning.initial_parameter=1001",
        "learning.initial_parameter",
    ),
    ("learning.persistence=0", "learning.persistence"),
    ("learning.persistence=1000000000", "learning.persistence"),
    ("learning.replay=1000000000", "learning.replay"),
    (
        r#"learning.composite_reward={"per_step":0}"#,
        "learning.composite_reward.per_step",
    ),
    (
        r#"learning.composite_reward={"per_step":1}"#,
        "learning.composite_reward.per_step",
    ),
    (
        r#"learning.composite_reward={"per_step":-1e300}"#,
        "learning.composite_reward.per_step",
    ),
    (
        "learning.composite_temperature=0",
        "learning.composite_temperature",
    ),
    (
        "evolution.control_step_limit=0",
        "evolution.control_step_limit",
    ),
    (
        r#"world.foraging.memory={"odometry_noise":-0.1}"#,
        "world.foraging.memory.odometry_noise",
    ),
    (
        "world.foraging.arena.transparent_walls_mm=[[0, 0, 9, 9], [0, 0, 2001, 9]]",
        "world.foraging.arena.transparent_walls_mm[1]",
    ),
    ("evolution.population_size=2", "evolution.population_size"),
    (
        "evolution.population_size=10",
        "evolution.initial_population (number)",
    ),
    (
        "evolution.reproduced=1",
        "evolution.population_size minus reproduced",
    ),
    ("evolution.reproduced=4", "evolution.reproduced"),
    ("evolution.tournament_size=7", "evolution.tournament_size"),
    (
        "evolution.prune_probability=1.1",
        "evolution.prune_probability",
    ),
    (
        "evolution.grow_probability=-0.1",
        "evolution.grow_probability",
    ),
    (
        "evolution.trials_per_generation=0",
        "evolution.trials_per_generation",
    ),
    (
        "evolution.trials_per_generation=3",
        "evolution.trials_per_generation",
    ),
    ("evolution.maximum_depth=9", "evolution.maximum_depth"),
    ("evolution.generation_limit=0", "evolution.generation_limit"),
    (
        "evolution.trial_step_limit=100001",
        "evolution.trial_step_limit",
    ),
    ("evolution.policy_samples=0", "evolution.policy_samples"),
    (
        "evolution.initial_population.3=",
        "evolution.initial_population[3] (bytes)",
    ),
];

/// A fence of the smoke arena with one change.
const FENCES: &[(&str, &str)] = &[
    (
        r#""from_mm":[0,2001],"to_mm":[9,9],"slit_width_mm":9,"slits_at_mm":[]"#,
        "from_mm",
    ),
    (
        r#""from_mm":[9,9],"to_mm":[9,9],"slit_width_mm":9,"slits_at_mm":[]"#,
        "to_mm",
    ),
    (
        r#""from_mm":[0,9],"to_mm":[900,9],"slit_width_mm":0,"slits_at_mm":[]"#,
        "slit_width_mm",
    ),
    (
        r#""from_mm":[0,9],"to_mm":[900,9],"slit_width_mm":9,"slits_at_mm":[4]"#,
        "slits_at_mm[0]",
    ),
    (
        r#""from_mm":[0,9],"to_mm":[900,9],"slit_width_mm":9,"slits_at_mm":[50,55]"#,
        "slits_at_mm[1]",
    ),
    (
        r#""from_mm":[0,9],"to_mm":[900,9],"slit_width_mm":9,"slits_at_mm":[899]"#,
        "slits_at_mm[0]",
    ),
];

/// A scenario of another world, a setting of it, and the place of the rule that it breaks.
const OTHER_WORLDS: &[(&str, &str, &str)] = &[
    ("taxi", "slip=1.1", "slip"),
    ("taxi", "change_of_mind=-0.1", "change_of_mind"),
    ("taxi", "step_reward=1001", "step_reward"),
    ("taxi", "delivery_reward=-1001", "delivery_reward"),
    ("taxi", "illegal_reward=1e9", "illegal_reward"),
    ("taxi", "map=[]", "map"),
    ("taxi", r#"map=["R:G", "R"]"#, "map[1]"),
    ("taxi", r#"map=["R;G"]"#, "map[0], character 1"),
    ("cliff", "width=2", "width"),
    ("cliff", "height=65", "height"),
    ("cliff", "step_reward=1001", "step_reward"),
    ("cliff", "fall_reward=-1001", "fall_reward"),
    ("cliff", "rbf_width_cells=0", "rbf_width_cells"),
];

/// The places of the problems that a setting causes.
fn places(scenario: &Scenario, setting: &str) -> Vec<String> {
    match scenario.clone().with_settings(&[setting.to_owned()]) {
        Err(ScenarioError::Invalid { problems, .. }) => {
            let complete = |text: &str| assert!(!text.is_empty(), "{setting}: {problems:?}");
            for problem in &problems {
                complete(&problem.found);
                complete(&problem.allowed);
            }
            problems.into_iter().map(|problem| problem.place).collect()
        }
        other => panic!("{setting}: {other:?}"),
    }
}

#[test]
fn every_broken_rule_names_its_place() {
    for (setting, place) in RULES {
        let places = places(&smoke(&[]), setting);
        assert!(
            places.iter().any(|named| named == place),
            "{setting}: {places:?}"
        );
    }
    for (fence, place) in FENCES {
        let places = places(
            &smoke(&[]),
            &format!("world.foraging.arena.fences=[{{{fence}}}]"),
        );
        let place = format!("world.foraging.arena.fences[0].{place}");
        assert!(places.contains(&place), "{fence}: {places:?}");
    }
    for (world, setting, place) in OTHER_WORLDS {
        let scenario = Scenario::load(world).unwrap();
        let places = places(&scenario, &format!("world.{world}.{setting}"));
        let place = format!("world.{world}.{place}");
        assert_eq!(places, [place], "{setting}");
    }
}

#[test]
fn all_broken_rules_are_reported_together() {
    let taxi = Scenario::load("taxi").unwrap();
    let world = r#"world.taxi={"map":["R|G"],"slip":2}"#;
    assert_eq!(places(&taxi, world), ["world.taxi.map", "world.taxi.slip"]);
}

#[test]
fn lists_have_limits() {
    let repeated = |item: &str, times: usize| vec![item; times].join(",");
    for (setting, place) in [
        (
            format!("description={}", "a".repeat(2001)),
            "description (bytes)",
        ),
        (
            format!(
                "world.foraging.arena.walls_mm=[{}]",
                repeated("[0,0,9,9]", 2001)
            ),
            "world.foraging.arena.walls_mm and fences (solid pieces)",
        ),
        (
            format!(
                "world.foraging.arena.batteries_mm=[{}]",
                repeated("[9,9]", 65)
            ),
            "world.foraging.arena.batteries_mm (number)",
        ),
        (
            format!(
                r#"world.foraging.arena.fences=[{{"from_mm":[0,9],"to_mm":[900,9],"slit_width_mm":1,"slits_at_mm":[{}]}}]"#,
                repeated("9", 201)
            ),
            "world.foraging.arena.fences[0].slits_at_mm (number)",
        ),
        (
            format!(
                "world.foraging.primitives.turn.actions_mm_per_s=[{}]",
                repeated("[0,0]", 17)
            ),
            "world.foraging.primitives.turn.actions_mm_per_s (number)",
        ),
        (
            format!("evolution.initial_population.0={}", "a".repeat(4097)),
            "evolution.initial_population[0] (bytes)",
        ),
    ] {
        assert!(
            places(&smoke(&[]), &setting)
                .iter()
                .any(|named| named == place),
            "{place}"
        );
    }
}

#[test]
fn the_program_reports_all_broken_rules_together() {
    let said = refused(program().args(["run", "smoke"]).args([
        "--set",
        "learning.discount=2",
        "--set",
        "evolution.trials_per_generation=3",
    ]));
    assert_says(
        &said,
        &[
            "--set: ",
            "learning.discount: found 2; allowed: 0 to 1",
            "evolution.trials_per_generation: found 3; allowed: an even number",
        ],
    );
}

#[test]
fn malformed_settings_are_rejected() {
    for (setting, parts) in [
        ("learning", &["allowed: key=value"][..]),
        (
            "=1",
            &["found no \"\" at the top level; allowed there: description"],
        ),
        ("learning.gamma=1", &["\"gamma\" at learning", "discount"]),
        (
            "learning.discount=NaN",
            &["learning.discount", "found \"NaN\"; allowed: a number"],
        ),
        (
            "learning.discount=1e999",
            &["learning.discount", "found \"1e999\"; allowed: a number"],
        ),
        (
            "evolution.initial_population.8=x",
            &["\"8\"", "allowed there: 0 to 7"],
        ),
        (
            "evolution.initial_population.-1=x",
            &["allowed there: 0 to 7"],
        ),
        (
            "evolution.selection=best",
            &[
                "evolution.selection",
                "found \"best\"; allowed: fitness, random",
            ],
        ),
        ("name.first=x", &["it is a single value"]),
        (
            r#"learning.composite_reward={"per_step":"NaN"}"#,
            &["learning.composite_reward", "\"NaN\""],
        ),
        (
            r#"learning.composite_reward={"per_step":1e999}"#,
            &["learning.composite_reward"],
        ),
        (
            "learning.composite_reward=per_step",
            &["learning.composite_reward.per_step: found the name alone; allowed: the name with"],
        ),
        (
            "learning.exit_value=goal",
            &[
                "learning.exit_value",
                "allowed: pseudo_reward, continuation",
            ],
        ),
    ] {
        let said = refused(program().args(["run", "smoke", "--set", setting]));
        assert_says(&said, &[&format!("--set {setting}: ")]);
        assert_says(&said, parts);
    }
}

/// Recall needs a memory, Forward needs commands.
#[test]
fn a_hierarchy_has_only_subtasks_that_the_world_has() {
    for (subtask, setting) in [
        ("Recall", r#"world.foraging.memory={"odometry_noise":0}"#),
        ("Forward", "world.foraging.commands=true"),
    ] {
        let tree = format!("evolution.initial_population.2=(Root Wander {subtask})");
        let said = refused(program().args(["check", "smoke", "--set", &tree]));
        let parts = ["evolution.initial_population[2]: ", subtask, "allowed: "];
        assert_says(&said, &parts);
        let allowed = output(program().args(["check", "smoke", "--set", &tree, "--set", setting]));
        assert!(allowed.status.success(), "{}", stderr(&allowed));
    }
}

#[test]
fn the_largest_and_smallest_numbers_allowed_do_not_panic() {
    // Learning with the most extreme values allowed; a run may fail, but says why.
    let scenario = short(&[
        "learning.learning_rate=1",
        "learning.discount=1",
        "learning.initial_parameter=-1000",
        "learning.epsilon=0",
        "learning.temperature_limit=0.001",
        "learning.initial_temperature=0.001",
        "learning.pseudo_reward=all",
        "world.foraging.primitives.avoid.failure_reward=-1000",
        "world.foraging.primitives.turn.reward_offset=1000",
        "world.foraging.primitives.approach_nest.reward_divisor_deg=0.1",
        "world.foraging.sensors.noise=0.9",
        "world.foraging.time_step_s=1",
        "evolution.maximum_depth=8",
        "evolution.tournament_size=6",
    ]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let run = maxq_lab::lab::start(scenario, 1, &path, &Default::default());
    let ended = run.unwrap().join();
    // NaN would be written as null, which no log may contain.
    assert!(maxq_lab::lab::read_events(&path.join("events.jsonl")).is_ok());
    match ended {
        Ok(outcome) => assert_eq!(outcome.generations, 6),
        Err(error) => assert!(
            error.to_string().contains("learning has diverged"),
            "{error}"
        ),
    }
}
