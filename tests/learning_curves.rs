//! Contract: what is learned over many trials can be seen: as a curve, after evolution, and in
//! other scenarios, without longer records.
//!
//! Why it matters: a mean over a few trials hides whether a hierarchy still learns, and whether
//! it forgets.

#![allow(clippy::unwrap_used)]

mod common;

use std::fs;

use common::{output, program, run_in, short, stderr, stdout, threads};
use maxq_lab::evolution::MOST_LISTED;
use maxq_lab::lab::{Event, LaterLearning, Outcome, Recording, resume};
use serde_json::Value;
use tempfile::TempDir;

const TREE: &str = "(Root Avoid Wander ApproachBattery ApproachNest)";

#[test]
fn a_curve_has_a_line_for_each_tree_and_setting() {
    let mut command = program();
    command.args(["evaluate", "smoke", "--tree", TREE, "--warmup", "8"]);
    command.args(["--trials", "2", "--repeats", "2", "--primitive-sets", "1"]);
    command.args(["--against", "learning.discount=0.8"]);
    let csv = stdout(&output(command.arg("--curve=csv")));
    let rows: Vec<_> = csv.lines().skip(2).collect();
    assert_eq!(rows.len(), 20, "{csv}");
    assert!(rows[0].starts_with("as it is,") && rows[19].starts_with("learning.discount=0.8,"));

    // The curve and the scored trials are of the same hierarchies.
    let json = stdout(&output(command.arg("--format").arg("json")));
    let reports: Value = serde_json::from_str(&json).unwrap();
    for report in reports.as_array().unwrap() {
        let last = &report["curve"].as_array().unwrap()[8..];
        let of = |point: &Value| point["mean"].as_f64().unwrap();
        let mean = (of(&last[0]) + of(&last[1])) / 2.0;
        assert!((mean - report["mean"].as_f64().unwrap()).abs() < 1e-9);
    }
    assert_ne!(reports[0]["curve"], reports[1]["curve"]);
    assert_eq!(reports[1]["against"], "learning.discount=0.8");
}

#[test]
fn a_wrong_setting_to_compare_with_is_named() {
    let mut command = program();
    command.args(["evaluate", "smoke", "--tree", TREE, "--repeats", "1"]);
    let refused = output(command.args(["--against", "learning.discount=2"]));
    assert_eq!(refused.status.code(), Some(1));
    let message = stderr(&refused);
    assert!(
        message.contains("--against") && message.contains("0 to 1"),
        "{message}"
    );
}

#[test]
fn the_best_goes_on_learning_after_evolution() {
    let place = TempDir::new().unwrap();
    let folder = place.path().join("run");
    let scenario = short(&[r#"evolution.then={"learn":30}"#]);
    let outcome = run_in(&folder, &scenario, 1, &threads(1));
    let learned = LaterLearning::read(&folder).unwrap().unwrap();
    assert_eq!(learned.trials.len(), 30);
    assert_eq!(learned.individual, outcome.best.as_ref().unwrap().id);
    assert_eq!(learned.generation, outcome.generations);
    let later = outcome.later.unwrap();
    assert_eq!((later.trials, later.part), (30, 3));
    let first: u32 = learned.trials[..3].iter().map(|trial| trial.steps).sum();
    assert!((later.first - f64::from(first) / 3.0).abs() < 1e-9);

    // A process that died before the end computes the same again.
    let bytes = fs::read(folder.join("learning.json")).unwrap();
    fs::remove_file(folder.join("learning.json")).unwrap();
    fs::remove_file(folder.join("summary.json")).unwrap();
    resume(&folder, None, &threads(2)).unwrap().join().unwrap();
    assert_eq!(fs::read(folder.join("learning.json")).unwrap(), bytes);
    let read = Outcome::read(&folder).unwrap().unwrap();
    assert_eq!(read.later, Some(later));

    // Without it evolution is the same.
    let other = place.path().join("other");
    run_in(&other, &short(&[]), 1, &threads(1));
    let events = |folder: &std::path::Path| fs::read(folder.join("events.jsonl")).unwrap();
    assert_eq!(events(&folder), events(&other));
    assert!(LaterLearning::read(&other).unwrap().is_none());
}

#[test]
fn what_happens_afterwards_is_checked() {
    for (text, allowed) in [
        ("forget=3", "allowed: learn="),
        ("learn=0", "1 to 1000000"),
        ("learn=-1", "allowed: learn="),
    ] {
        let mut command = program();
        let refused = output(command.args(["run", "smoke", "--headless", "--then", text]));
        assert!(!refused.status.success());
        assert!(stderr(&refused).contains(allowed), "{}", stderr(&refused));
    }
}

#[test]
fn records_of_long_lives_stay_short() {
    let place = TempDir::new().unwrap();
    let folder = place.path().join("run");
    let scenario = maxq_lab::scenario::Scenario::load("cliff").unwrap();
    let settings = [
        "evolution.trials_per_generation=1100",
        "evolution.trial_step_limit=60",
        "evolution.generation_limit=2",
    ];
    let scenario = scenario.with_settings(&settings.map(String::from)).unwrap();
    run_in(&folder, &scenario, 1, &threads(2));
    let recording = Recording::read(&folder).unwrap();
    for event in &recording.events {
        let Event::Generation(record) = event else {
            continue;
        };
        for individual in &record.individuals {
            assert_eq!(individual.trials.len(), MOST_LISTED);
            let unlisted = individual.unlisted.unwrap();
            assert_eq!(
                (individual.scored(), unlisted.trials),
                (550, 550 - MOST_LISTED)
            );
            let listed = individual.trials.iter().map(|trial| u64::from(trial.steps));
            assert_eq!(
                listed.sum::<u64>() + unlisted.steps,
                individual.fitness_steps
            );
        }
    }
}

#[test]
fn winners_are_evaluated_in_every_scenario() {
    let place = TempDir::new().unwrap();
    let folder = place.path().join("study");
    let other = place.path().join("other.json");
    let smoke = stdout(&output(program().args(["scenarios", "smoke"])));
    fs::write(&other, smoke.replace("\"smoke\"", "\"other\"")).unwrap();
    let mut study = program();
    study.args(["study", "smoke"]).arg(&other);
    study.args([
        "--seeds",
        "1..2",
        "--arms",
        "evolved",
        "--headless",
        "--out",
    ]);
    assert!(output(study.arg(&folder)).status.success());
    let mut transfer = program();
    transfer.args(["study", "transfer"]).arg(&folder);
    transfer.args(["--warmup", "2", "--trials", "2", "--format", "json"]);
    let transfers: Value = serde_json::from_str(&stdout(&output(&mut transfer))).unwrap();
    let transfers = transfers.as_array().unwrap();
    assert_eq!(transfers.len(), 4);
    assert!(
        transfers
            .iter()
            .all(|one| one["steps"].as_array().unwrap().len() == 2)
    );
    // The scenarios differ in their names only, and each winner has its own seed.
    assert_eq!(transfers[0]["steps"], transfers[1]["steps"]);
    let mut unknown = program();
    unknown.args(["study", "transfer"]).arg(&folder);
    let refused = output(unknown.args(["--arm", "timed"]));
    assert!(
        stderr(&refused).contains("allowed: evolved"),
        "{}",
        stderr(&refused)
    );
}
