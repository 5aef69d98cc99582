//! Scenario files that are broken as files, as JSON or as scenarios.

use std::fs;

use super::common::program;
use super::{assert_says, check, fixture, refused};

/// A fixture, the place of its fault, and the error.
const BROKEN: &[(&str, &str, &str)] = &[
    (
        "truncated.json",
        "line 7, column 22, at evolution",
        "the text ends",
    ),
    (
        "wrong-type.json",
        "at evolution.population_size",
        "found \"six\"; allowed: a whole number from 0 to ",
    ),
    (
        "nan.json",
        "line 4, column 81, at world.foraging.arena.nest_mm[0]",
        "found no JSON value",
    ),
    (
        "infinity.json",
        "at world.foraging.arena.nest_mm[0]",
        "invalid number",
    ),
    (
        "huge-number.json",
        "at world.foraging.arena.nest_mm[0]",
        "found a number that is too large",
    ),
    (
        "huge-integer.json",
        "at evolution.population_size",
        "found 1.8446744073709552e+19; allowed: a whole number from 0 to ",
    ),
    (
        "negative-count.json",
        "at evolution.population_size",
        "found -6; allowed: a whole number from 0 to ",
    ),
    (
        "short-list.json",
        "at world.foraging.arena.nest_mm",
        "allowed: a list of 2",
    ),
    (
        "unknown-field.json",
        "at evolution.populationSize",
        "found the unknown field \"populationSize\"; allowed: population_size",
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
        "found \"maze\"; allowed: ",
    ),
    (
        "not-utf8.json",
        "byte 31",
        "not UTF-8; allowed: text in UTF-8",
    ),
    ("empty.json", "line 1, column 0", "the text ends"),
    ("list.json", "line 1", "allowed: "),
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
        &["large.json: found more than 1048576 bytes; allowed: at most"],
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

#[test]
fn a_byte_order_mark_is_left_out_and_utf_16_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.json");
    let text = maxq_lab::scenario::EMBEDDED[0].json;
    fs::write(&path, format!("\u{feff}{text}")).unwrap();
    assert!(check(&path).output().unwrap().status.success());

    let utf_16: Vec<u8> = [0xfeff]
        .into_iter()
        .chain(text.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    fs::write(&path, utf_16).unwrap();
    let said = refused(&mut check(&path));
    assert_says(&said, &["mine.json", "found text in UTF-16", "iconv"]);
}

/// The kinds: nothing but brackets, many objects, many texts, many numbers; each as a scenario and
/// as a plan.
#[test]
fn no_text_takes_much_more_memory_than_its_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.json");
    let texts = [
        "[".repeat(15 << 20),
        format!("{{\"arms\": [{}", "{\"a\": [[]]},".repeat(1 << 20)),
        format!(
            "{{\"arms\": [], \"scenarios\": [{}",
            "\"\",".repeat(4 << 20)
        ),
        format!("{{\"arms\": [{}", "1,".repeat(7 << 20)),
        format!("{{\"arms\": [], \"name\": \"{}\"}}", "x".repeat(15 << 20)),
    ];
    for text in texts {
        fs::write(&path, &text).unwrap();
        for command in ["check", "study", "study commands", "run"] {
            // 150 MB of address space are enough for the program itself and 15 MB of text.
            let line = format!("ulimit -v 150000; exec \"$0\" {command} \"$1\"");
            let program = program();
            let mut shell = std::process::Command::new("sh");
            shell
                .args(["-c", &line])
                .arg(program.get_program())
                .arg(&path);
            let said = refused(&mut shell);
            assert!(said.len() < 1000, "{command}: {said}");
        }
    }
}

#[test]
fn standard_input_is_checked_as_a_file_is() {
    let check = |text: &str| {
        let mut command = assert_cmd::Command::from_std(program());
        command.args(["check", "-"]).write_stdin(text.to_owned());
        command.output().unwrap()
    };
    let smoke = maxq_lab::scenario::EMBEDDED[0].json;
    let plan = maxq_lab::scenario::EMBEDDED_PLANS[0].json;
    for valid in [smoke, plan] {
        let said = String::from_utf8(check(valid).stdout).unwrap();
        assert_eq!(said, "standard input: valid\n");
    }
    let wrong = check(&smoke.replace("\"format\": 1", "\"format\": 7"));
    let said = String::from_utf8(wrong.stderr).unwrap();
    assert!(
        said.contains("standard input: format: found 7; allowed: 1"),
        "{said}"
    );
}
