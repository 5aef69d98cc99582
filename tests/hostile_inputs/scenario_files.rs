//! Scenario files that are broken as files, as JSON or as scenarios.

use std::fs;

use super::common::program;
use super::{assert_says, check, fixture, refused};

/// A fixture, the place of its fault, and the error.
const BROKEN: &[(&str, &str, &str)] = &[
    ("truncated.json", "line 7, column 22, at evolution", "EOF"),
    (
        "wrong-type.json",
        "at evolution.population_size",
        "string \"six\", expected usize",
    ),
    (
        "nan.json",
        "line 4, column 81, at world.foraging.arena.nest_mm[0]",
        "expected value",
    ),
    (
        "infinity.json",
        "at world.foraging.arena.nest_mm[0]",
        "invalid number",
    ),
    (
        "huge-number.json",
        "at world.foraging.arena.nest_mm[0]",
        "number out of range",
    ),
    (
        "huge-integer.json",
        "at evolution.population_size",
        "1.8446744073709552e+19`, expected usize",
    ),
    (
        "negative-count.json",
        "at evolution.population_size",
        "integer `-6`, expected usize",
    ),
    (
        "short-list.json",
        "at world.foraging.arena.nest_mm",
        "expected an array of length 2",
    ),
    (
        "unknown-field.json",
        "at evolution.populationSize",
        "expected one of `population_size`",
    ),
    ("unknown-format.json", "format", "found 2; allowed: 1"),
    (
        "missing-field.json",
        "at the top level",
        "missing field `name`",
    ),
    (
        "duplicate-field.json",
        "line 4, column 8",
        "duplicate field `name`",
    ),
    ("trailing.json", "line 17, column 1", "trailing characters"),
    (
        "unknown-world.json",
        "at world",
        "unknown variant `maze`, expected one of `",
    ),
    ("not-utf8.json", "byte 31", "is not UTF-8"),
    ("empty.json", "line 1, column 0", "EOF"),
    ("list.json", "line 1", "expected a string"),
    (
        "raw-control-character.json",
        "line 1, column 7",
        "control character",
    ),
    (
        "no-room.json",
        "world.foraging.arena",
        "allowed: an arena with room to start in",
    ),
    (
        "tree-unbalanced.json",
        "evolution.initial_population[0]: at byte 41",
        "allowed: ')'",
    ),
    (
        "tree-unknown-subtask.json",
        "evolution.initial_population[0]: at byte 6",
        "\"Wonder\"; allowed: a subtask (Root",
    ),
    (
        "tree-typing.json",
        "evolution.initial_population[0]",
        "ApproachBattery (active in state types 2) under FindNest (active in 3); allowed: ",
    ),
    (
        "tree-repeated.json",
        "evolution.initial_population[0]",
        "FindNest occurs more than once; allowed: ",
    ),
    (
        "tree-cannot-act.json",
        "evolution.initial_population[0]",
        "state types 1,3; allowed: ",
    ),
];

#[test]
fn the_error_of_every_broken_scenario_names_its_place() {
    for (name, place, what) in BROKEN {
        let said = refused(&mut check(&fixture(name)));
        assert_says(&said, &[name, place, what]);
    }
}

#[test]
fn every_command_that_takes_a_scenario_rejects_a_broken_one() {
    let broken = fixture("unknown-field.json");
    let folder = tempfile::tempdir().unwrap();
    let tree = "(Root Wander ApproachBattery ApproachNest)";
    for arguments in [
        &["run"][..],
        &["evaluate", "--tree", tree],
        &["primitives"],
        &["tree", "show", tree, "--scenario"],
        &["tree", "check", tree, "--scenario"],
        &["tree", "diff", tree, tree, "--scenario"],
        &["tree", "dot", tree, "--scenario"],
    ] {
        let said = refused(program().current_dir(&folder).args(arguments).arg(&broken));
        assert_says(&said, &["unknown-field.json", "evolution.populationSize"]);
    }
    assert_eq!(
        fs::read_dir(&folder).unwrap().count(),
        0,
        "something was created"
    );
}

#[test]
fn the_original_of_all_fixtures_is_valid() {
    let output = super::output(&mut check(&fixture("valid.json")));
    assert!(output.status.success());
}

#[test]
fn deep_nesting_is_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep.json");
    for deep in [
        "[".repeat(500_000),
        "{\"world\":".repeat(100_000),
        format!(
            "{{\"description\": {}{}}}",
            "[".repeat(400_000),
            "]".repeat(400_000)
        ),
    ] {
        fs::write(&path, deep).unwrap();
        assert_says(&refused(&mut check(&path)), &["deep.json: line 1, column "]);
    }
}

#[test]
fn a_file_larger_than_any_scenario_is_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.json");
    let valid = fs::read_to_string(fixture("valid.json")).unwrap();
    fs::write(&path, valid.clone() + &" ".repeat((1 << 20) - valid.len())).unwrap();
    assert!(super::output(&mut check(&path)).status.success());
    fs::write(
        &path,
        valid.clone() + &" ".repeat((1 << 20) + 1 - valid.len()),
    )
    .unwrap();
    let said = refused(&mut check(&path));
    assert_says(
        &said,
        &["large.json: is larger than allowed", "1048576 bytes"],
    );
}

#[test]
fn a_path_without_a_file_is_rejected() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_owned();
    let shown = path.display().to_string();
    assert_says(
        &refused(&mut check(&path)),
        &[&shown, "cannot be read", "directory"],
    );
    let missing = path.join("missing.json");
    let said = refused(&mut check(&missing));
    assert_says(
        &said,
        &["missing.json", "no such file", "environment-1", "smoke"],
    );
}

#[test]
fn trees_that_are_too_deep_or_too_long_are_rejected() {
    let evaluate = |tree: &str| refused(program().args(["evaluate", "smoke", "--tree", tree]));
    let deep =
        "(Root (Capture (FindBattery (FindBattery Wander))) Wander ApproachBattery ApproachNest)";
    assert_says(&evaluate(deep), &["--tree: ", "allowed: "]);
    let nested = "(Root ".repeat(600);
    assert_says(
        &evaluate(&nested),
        &["--tree: at byte 3600", "the end of the text"],
    );
    let closed = format!("{}Wander{}", "(Root ".repeat(500), ")".repeat(500));
    assert_says(&evaluate(&closed), &["--tree: Root stands below itself"]);
    let long = format!("(Root{})", " Wander".repeat(1000));
    assert_says(
        &evaluate(&long),
        &["--tree: the hierarchy has 7006 bytes; allowed: at most 4096"],
    );
}
