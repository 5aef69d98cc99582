//! A broken plan is refused with its file, the place in it, the value found there and the values
//! allowed. The schema for editors accepts what the program accepts, and refuses what a schema can
//! recognise as wrong.
//!
//! Why it matters: a study runs for hours. Mistakes in its plan must be found before it starts, and
//! be corrected without reading the source.
//!
//! Each fixture in `tests/fixtures/plans` is `valid.json` with one change.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use common::{output, program, stderr, stdout};
use maxq_lab::report::{Plan, Study};
use maxq_lab::scenario::EMBEDDED_PLANS;
use serde_json::Value;

/// Fixture, place of the mistake, part of the message, and whether the schema refuses it too.
const BROKEN: &[(&str, &str, &str, bool)] = &[
    ("unknown-format", "at format", "found 2; allowed: 1", true),
    (
        "missing-field",
        "at the top level",
        "missing field `seeds`",
        true,
    ),
    (
        "unknown-field",
        "at repeats",
        "found the unknown field \"repeats\"; allowed: format",
        true,
    ),
    ("wrong-type", "at name", "found 7; allowed: text", true),
    (
        "bad-name",
        "at name",
        "found \"My study\"; allowed: 1 to 64 of a-z",
        true,
    ),
    (
        "bad-seeds",
        "at seeds",
        "found \"3..1\"; allowed: numbers and ranges",
        false,
    ),
    (
        "seeds-twice",
        "at seeds",
        "found \"2\" twice; allowed: each number once",
        false,
    ),
    (
        "no-scenarios",
        "at scenarios",
        "found none; allowed: at least one",
        true,
    ),
    ("no-arms", "arms", "found none; allowed: at least one", true),
    (
        "scenario-twice",
        "at scenarios",
        "found two with one name; allowed: different names",
        false,
    ),
    (
        "arm-twice",
        "at arms",
        "found two with one name; allowed: different names",
        false,
    ),
    (
        "bad-arm-name",
        "at arms",
        "found name \"a/b\"; allowed: 1 to 64 of a-z",
        true,
    ),
    (
        "unknown-arm",
        "at arms[0]",
        "found \"evoluted\"; allowed: evolved, random_selection",
        true,
    ),
    (
        "unknown-base",
        "at arms[1]: base",
        "found \"random\"; allowed: evolved",
        true,
    ),
    (
        "unknown-field-of-arm",
        "at arms[1]",
        "found the unknown field \"set\"; allowed: name",
        true,
    ),
    (
        "unknown-control",
        "at control",
        "found \"random_selection\"; allowed: evolved, short",
        false,
    ),
    (
        "bad-reevaluation",
        "at reevaluation.repeats",
        "found 1; allowed: 2 to 10000",
        true,
    ),
    (
        "unknown-scenario",
        "at scenarios[0]",
        "no scenario \"smoked\": there is no such file, and the built-in scenarios are",
        false,
    ),
    (
        "bad-scenario",
        "scenarios[0]",
        "evolution.population_size",
        true,
    ),
    (
        "unknown-setting",
        "arm short of scenario smoke",
        "evolution.generations",
        false,
    ),
    (
        "setting-out-of-range",
        "arm short of scenario smoke",
        "learning.discount: found 2",
        false,
    ),
];

fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/plans");
    folder.join(format!("{name}.json"))
}

fn schema() -> jsonschema::Validator {
    let printed = output(program().args(["schema", "--of", "plan"]));
    let schema: Value = serde_json::from_str(&stdout(&printed)).unwrap();
    jsonschema::validator_for(&schema).unwrap()
}

#[test]
fn errors_name_the_file_the_place_and_what_is_allowed() {
    let schema = schema();
    for (name, place, said, refused_by_schema) in BROKEN {
        let file = fixture(name);
        let checked = output(program().arg("check").arg(&file));
        let message = stderr(&checked);
        assert_eq!(checked.status.code(), Some(1), "{name}");
        for part in [file.to_str().unwrap(), place, said] {
            assert!(
                message.contains(part),
                "{name}: {part:?} is not in {message}"
            );
        }
        let json: Value = serde_json::from_slice(&fs::read(&file).unwrap()).unwrap();
        assert_eq!(
            !schema.is_valid(&json),
            *refused_by_schema,
            "{name} by the schema"
        );
    }
    for (name, place) in [
        ("truncated", "the text ends"),
        ("trailing", "trailing characters"),
    ] {
        let error = Plan::load(fixture(name).to_str().unwrap()).unwrap_err();
        assert!(error.to_string().contains(place), "{error}");
    }
    let known: BTreeSet<_> = BROKEN.iter().map(|(name, ..)| (*name).to_owned()).collect();
    for entry in fs::read_dir(fixture("valid").parent().unwrap()).unwrap() {
        let name = entry
            .unwrap()
            .path()
            .file_stem()
            .unwrap()
            .to_str()
            .unwrap()
            .to_owned();
        let elsewhere = ["valid", "truncated", "trailing"].contains(&name.as_str());
        assert!(elsewhere || known.contains(&name), "{name} is not tested");
    }
}

#[test]
fn missing_and_unreadable_plans_are_reported() {
    let parent = tempfile::tempdir().unwrap();
    let error = Plan::load("nosuch").unwrap_err().to_string();
    let names: Vec<_> = EMBEDDED_PLANS.iter().map(|plan| plan.name).collect();
    assert!(
        error.contains("\"nosuch\"") && error.ends_with(&names.join(", ")),
        "{error}"
    );
    let folder = parent.path().to_str().unwrap();
    let error = Plan::load(folder).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{folder}: ")), "{error}");
    let binary = parent.path().join("binary.json");
    fs::write(&binary, [0xff, 0xfe]).unwrap();
    let error = Plan::load(binary.to_str().unwrap())
        .unwrap_err()
        .to_string();
    assert!(error.contains("binary.json: "), "{error}");
}

#[test]
fn embedded_plans_and_the_plans_of_studies_satisfy_the_schema() {
    let schema = schema();
    let assert_valid = |json: &str, name: &str| {
        let json: Value = serde_json::from_str(json).unwrap();
        let errors: Vec<_> = schema.iter_errors(&json).map(|e| e.to_string()).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    };
    assert_valid(&fs::read_to_string(fixture("valid")).unwrap(), "valid.json");
    for embedded in EMBEDDED_PLANS {
        assert_valid(embedded.json, embedded.name);
        let plan = Plan::load(embedded.name).unwrap();
        assert_eq!(plan.name, embedded.name);
        let written = String::from_utf8(plan.to_file().unwrap()).unwrap();
        assert_valid(&written, &format!("{} written out", embedded.name));
    }
}

/// The folder of a study stands for its plan: the study is resumed by the name of its folder alone,
/// even if an embedded plan has that name.
#[test]
fn the_folder_of_a_study_is_a_plan() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("thesis");
    let plan = Plan::load(fixture("valid").to_str().unwrap()).unwrap();
    Study::create(plan.clone(), &folder).unwrap();
    assert_eq!(Plan::load(folder.to_str().unwrap()).unwrap(), plan);
    let study = |arguments: &[&str]| {
        let mut command = program();
        command
            .current_dir(parent.path())
            .arg("study")
            .args(arguments);
        output(command.args(["--only", "1"]))
    };
    for arguments in [&["thesis"][..], &["thesis", "--out", "thesis"]] {
        let done = study(arguments);
        assert_eq!(
            stdout(&done),
            "1 of 1 runs done in thesis\n",
            "{}",
            stderr(&done)
        );
    }
    assert!(
        folder
            .join("smoke/evolved/seed-1/evaluation.json")
            .is_file()
    );
    let refused = study(&["thesis", "--seeds", "1..2"]);
    assert!(
        stderr(&refused).contains("allowed: with scenarios"),
        "{}",
        stderr(&refused)
    );
    let refused = study(&["smoke"]);
    assert!(
        stderr(&refused).contains("--out: found none; allowed: "),
        "{}",
        stderr(&refused)
    );
}

#[test]
fn a_name_that_is_no_plan_study_or_scenario_is_answered_with_what_exists() {
    let parent = tempfile::tempdir().unwrap();
    fs::create_dir(parent.path().join("empty")).unwrap();
    let no_arms = r#"{"format":1,"name":"mine","scenarios":["smoke"],"seeds":"1"}"#;
    fs::write(parent.path().join("no-arms.json"), no_arms).unwrap();
    for (arguments, expected) in [
        (&["evolving-taksi"][..], "a built-in plan (evolving-taxi, "),
        (
            &["empty"],
            "empty: holds no study.json; allowed: the folder of",
        ),
        (&["smoke", "empty"], "empty: holds no study.json"),
        (
            &["no-arms.json"],
            "no-arms.json: line 1, column 60, at the top level: missing field `arms`",
        ),
        (
            &["smoke", "--only", "21"],
            "--only: found \"21\"; allowed: 1 to 20, or SCENARIO/ARM/seed-N as 'study commands'",
        ),
    ] {
        let mut command = program();
        let command = command.current_dir(parent.path()).arg("study");
        let refused = output(command.args(arguments).args(["--out", "out"]));
        assert_eq!(refused.status.code(), Some(1));
        let said = stderr(&refused);
        assert!(said.contains(expected), "{said}");
        assert!(
            !parent.path().join("out").exists(),
            "created for {arguments:?}"
        );
    }
}

#[test]
fn settings_are_checked_with_scenarios() {
    let check = |arguments: &[&str]| output(program().arg("check").args(arguments));
    let changed = check(&[
        "smoke",
        "--set",
        "learning.discount=0.5",
        "--format",
        "json",
    ]);
    let reports: Value = serde_json::from_str(&stdout(&changed)).unwrap();
    assert_eq!(reports[0]["scenario"]["learning"]["discount"], 0.5);
    let refused = check(&["smoke", "--set", "learning.discount=2"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(
        stderr(&refused).contains("learning.discount: found 2"),
        "{}",
        stderr(&refused)
    );
    let refused = check(&["thesis", "--set", "learning.discount=0.5"]);
    assert!(
        stderr(&refused).contains("with the plan thesis; allowed"),
        "{}",
        stderr(&refused)
    );
}
