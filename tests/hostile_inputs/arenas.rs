//! Arenas whose numbers are valid and whose geometry is not: the task cannot be done, or is odd.

use std::fs;

use maxq_lab::scenario::EMBEDDED;

use super::common::{SHORT, output, program, stderr, stdout};
use super::{assert_says, refused};

const ARENA: &str = "world.foraging.arena";

/// A wall across the smoke arena with a door of this width, between both batteries and the nest.
fn door(width: u32) -> String {
    let [left, right] = [1000 - width / 2, 1000 + width / 2];
    format!("walls_mm=[[0,1000,{left},1000],[{right},1000,2000,1000]]")
}

/// A square of walls.
fn walled_in([x, y]: [u32; 2], half: u32) -> String {
    let [west, east, south, north] = [x - half, x + half, y - half, y + half];
    format!(
        "walls_mm=[[{west},{south},{east},{south}],[{east},{south},{east},{north}],\
         [{east},{north},{west},{north}],[{west},{north},{west},{south}]]"
    )
}

/// Checks the smoke arena (2 by 2 m, batteries at [500, 500] and [1500, 500], the nest at
/// [1000, 1500]) with changes to it.
fn check(changes: &[&str]) -> std::process::Command {
    let mut command = program();
    command.args(["check", "smoke"]);
    for change in changes {
        command.args(["--set", &format!("{ARENA}.{change}")]);
    }
    command
}

/// Checks an arena that is valid, and returns its warnings.
fn warned(changes: &[&str]) -> String {
    let output = output(&mut check(changes));
    assert_eq!(stdout(&output), "smoke: valid\n", "{}", stderr(&output));
    assert!(output.status.success());
    stderr(&output)
}

fn assert_refused(changes: &[&str], place: &str, parts: &[&str]) {
    let said = refused(&mut check(changes));
    assert_says(&said, &[&format!("{place}: found ")]);
    assert_says(&said, parts);
}

fn assert_warned(changes: &[&str], place: &str, parts: &[&str]) {
    let said = warned(changes);
    assert_says(&said, &[&format!("warning: smoke: {place}: found ")]);
    assert_says(&said, parts);
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[test]
fn shipped_scenarios_have_no_warnings() {
    for scenario in EMBEDDED {
        let output = output(program().args(["check", scenario.name]));
        assert_eq!(stderr(&output), "", "{}", scenario.name);
    }
}

#[test]
fn a_nest_that_is_walled_in_is_refused() {
    let walls = walled_in([1000, 1500], 300);
    let parts = [
        "no way to the nest from any battery in reach, such as batteries_mm[0] at [500, 500]",
        "allowed: a way at least 150 mm wide",
    ];
    assert_refused(&[&walls], ARENA, &parts);
    // Here the robot does not fit between the walls.
    let walls = walled_in([1000, 1500], 60);
    let parts = [
        "[1000, 1500], out of the robot's reach",
        "allowed: a nest within 200 mm and in sight of a place where a robot of radius 75 mm fits",
    ];
    assert_refused(&[&walls], &format!("{ARENA}.nest_mm"), &parts);
}

#[test]
fn the_only_passage_must_be_as_wide_as_the_robot() {
    for narrow in [20, 120, 148] {
        assert_refused(&[&door(narrow)], ARENA, &["no way to the nest"]);
    }
    for wide in [150, 152, 300] {
        assert_eq!(warned(&[&door(wide)]), "", "{wide} mm");
    }
}

#[test]
fn a_wall_through_the_only_battery_or_the_nest_is_refused() {
    let wall = "walls_mm=[[400,500,600,500]]";
    let parts = [
        "no battery in reach: [500, 500], in a wall",
        "allowed: at least one within 160 mm",
    ];
    let place = format!("{ARENA}.batteries_mm");
    assert_refused(&["batteries_mm=[[500,500]]", wall], &place, &parts);
    let place = format!("{ARENA}.nest_mm");
    assert_refused(
        &["nest_mm=[500,500]", wall],
        &place,
        &["found [500, 500], in a wall"],
    );
    assert_refused(&["nest_mm=[0,500]"], &place, &["found [0, 500], in a wall"]);
}

#[test]
fn an_arena_without_a_free_place_is_refused() {
    let walls: Vec<_> = (1..20)
        .map(|i| format!("[{0},0,{0},2000]", 100 * i))
        .collect();
    let walls = format!("walls_mm=[{}]", walls.join(","));
    assert_refused(
        &[&walls],
        ARENA,
        &["no free place", "allowed: an arena with room to start in"],
    );
}

#[test]
fn a_battery_out_of_reach_is_a_warning_if_others_are_in_reach() {
    let place = format!("{ARENA}.batteries_mm[0]");
    assert_warned(
        &["walls_mm=[[400,500,600,500]]"],
        &place,
        &["found [500, 500], in a wall"],
    );
    let walls = walled_in([500, 500], 60);
    assert_warned(
        &[&walls],
        &place,
        &["found [500, 500], out of the robot's reach"],
    );
}

#[test]
fn targets_in_one_place_are_a_warning() {
    let place = format!("{ARENA}.batteries_mm[1]");
    let parts = ["found [500, 500], where batteries_mm[0] is; allowed: a place of its own"];
    assert_warned(&["batteries_mm=[[500,500],[500,500]]"], &place, &parts);
    let parts = ["found [1000, 1500], on the nest; allowed: at least 75 mm from the nest"];
    assert_warned(&["batteries_mm=[[500,500],[1000,1500]]"], &place, &parts);
}

#[test]
fn a_pocket_is_a_warning_with_its_share_and_a_place() {
    // In the corner 250 by 250 mm are free. Outside it is 1850 by 1850 less 400 by 400 mm.
    let walls = "walls_mm=[[1600,2000,1600,1600],[1600,1600,2000,1600]]";
    let parts = [
        "1.9 % of the free places without a way to battery and nest, such as [1",
        "cannot reach any battery; allowed: ways at least 150 mm wide",
    ];
    assert_warned(&[walls], ARENA, &parts);
}

#[test]
fn an_arena_in_which_the_robot_need_not_move_is_a_warning() {
    let tiny = [
        "size_mm=[300,300]",
        "batteries_mm=[[100,100]]",
        "nest_mm=[200,200]",
    ];
    let place = format!("{ARENA}.size_mm");
    let parts = ["found [300, 300], where the robot captures and delivers without moving at"];
    assert_warned(&tiny, &place, &parts);
}

#[test]
fn a_robot_too_small_for_the_check_is_a_warning() {
    let mut command = check(&[]);
    command.args(["--set", "world.foraging.robot.radius_mm=1"]);
    let said = stderr(&output(&mut command));
    assert_says(
        &said,
        &["world.foraging.robot.radius_mm: found 1, so small that ways"],
    );
}

#[test]
fn studies_and_evaluations_warn_once() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("plan.json");
    let twins = "world.foraging.arena.batteries_mm=[[500,500],[500,500]]";
    let text = serde_json::json!({
        "format": 1,
        "name": "twins",
        "description": "Two batteries in one place.",
        "scenarios": ["smoke"],
        "seeds": "1",
        "arms": [
            { "name": "one", "base": "evolved", "settings": [twins] },
            { "name": "two", "base": "random_selection", "settings": [twins] },
            { "name": "three", "base": "evolved", "settings": [] },
        ],
    });
    fs::write(&plan, text.to_string()).unwrap();
    let study = folder.path().join("study");
    let evaluate = [
        "evaluate",
        "smoke",
        "--tree",
        "(Root Wander ApproachBattery ApproachNest)",
    ];
    let short = [
        "--warmup",
        "0",
        "--trials",
        "1",
        "--repeats",
        "1",
        "--set",
        twins,
    ];
    let commands = [
        program().arg("check").arg(&plan),
        program()
            .args(["study", "commands"])
            .arg(&plan)
            .arg("--out")
            .arg(&study),
        program().args(evaluate).args(short),
    ]
    .map(output);
    for done in commands {
        let said = stderr(&done);
        assert!(done.status.success(), "{said}");
        assert_eq!(
            said.matches("smoke: world.foraging.arena").count(),
            1,
            "{said}"
        );
        assert!(said.starts_with("warning: "), "{said}");
    }
}

#[test]
fn warnings_are_part_of_the_json_and_of_a_run() {
    let twins = format!("{ARENA}.batteries_mm=[[500,500],[500,500]]");
    let printed = output(program().args(["check", "smoke", "--format", "json", "--set", &twins]));
    let reports: serde_json::Value = serde_json::from_slice(&printed.stdout).unwrap();
    let warning = reports[0]["warnings"][0].as_str().unwrap();
    assert!(warning.starts_with("world.foraging.arena.batteries_mm[1]: found [500, 500]"));
    assert_eq!(reports[0]["valid"], true);

    let folder = tempfile::tempdir().unwrap();
    let mut run = program();
    run.args([
        "run",
        "smoke",
        "--headless",
        "--generations",
        "1",
        "--set",
        &twins,
        "--out",
    ]);
    run.arg(folder.path().join("run"));
    for setting in SHORT
        .iter()
        .filter(|setting| !setting.contains("generation_limit"))
    {
        run.args(["--set", setting]);
    }
    let ran = output(&mut run);
    assert!(ran.status.success(), "{}", stderr(&ran));
    assert_eq!(
        stderr(&ran).matches("warning: smoke: ").count(),
        1,
        "{}",
        stderr(&ran)
    );
}
