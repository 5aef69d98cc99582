//! What several test files share: small scenarios, runs, and comparisons of bytes.

// Every test file compiles this module and uses a part of it.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use maxq_lab::lab::{Event, Outcome, Run, RunOptions, start};
use maxq_lab::scenario::Scenario;

/// Options beyond the thesis that work in every world.
pub const OPTIONS: &[&str] = &[
    r#"learning.composite_reward={"per_step":-0.1}"#,
    "learning.exit_value=continuation",
    "learning.bootstrap=expected",
    "learning.persistence=3",
    "learning.replay=1",
    "learning.composite_temperature=0.3",
    "learning.cool_on=trial",
    "evolution.reset=child",
];

/// Settings for a short training of the primitive subtasks of foraging.
pub const SHORT_TRAINING: [&str; 5] = [
    "world.foraging.primitive_training.avoid.steps=2000",
    "world.foraging.primitive_training.wander.steps=2000",
    "world.foraging.primitive_training.approach_battery.steps=2000",
    "world.foraging.primitive_training.approach_nest.steps=2000",
    "world.foraging.primitive_training.turn.steps=2000",
];

/// Settings that make `smoke` run in a few hundredths of a second.
pub const SHORT: &[&str] = &[
    SHORT_TRAINING[0],
    SHORT_TRAINING[1],
    SHORT_TRAINING[2],
    SHORT_TRAINING[3],
    SHORT_TRAINING[4],
    "evolution.trials_per_generation=4",
    "evolution.trial_step_limit=300",
    "evolution.generation_limit=6",
    "evolution.policy_samples=20",
];

/// `smoke` with settings.
pub fn smoke(settings: &[&str]) -> Scenario {
    let settings: Vec<_> = settings.iter().map(|&setting| setting.into()).collect();
    let smoke = Scenario::load("smoke").unwrap();
    smoke.with_settings(&settings).unwrap()
}

/// `smoke` made short, with more settings.
pub fn short(settings: &[&str]) -> Scenario {
    smoke(&[SHORT, settings].concat())
}

/// Options for a number of threads.
pub fn threads(threads: usize) -> RunOptions {
    RunOptions {
        threads,
        ..RunOptions::default()
    }
}

/// Runs a scenario to its end in a folder.
pub fn run_in(folder: &Path, scenario: &Scenario, seed: u64, options: &RunOptions) -> Outcome {
    let run = start(scenario.clone(), seed, folder, options).unwrap();
    run.join().unwrap()
}

/// Waits until a generation has lived and stops the run; its checkpoint is on disk.
pub fn stop_after(run: Run, generation: u64) -> Outcome {
    let reached = |event: Event| match event {
        Event::Generation(record) => record.generation >= generation,
        _ => false,
    };
    assert!(run.events.iter().any(reached), "the run ended before that");
    run.controls.stop();
    run.join().unwrap()
}

/// What scenario and seed determine, byte for byte.
#[derive(Clone, PartialEq, Eq)]
pub struct Record {
    pub events: Vec<u8>,
    pub checkpoint: Vec<u8>,
}

impl Record {
    /// Of the run in a folder.
    pub fn of(folder: &Path) -> Self {
        let read = |name: &str| {
            let path = folder.join(name);
            fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        };
        Self {
            events: read("events.jsonl"),
            checkpoint: read("checkpoint.json"),
        }
    }

    /// Fails at the first byte that is not the same.
    pub fn assert_same(&self, other: &Self, when: &str) {
        assert_same_bytes(
            &self.events,
            &other.events,
            &format!("events.jsonl, {when}"),
        );
        let when = format!("checkpoint.json, {when}");
        assert_same_bytes(&self.checkpoint, &other.checkpoint, &when);
    }
}

/// The record of a scenario run to its end in a folder of its own.
pub fn record(scenario: &Scenario, seed: u64, options: &RunOptions) -> Record {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, scenario, seed, options);
    Record::of(&folder)
}

/// The files below a folder whose names are wanted, by their places.
pub fn files_below(folder: &Path, is_wanted: fn(&str) -> bool) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_dir() {
                folders.push(path);
            } else if is_wanted(name) {
                let place = path.strip_prefix(folder).unwrap().to_str().unwrap();
                files.insert(place.to_owned(), fs::read(&path).unwrap());
            }
        }
    }
    files
}

/// Fails where the wanted files below two folders are not the same.
pub fn assert_same_files(one: &Path, other: &Path, is_wanted: fn(&str) -> bool) {
    let (one, other) = (files_below(one, is_wanted), files_below(other, is_wanted));
    let places = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(places(&one), places(&other));
    for (place, bytes) in &one {
        assert_same_bytes(bytes, &other[place], place);
    }
}

/// Fails at the first byte that is not the same and shows what is there.
pub fn assert_same_bytes(one: &[u8], other: &[u8], what: &str) {
    if one == other {
        return;
    }
    let common = one.iter().zip(other).take_while(|(a, b)| a == b).count();
    let around = |bytes: &[u8]| {
        let from = common.saturating_sub(60).min(bytes.len());
        let to = (common + 60).min(bytes.len());
        String::from_utf8_lossy(&bytes[from..to]).into_owned()
    };
    panic!(
        "{what}: {} and {} bytes, different from byte {common} on:\n  {}\n  {}",
        one.len(),
        other.len(),
        around(one),
        around(other)
    );
}

/// The program itself.
pub fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_maxq-lab"));
    command.stdin(Stdio::null());
    command
}

/// `program` with `--set` for each setting.
pub fn set(command: &mut Command, settings: &[&str]) {
    for setting in settings {
        command.args(["--set", setting]);
    }
}

/// Runs a command to its end.
pub fn output(command: &mut Command) -> Output {
    command.output().unwrap()
}

/// Standard output as text.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// Standard error as text.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Polls until something is the case; the bound is generous, for a loaded machine.
pub fn wait_until(what: &str, mut holds: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !holds() {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "waiting for {what}"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Complete lines of a file; none where there is no file yet.
pub fn lines(path: &Path) -> usize {
    let bytes = fs::read(path).unwrap_or_default();
    bytes.iter().filter(|&&byte| byte == b'\n').count()
}
