//! The commands work for the textbook worlds, and an interrupted run of taxi ends with the same
//! bytes as an uninterrupted one.
//!
//! Why it matters: in taxi, subtasks have different inputs and every individual learns its own
//! primitive subtasks, so tests of foraging do not cover it.

#![allow(clippy::unwrap_used)]

use std::process::{Command, Output};

fn maxq_lab(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_maxq-lab"));
    command.args(arguments).output().unwrap()
}

fn succeeds(arguments: &[&str]) -> String {
    let output = maxq_lab(arguments);
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

fn fails(arguments: &[&str]) -> String {
    let output = maxq_lab(arguments);
    assert!(!output.status.success(), "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn learn_prints_the_values_of_the_figure() {
    let text = succeeds(&["learn", "cliff", "--algorithm", "q-learning"]);
    assert!(text.contains("  -14.00  -13.00  -12.00"), "{text}");
    let taxi = [
        "learn",
        "taxi",
        "--algorithm",
        "maxq-q",
        "--show",
        "from R to B",
    ];
    // Second row, first column: the state of Figure 2.6 is worth 10.
    let text = succeeds(&taxi);
    assert!(text.contains("\n   10.00    9.00"), "{text}");
    let json = succeeds(&["learn", "cliff", "--algorithm", "td0", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["values"][0]["exact"][3][0], -13.0);
}

#[test]
fn options_without_an_effect_are_rejected() {
    let given = succeeds(&["learn", "cliff", "--algorithm", "td0", "--steps", "2000"]);
    assert!(
        given.contains("1 repeat of 2000 primitive steps"),
        "{given}"
    );
    assert!(
        !given.contains("until first optimal"),
        "td0 learns no policy: {given}"
    );
    let learned = succeeds(&["learn", "cliff", "--algorithm", "q-learning"]);
    assert!(learned.contains("until first optimal"), "{learned}");
    let tree = ["--tree", "(Root Up)"];
    let policy = ["--policy", "random"];
    for (algorithm, option, allowed) in [
        ("td0", tree, "allowed: with maxq-q"),
        ("q-learning", tree, "allowed: with maxq-q"),
        ("q-learning", policy, "allowed: with td0"),
        ("maxq-q", policy, "allowed: with td0"),
    ] {
        let arguments = [&["learn", "cliff", "--algorithm", algorithm][..], &option].concat();
        let said = fails(&arguments);
        assert!(said.contains(option[0]) && said.contains(allowed), "{said}");
        assert!(said.contains(&format!("found with {algorithm}")), "{said}");
    }
}

#[test]
fn a_feature_that_a_world_lacks_is_an_error() {
    for algorithm in ["q-learning", "maxq-q"] {
        let foraging = fails(&["learn", "smoke", "--algorithm", algorithm]);
        assert!(foraging.contains("states cannot be counted"), "{foraging}");
    }
    let rbf = fails(&["learn", "taxi", "--algorithm", "q-learning-rbf"]);
    assert!(rbf.contains("without RBF features"), "{rbf}");
    let primitives = fails(&["primitives", "taxi"]);
    assert!(primitives.contains("not trained"), "{primitives}");
    let show = fails(&[
        "learn",
        "taxi",
        "--algorithm",
        "td0",
        "--show",
        "from R to X",
    ]);
    assert!(show.contains("from R to B"), "{show}");
}

/// Primitive subtasks that each individual learns survive the checkpoint.
#[test]
fn taxi_evolves_and_resumes_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (whole, parts) = (path("whole"), path("parts"));
    let short = [
        "--seed",
        "3",
        "--headless",
        "--set",
        "evolution.trials_per_generation=8",
        "--set",
        "evolution.policy_samples=10",
        "--generations",
    ];
    let run = |out: &str, generations: &str| {
        succeeds(
            &[
                &["run", "taxi", "--out", out][..],
                &short[..],
                &[generations][..],
            ]
            .concat(),
        );
    };
    run(&whole, "4");
    run(&parts, "2");
    succeeds(&["resume", &parts, "--headless", "--generations", "4"]);
    let bytes = |run: &str, file: &str| std::fs::read(format!("{run}/{file}")).unwrap();
    for file in ["checkpoint.json", "events.jsonl"] {
        assert!(bytes(&whole, file) == bytes(&parts, file), "{file} differs");
    }
    let text = String::from_utf8(bytes(&whole, "checkpoint.json")).unwrap();
    assert!(text.contains("\"subtask\":\"Putdown\""));
}
