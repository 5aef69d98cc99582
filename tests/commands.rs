//! The commands: results on standard output, as JSON with the promised fields on request;
//! messages on standard error; pause and stop that take effect at once.
//!
//! Why it matters: scripts read these fields, pipes close early, and a user who stops a run
//! does not want to wait for the end of a generation.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use common::{SHORT, output, program, set, stderr, stdout, threads, wait_until};
use maxq_lab::lab::start;
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::{EMBEDDED, EMBEDDED_PLANS, Scenario};
use rand::RngExt;
use serde_json::Value;
use tempfile::TempDir;

const TREE: &str = "(Root Wander ApproachBattery ApproachNest)";
const OTHER: &str = "(Root Avoid ApproachBattery ApproachNest)";

const COMMANDS: &[&[&str]] = &[
    &["run"],
    &["resume"],
    &["watch"],
    &["replay"],
    &["frame"],
    &["evaluate"],
    &["learn"],
    &["study"],
    &["study", "add"],
    &["study", "status"],
    &["study", "watch"],
    &["study", "report"],
    &["study", "commands"],
    &["study", "slurm"],
    &["study", "merge"],
    &["study", "transfer"],
    &["export"],
    &["tree"],
    &["tree", "show"],
    &["tree", "check"],
    &["tree", "diff"],
    &["tree", "dot"],
    &["primitives"],
    &["check"],
    &["schema"],
    &["scenarios"],
    &["completions"],
    &["manual"],
];

/// Runs a command that must succeed with an empty standard error.
fn succeeds(command: &mut Command) -> String {
    let output = output(command);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{command:?}: {}",
        stderr(&output)
    );
    assert_eq!(stderr(&output), "", "{command:?}");
    stdout(&output)
}

fn json(command: &mut Command) -> Value {
    serde_json::from_str(&succeeds(command.args(["--format", "json"]))).unwrap()
}

/// The names of an object's fields.
fn fields(object: &Value) -> BTreeSet<&str> {
    object
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect()
}

#[track_caller]
fn assert_fields(object: &Value, promised: &[&str]) {
    assert_eq!(fields(object), promised.iter().copied().collect());
}

#[test]
fn run_and_resume_report_the_result() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let mut command = program();
    command
        .args(["run", "smoke", "--seed", "4", "--out"])
        .arg(&folder);
    set(&mut command, SHORT);
    let result = json(&mut command);
    let promised = [
        "scenario",
        "seed",
        "generations",
        "converged",
        "stopped",
        "best",
        "control_steps",
        "wall_seconds",
        "run_dir",
    ];
    assert_fields(&result, &promised);
    let best = [
        "id",
        "tree",
        "fitness",
        "composites",
        "primitives",
        "primitives_by_state_type",
    ];
    assert_fields(&result["best"], &best);
    assert_eq!(result["scenario"], "smoke");
    assert_eq!(result["seed"], 4);
    assert_eq!(result["stopped"], false);
    assert_eq!(result["run_dir"], folder.display().to_string());
    assert!(result["best"]["fitness"].as_f64().unwrap() > 0.0);
    assert_eq!(
        result["best"]["primitives_by_state_type"]
            .as_array()
            .unwrap()
            .len(),
        4
    );

    let mut resumed = json(program().arg("resume").arg(&folder));
    resumed["wall_seconds"] = result["wall_seconds"].clone();
    assert_eq!(resumed, result);
    let text = succeeds(program().arg("resume").arg(&folder));
    assert!(
        text.starts_with("smoke, seed 4: ") && text.contains("Root\n"),
        "{text}"
    );
}

#[test]
fn evaluate_reports_every_repeat() {
    let mut command = program();
    let counts = [
        "--repeats",
        "3",
        "--trials",
        "5",
        "--warmup",
        "1",
        "--primitive-sets",
        "2",
    ];
    command
        .args(["evaluate", "smoke", "--tree", TREE, "--threads", "1"])
        .args(counts);
    set(&mut command, SHORT);
    let result = json(&mut command);
    let promised = [
        "scenario",
        "changed",
        "seed",
        "warmup",
        "trials",
        "banks",
        "tree",
        "repeats",
        "mean",
        "standard_error",
        "delivered_share",
        "control_steps",
        "control_steps_per_second",
        "returns",
        "mean_return",
        "return_standard_error",
    ];
    assert_fields(&result, &promised);
    assert_eq!(result["tree"], TREE);
    let repeats = result["repeats"].as_array().unwrap();
    assert_eq!(repeats.len(), 3);
    let mut steps = Vec::new();
    for repeat in repeats {
        assert_fields(repeat, &["steps", "delivered", "bank"]);
        steps.extend(
            repeat["steps"]
                .as_array()
                .unwrap()
                .iter()
                .map(|s| s.as_f64().unwrap()),
        );
    }
    assert_eq!(steps.len(), 15);
    let mean = steps.iter().sum::<f64>() / 15.0;
    assert!((result["mean"].as_f64().unwrap() - mean).abs() < 1e-9);
    assert!(result["standard_error"].as_f64().unwrap() >= 0.0);

    // The number of threads changes nothing but the computing time.
    let mut again = program();
    again
        .args(["evaluate", "smoke", "--tree", TREE, "--threads", "4"])
        .args(counts);
    set(&mut again, SHORT);
    let mut again = json(&mut again);
    again["control_steps_per_second"] = result["control_steps_per_second"].clone();
    assert_eq!(again, result);

    // The text names everything that is needed to repeat the evaluation.
    let mut text = program();
    text.args(["evaluate", "smoke", "--tree", TREE, "--repeats", "1"]);
    set(&mut text, &["learning.discount=0.5"]);
    let text = succeeds(&mut text);
    assert!(
        text.contains(
            "smoke with learning.discount=0.5, seed 1: 1 repeat of 8 scored trials after 8 warm-up \
             trials, 1 primitive set (no standard error from a single repeat)"
        ),
        "{text}"
    );
    assert!(!text.contains("+-"), "{text}");
}

#[test]
fn the_commands_about_trees_report_json() {
    let shown = json(program().args(["tree", "show", TREE]));
    let summary = [
        "tree",
        "depth",
        "composites",
        "primitives",
        "primitives_by_state_type",
    ];
    assert_fields(&shown, &summary);
    assert_eq!(
        (&shown["depth"], &shown["composites"]),
        (&2.into(), &1.into())
    );
    let checked = json(program().args([
        "tree",
        "check",
        " (Root  Wander ApproachBattery\nApproachNest)",
    ]));
    assert_eq!(checked, serde_json::json!({ "valid": true, "tree": TREE }));
    let difference = json(program().args(["tree", "diff", TREE, OTHER]));
    assert_eq!(
        difference,
        serde_json::json!({ "a": TREE, "b": OTHER, "difference": -2 })
    );
    assert_eq!(
        succeeds(program().args(["tree", "diff", TREE, OTHER])),
        "-2\n"
    );
    assert!(succeeds(program().args(["tree", "dot", TREE])).starts_with("digraph"));
}

#[test]
fn primitives_report_action_values() {
    let mut command = program();
    command.args(["primitives", "smoke"]);
    set(&mut command, SHORT);
    let result = json(&mut command);
    assert_fields(&result, &["scenario", "seed", "primitives"]);
    let primitives = result["primitives"].as_array().unwrap();
    assert_eq!(primitives.len(), 5);
    for primitive in primitives {
        assert_fields(primitive, &["subtask", "actions", "rows"]);
        let actions = primitive["actions"].as_array().unwrap().len();
        for row in primitive["rows"].as_array().unwrap() {
            assert_fields(row, &["input", "greedy_action", "q"]);
            assert_eq!(row["q"].as_array().unwrap().len(), actions);
            let greedy = row["greedy_action"].as_u64().unwrap() as usize;
            assert!((1..=actions).contains(&greedy));
        }
    }
}

#[test]
fn check_prints_complete_scenarios_that_can_be_read_again() {
    let reports = json(program().args(["check", "smoke", "environment-2"]));
    for (report, name) in reports
        .as_array()
        .unwrap()
        .iter()
        .zip(["smoke", "environment-2"])
    {
        assert_fields(report, &["file", "valid", "scenario"]);
        let again = Scenario::parse(&report["scenario"].to_string(), "again").unwrap();
        assert_eq!(again, Scenario::load(name).unwrap());
    }
    let mixed = output(program().args(["check", "smoke", "missing"]));
    assert_eq!(mixed.status.code(), Some(1));
    assert_eq!(stdout(&mixed), "smoke: valid\n");
    assert!(stderr(&mixed).starts_with("error: no scenario \"missing\""));
}

#[test]
fn the_schema_accepts_built_in_scenarios_and_rejects_broken_ones() {
    let schema: Value = serde_json::from_str(&succeeds(program().arg("schema"))).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    for embedded in EMBEDDED {
        let shipped: Value = serde_json::from_str(embedded.json).unwrap();
        let errors: Vec<_> = validator
            .iter_errors(&shipped)
            .map(|e| e.to_string())
            .collect();
        assert!(errors.is_empty(), "{}: {errors:?}", embedded.name);
        let complete = serde_json::to_value(Scenario::load(embedded.name).unwrap()).unwrap();
        assert!(
            validator.is_valid(&complete),
            "{} with defaults",
            embedded.name
        );
    }
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/scenarios");
    let read = |name: &str| -> Value {
        serde_json::from_slice(&fs::read(fixtures.join(name)).unwrap()).unwrap()
    };
    assert!(validator.is_valid(&read("valid.json")));
    for broken in [
        "wrong-type.json",
        "negative-count.json",
        "short-list.json",
        "unknown-field.json",
        "missing-field.json",
        "unknown-world.json",
        "list.json",
        "control-characters-in-a-key.json",
    ] {
        assert!(
            !validator.is_valid(&read(broken)),
            "{broken} is valid by the schema"
        );
    }
}

#[test]
fn built_in_scenarios_run_in_any_folder() {
    let folder = TempDir::new().unwrap();
    let listed = json(program().current_dir(&folder).arg("scenarios"));
    let names: Vec<_> = listed
        .as_array()
        .unwrap()
        .iter()
        .map(|row| row["name"].as_str().unwrap())
        .collect();
    assert_eq!(
        names,
        EMBEDDED
            .iter()
            .chain(EMBEDDED_PLANS)
            .map(|embedded| embedded.name)
            .collect::<Vec<_>>()
    );
    for embedded in EMBEDDED {
        let printed = succeeds(
            program()
                .current_dir(&folder)
                .args(["scenarios", embedded.name]),
        );
        assert_eq!(printed, embedded.json);
        let valid = succeeds(
            program()
                .current_dir(&folder)
                .args(["check", embedded.name]),
        );
        assert_eq!(valid, format!("{}: valid\n", embedded.name));
    }
    // A folder of the same name does not hide the scenario.
    fs::create_dir(folder.path().join("smoke")).unwrap();
    let mut command = program();
    command.current_dir(&folder).args(["run", "smoke"]);
    set(&mut command, SHORT);
    succeeds(&mut command);
}

#[test]
fn help_manual_and_completions_are_printed() {
    for command in COMMANDS {
        let help = succeeds(program().args(*command).arg("--help"));
        assert!(help.contains("Usage: maxq-lab"), "{command:?}: {help}");
    }
    let help = succeeds(program().arg("--help"));
    let manual = succeeds(program().arg("manual"));
    assert!(manual.contains(".TH"));
    for command in COMMANDS {
        let page = format!(".TH maxq\\-lab\\-{}", command.join("\\-"));
        let is_there = manual.contains(&page) || manual.contains(&page.replace('\\', ""));
        assert!(help.contains(command[0]) && is_there, "{command:?}");
    }
    assert!(succeeds(program().arg("--version")).starts_with("maxq-lab "));
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(succeeds(program().args(["completions", shell])).contains("evaluate"));
    }
}

/// The words that bash offers for the last word of a command line.
fn completed_by_bash(words: &[&str]) -> Vec<String> {
    let script = succeeds(program().args(["completions", "bash"]));
    let words = words.join(" ");
    let line = format!(
        "{script}\nCOMP_WORDS=({words} \"\"); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))\n\
         _maxq__lab maxq-lab \"\" \"${{COMP_WORDS[COMP_CWORD - 1]}}\"\nprintf '%s\\n' \"${{COMPREPLY[@]}}\""
    );
    let offered = succeeds(std::process::Command::new("bash").args(["-c", &line]));
    offered.lines().map(str::to_owned).collect()
}

#[test]
fn shells_offer_scenarios_plans_and_themes() {
    let offers = |words: &[&str], name: &str| {
        let offered = completed_by_bash(&[&["maxq-lab"], words].concat());
        assert!(
            offered.iter().any(|word| word == name),
            "{words:?}: {offered:?}"
        );
    };
    for command in [
        "run",
        "evaluate",
        "check",
        "study",
        "learn",
        "primitives",
        "scenarios",
    ] {
        offers(&[command], "environment-1");
    }
    offers(&["study"], "thesis");
    offers(&["tree", "show", "--scenario"], "taxi");
    offers(&["run", "smoke", "--theme"], "high-contrast");
    // Files are offered too, and a name that is not offered is no error of the arguments.
    let zsh = succeeds(program().args(["completions", "zsh"]));
    assert!(zsh.contains("\"files:file:_files\"}"), "{zsh}");
    let count = |text: &str| zsh.matches(text).count();
    assert_eq!(count(":(cliff"), count("names:name:(cliff"), "{zsh}");
    let fish = succeeds(program().args(["completions", "fish"]));
    assert!(
        fish.contains("using_subcommand run\" -a \"cliff "),
        "{fish}"
    );
    assert!(!succeeds(program().args(["run", "--help"])).contains("possible values: environment"));
}

/// The command lines of the examples in a help text, with continued lines joined and without
/// the remarks beside them.
fn examples(help: &str) -> Vec<String> {
    let after = help.split("Example").nth(1).unwrap_or("");
    let lines = after
        .lines()
        .skip(1)
        .take_while(|line| line.starts_with("  "));
    let mut commands = Vec::<String>::new();
    for line in lines {
        assert!(
            line.chars().count() <= 100,
            "is too long, so it is wrapped: {line}"
        );
        match commands.last_mut().filter(|last| last.ends_with('\\')) {
            Some(last) => *last = last.replace('\\', line.trim()),
            None => commands.push(line.trim().to_owned()),
        }
    }
    let said = |line: String| line.split("    ").next().unwrap_or("").to_owned();
    commands.into_iter().map(said).collect()
}

#[test]
fn every_command_has_examples_and_they_use_options_that_it_has() {
    for command in COMMANDS {
        let help = succeeds(program().args(*command).arg("--help"));
        let examples = examples(&help);
        // Commands without examples are in those of their parent.
        let is_shown = command[0] == "tree" && command.len() == 2 || command[0] == "scenarios";
        assert!(is_shown || !examples.is_empty(), "{command:?}");
        let calls = examples.iter().flat_map(|line| line.split(['|', ';', '>']));
        let calls = calls.filter_map(|call| call.trim().strip_prefix("maxq-lab "));
        for call in calls {
            let words: Vec<_> = call.split_whitespace().collect();
            let path = COMMANDS.iter().filter(|path| words.starts_with(path));
            let path = path.max_by_key(|path| path.len()).expect(call);
            let help = succeeds(program().args(*path).arg("--help"));
            for option in words.iter().filter(|word| word.starts_with("--")) {
                assert!(help.contains(&format!("{option} ")), "{option} in {call}");
            }
        }
    }
}

#[test]
fn a_closed_standard_output_causes_no_panic() {
    let parent = TempDir::new().unwrap();
    for (index, arguments) in [
        &["schema"][..],
        &["manual"],
        &["scenarios"],
        &["scenarios", "environment-3"],
        &["check", "smoke", "--format", "json"],
        &["completions", "bash"],
        &["--help"],
        &["run", "--help"],
        &["run", "smoke", "--set", "evolution.generation_limit=1"],
        &["tree", "show", TREE],
    ]
    .into_iter()
    .enumerate()
    {
        // Closed after the first byte, and before it.
        for taken in [1, 0] {
            let mut command = program();
            command.current_dir(&parent).args(arguments);
            if arguments == ["run", "smoke", "--set", "evolution.generation_limit=1"] {
                command.args(["--out", &format!("run-{index}-{taken}")]);
            }
            command.stdout(Stdio::piped()).stderr(Stdio::piped());
            let mut child = command.spawn().unwrap();
            let mut pipe = child.stdout.take().unwrap();
            pipe.read_exact(&mut vec![0; taken]).unwrap();
            drop(pipe);
            let output = child.wait_with_output().unwrap();
            assert_eq!(
                output.status.code(),
                Some(0),
                "{arguments:?}: {}",
                stderr(&output)
            );
            assert_eq!(stderr(&output), "", "{arguments:?}");
        }
    }
}

#[test]
fn a_stopped_run_names_the_command_that_resumes_it_and_keeps_standard_output_clean() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let mut command = program();
    command
        .args(["run", "environment-3", "--format", "json", "--out"])
        .arg(&folder);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    wait_until("the run folder", || folder.exists());
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-s", "TERM", &id])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(143));
    let result: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(
        (&result["stopped"], &result["converged"]),
        (&true.into(), &false.into())
    );
    let said = stderr(&output);
    assert!(
        said.contains(&format!("maxq-lab resume {}", folder.display())),
        "{said}"
    );
}

/// The median, so that one delay on a loaded machine does not count.
fn median(mut durations: Vec<Duration>) -> Duration {
    durations.sort();
    durations[durations.len() / 2]
}

#[test]
fn stopping_takes_effect_within_a_tenth_of_a_second() {
    let parent = TempDir::new().unwrap();
    let scenario = Scenario::load("environment-3").unwrap();
    let mut rng = stream(1, 0, 0, Purpose::Trials);
    let stops = (0..20).map(|attempt| {
        let mut scenario = scenario.clone();
        // Half of the runs are stopped during the training of primitive subtasks; the
        // others, with a short training, during a generation.
        let training = attempt % 2 == 0;
        if !training {
            let short = SHORT.iter().filter(|setting| setting.contains("training"));
            let short: Vec<_> = short.map(|&setting| setting.to_owned()).collect();
            scenario = scenario.with_settings(&short).unwrap();
        }
        let folder = parent.path().join(attempt.to_string());
        let run = start(scenario, attempt, &folder, &threads(2)).unwrap();
        if !training {
            wait_until("a checkpoint", || folder.join("checkpoint.json").exists());
        }
        // Stop at a random moment.
        std::thread::sleep(Duration::from_millis(rng.random_range(0..100)));
        let asked = Instant::now();
        run.controls.stop();
        let outcome = run.join().unwrap();
        assert!(outcome.stopped);
        asked.elapsed()
    });
    let stops: Vec<_> = stops.collect();
    let median = median(stops.clone());
    assert!(median < Duration::from_millis(100), "{stops:?}");
}

#[test]
fn pausing_takes_effect_within_a_tenth_of_a_second() {
    let parent = TempDir::new().unwrap();
    let scenario = Scenario::load("environment-3").unwrap();
    let run = start(scenario, 1, &parent.path().join("run"), &threads(2)).unwrap();
    let mut pauses = Vec::new();
    for _ in 0..20 {
        let before = run.controls.control_steps();
        wait_until("control steps", || run.controls.control_steps() > before);
        let asked = Instant::now();
        run.controls.pause();
        // The run is paused once no step is computed for a while; the last step counts.
        let mut last = (run.controls.control_steps(), asked);
        while last.1.elapsed() < Duration::from_millis(20) {
            let steps = run.controls.control_steps();
            if steps != last.0 {
                last = (steps, Instant::now());
            }
            std::thread::yield_now();
        }
        pauses.push(last.1.duration_since(asked));
        run.controls.resume();
    }
    run.controls.stop();
    run.join().unwrap();
    let median = median(pauses.clone());
    assert!(median < Duration::from_millis(100), "{pauses:?}");
}
