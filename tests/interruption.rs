//! Contract: a run that is stopped at any moment, even by `kill -9`, and resumed has the same
//! events, the same checkpoint and the same kept generations as an uninterrupted run.
//!
//! Why it matters: runs take hours, and machines are switched off. A run that cannot be trusted
//! after an interruption has to be thrown away.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

use common::{
    Record, lines, output, program, run_in, set, short, smoke, stderr, stop_after, threads,
    wait_until,
};
use maxq_lab::lab::inspection::Archive;
use maxq_lab::lab::{
    Checkpoint, Event, Keep, LastSign, Outcome, Recording, RunOptions, kept_generations,
    lasting_experiment, resume, resume_at, start,
};
use maxq_lab::random::{Purpose, stream};
use rand::RngExt;
use tempfile::TempDir;

/// Settings that make `smoke` run for about a second: under random selection a population takes
/// long to converge.
const LONGER: &[&str] = &[
    "evolution.selection=random",
    "evolution.trial_step_limit=500",
    "evolution.generation_limit=12",
    "evolution.population_size=16",
    concat!(
        r#"evolution.initial_population=["(Root Wander ApproachBattery ApproachNest)","#,
        r#""(Root Avoid ApproachBattery ApproachNest Turn)","#,
        r#""(Root Wander Turn ApproachBattery ApproachNest)","#,
        r#""(Root (Capture Wander ApproachBattery) Avoid ApproachNest)","#,
        r#""(Root (Deliver Wander ApproachNest) Avoid ApproachBattery)","#,
        r#""(Root (FindBattery Wander) (FindNest Avoid) ApproachBattery ApproachNest)","#,
        r#""(Root Wander (VisibleBattery ApproachBattery Avoid) ApproachNest)","#,
        r#""(Root Avoid (VisibleBattery ApproachBattery Turn) ApproachNest)","#,
        r#""(Root Wander (VisibleNest ApproachNest Turn) ApproachBattery)","#,
        r#""(Root Avoid Wander ApproachBattery ApproachNest Turn)","#,
        r#""(Root (FindNest Wander) Avoid ApproachBattery ApproachNest)","#,
        r#""(Root (Capture Avoid ApproachBattery) (Deliver Wander ApproachNest))","#,
        r#""(Root Wander Wander ApproachBattery ApproachNest)","#,
        r#""(Root Avoid Avoid ApproachBattery ApproachNest)","#,
        r#""(Root (FindBattery Avoid) Wander ApproachBattery ApproachNest)","#,
        r#""(Root (FindBattery Avoid Wander) Turn Wander ApproachBattery ApproachNest)"]"#,
    ),
];

/// Moments at which a run is killed.
const KILLS: usize = 20;

fn run_command(folder: &Path, settings: &[&str]) -> Command {
    let mut command = program();
    command.args(["run", "smoke", "--headless", "--threads", "2", "--out"]);
    command.arg(folder);
    set(&mut command, settings);
    command
}

fn resume_command(folder: &Path) -> Command {
    let mut command = program();
    command.args(["resume", "--headless", "--threads", "2"]);
    command.arg(folder);
    command
}

/// Returns the command that resumes a run, or starts it if there is none.
fn resume_or_start(folder: &Path) -> Command {
    match folder.exists() {
        true => resume_command(folder),
        false => run_command(folder, LONGER),
    }
}

fn spawn(command: &mut Command) -> Child {
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

/// Returns the kept generations, by name.
fn kept(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder.join("generations")).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let json = |path: &PathBuf| {
        path.extension()
            .is_some_and(|extension| extension == "json")
    };
    let mut kept: Vec<_> = paths
        .filter(json)
        .map(|path| (path.file_name().unwrap().into(), fs::read(&path).unwrap()))
        .collect();
    kept.sort();
    kept
}

/// Kills a process some time after its start, unless it has ended by then.
fn kill_after(child: &mut Child, moment: Duration) {
    let begun = Instant::now();
    while begun.elapsed() < moment && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_micros(300));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_run_killed_at_random_moments_equals_an_uninterrupted_run() {
    let parent = TempDir::new().unwrap();
    let undisturbed = parent.path().join("undisturbed");
    let begun = Instant::now();
    let whole = output(&mut run_command(&undisturbed, LONGER));
    let duration = begun.elapsed();
    assert!(whole.status.success(), "{}", stderr(&whole));
    let (expected, expected_kept) = (Record::of(&undisturbed), kept(&undisturbed));

    let seed = SystemTime::UNIX_EPOCH.elapsed().unwrap().as_nanos() as u64;
    let mut rng = stream(seed, 0, 0, Purpose::Trials);
    for kill in 0..KILLS {
        let folder = parent.path().join(format!("killed-{kill}"));
        // Spread over the whole run; every fourth in the first hundredth, when it starts up.
        let share: f64 = match kill % 4 {
            0 => rng.random_range(0.0..0.01),
            _ => (kill as f64 + rng.random_range(0.0..1.0)) / KILLS as f64,
        };
        let mut moments = vec![duration.mul_f64(share)];
        // Some resumed runs are killed too, up to three times.
        for _ in 0..kill % 4 {
            moments.push(duration.mul_f64(rng.random_range(0.0..0.3)));
        }
        let when = format!("killed after {moments:?} (random seed {seed}, kill {kill})");
        for &moment in &moments {
            kill_after(&mut spawn(&mut resume_or_start(&folder)), moment);
        }
        let last = output(&mut resume_or_start(&folder));
        assert!(last.status.success(), "{when}: {}", stderr(&last));
        Record::of(&folder).assert_same(&expected, &when);
        assert!(
            kept(&folder) == expected_kept,
            "{when}: generations/ differs"
        );
        fs::remove_dir_all(&folder).unwrap();
    }
}

#[test]
fn a_signal_saves_a_checkpoint_and_the_run_can_be_resumed() {
    let parent = TempDir::new().unwrap();
    let undisturbed = parent.path().join("undisturbed");
    run_in(&undisturbed, &smoke(LONGER), 1, &threads(2));
    let expected = Record::of(&undisturbed);
    for (signal, code) in [("TERM", 143), ("INT", 130), ("HUP", 129)] {
        let folder = parent.path().join(signal);
        let log = folder.join("events.jsonl");
        let mut child = spawn(&mut run_command(&folder, LONGER));
        wait_until("three generations", || lines(&log) > 3);
        send(signal, &child);
        assert_eq!(child.wait().unwrap().code(), Some(code), "SIG{signal}");
        // One line for the start and one for each generation; the checkpoint holds the last.
        let text = fs::read_to_string(folder.join("checkpoint.json")).unwrap();
        let saved = Checkpoint::from_text(&text).unwrap();
        assert_eq!(saved.generation, lines(&log) as u64 - 1, "SIG{signal}");
        assert!(!folder.join("summary.json").exists());
        let resumed = output(&mut resume_command(&folder));
        assert!(resumed.status.success(), "{}", stderr(&resumed));
        Record::of(&folder).assert_same(&expected, &format!("after SIG{signal}"));
    }
}

#[test]
fn a_signal_is_handled_as_soon_as_the_run_folder_exists() {
    let parent = TempDir::new().unwrap();
    for attempt in 0..5 {
        let folder = parent.path().join(format!("run-{attempt}"));
        let mut child = spawn(&mut run_command(&folder, LONGER));
        wait_until("the run folder", || folder.exists());
        send("TERM", &child);
        assert_eq!(child.wait().unwrap().code(), Some(143));
    }
}

fn send(signal: &str, to: &Child) {
    let id = to.id().to_string();
    let sent = Command::new("kill").args(["-s", signal, &id]).status();
    assert!(sent.unwrap().success());
}

/// Returns the folder of a run that was stopped after its third generation, and the record of the
/// same run without interruption.
fn stopped(parent: &TempDir) -> (PathBuf, Record) {
    let scenario = short(&["evolution.selection=random"]);
    let expected = common::record(&scenario, 1, &threads(2));
    let folder = parent.path().join("stopped");
    let run = start(scenario, 1, &folder, &threads(2)).unwrap();
    stop_after(run, 3);
    (folder, expected)
}

fn resumed(folder: &Path, generations: Option<u64>) -> Outcome {
    let run = resume(folder, generations, &threads(2)).unwrap();
    run.join().unwrap()
}

#[test]
fn events_after_the_checkpoint_are_dropped() {
    let line = br#"{"event":"ended","generations":4,"ending":"converged"}"#;
    let whole_line = [line.as_slice(), b"\n"].concat();
    let tails: [(&str, &[u8]); 4] = [
        ("a torn line", &line[..20]),
        ("a line of another run", &whole_line),
        ("garbage", b"\0\xff\xfe garbage \n\n{}\n"),
        ("a torn line without any text", b"\xc3"),
    ];
    for (what, tail) in tails {
        let parent = TempDir::new().unwrap();
        let (folder, expected) = stopped(&parent);
        let log = OpenOptions::new()
            .append(true)
            .open(folder.join("events.jsonl"));
        log.unwrap().write_all(tail).unwrap();
        resumed(&folder, None);
        Record::of(&folder).assert_same(&expected, what);
    }
}

#[test]
fn without_a_checkpoint_the_run_starts_again() {
    let parent = TempDir::new().unwrap();
    let (folder, expected) = stopped(&parent);
    fs::remove_file(folder.join("checkpoint.json")).unwrap();
    resumed(&folder, None);
    Record::of(&folder).assert_same(&expected, "without a checkpoint");
}

#[test]
fn a_changed_generation_limit_equals_one_given_at_the_start() {
    let with_limit = |limit: u64| {
        let limit = format!("evolution.generation_limit={limit}");
        short(&["evolution.selection=random", &limit])
    };
    let expected = common::record(&with_limit(7), 1, &threads(2));
    let parent = TempDir::new().unwrap();

    let longer = parent.path().join("longer");
    run_in(&longer, &with_limit(3), 1, &threads(2));
    assert_eq!(resumed(&longer, Some(7)).generations, 7);
    Record::of(&longer).assert_same(&expected, "from limit 3 to limit 7");

    let interrupted = parent.path().join("interrupted");
    run_in(&interrupted, &with_limit(3), 1, &threads(2));
    let run = resume(&interrupted, Some(7), &threads(2)).unwrap();
    run.controls.stop();
    run.join().unwrap();
    // The run is resumed, so the summary for limit 3 must go.
    assert!(!interrupted.join("summary.json").exists());
    assert_eq!(resumed(&interrupted, None).generations, 7);
    assert!(interrupted.join("summary.json").exists());
    Record::of(&interrupted).assert_same(&expected, "limit 7, stopped before a generation");

    let shorter = parent.path().join("shorter");
    let run = start(with_limit(1000), 1, &shorter, &threads(2)).unwrap();
    let lived = stop_after(run, 2).generations;
    assert_eq!(resumed(&shorter, Some(lived)).generations, lived);
    let expected = common::record(&with_limit(lived), 1, &threads(2));
    Record::of(&shorter).assert_same(&expected, "from limit 1000 to the generations lived");
    assert_eq!(resumed(&shorter, None).generations, lived);
}

#[test]
fn resuming_a_finished_run_changes_nothing() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let first = run_in(&folder, &short(&[]), 1, &threads(2));
    let expected = Record::of(&folder);
    let again = resumed(&folder, None);
    let timeless = |outcome: Outcome| Outcome {
        wall_seconds: 0.0,
        ..outcome
    };
    assert_eq!(timeless(again), timeless(first));
    Record::of(&folder).assert_same(&expected, "resumed when it was over");
}

#[test]
fn a_failed_run_leaves_its_reason_until_it_is_resumed() {
    let parent = TempDir::new().unwrap();
    let undisturbed = parent.path().join("undisturbed");
    run_in(&undisturbed, &smoke(LONGER), 1, &threads(2));
    let folder = parent.path().join("run");
    let run = start(smoke(LONGER), 1, &folder, &threads(2)).unwrap();
    let lived = |event: Event| matches!(event, Event::Generation(_));
    assert!(run.events.iter().any(lived));
    run.controls.pause();
    // A file in the place of the folder can be written to by nobody.
    let (generations, aside) = (folder.join("generations"), folder.join("aside"));
    fs::rename(&generations, &aside).unwrap();
    fs::write(&generations, "").unwrap();
    run.controls.resume();
    let error = run.join().unwrap_err().to_string();

    let sign = LastSign::read(&folder).unwrap();
    assert_eq!(sign.error.as_deref(), Some(&*error));
    assert_eq!(sign.time.len(), 20);
    assert_eq!(Recording::read(&folder).unwrap().last_sign, Some(sign));
    assert!(!folder.join(".writing-error").exists() && !folder.join("pulse.json").exists());
    let size = ["--size", "200x30"];
    let shown = output(
        program()
            .args(["frame", "--view", "status"])
            .args(size)
            .arg(&folder),
    );
    let shown = common::stdout(&shown);
    assert!(
        shown.contains("last alive  2") && shown.contains("cannot be written"),
        "{shown}"
    );

    fs::remove_file(&generations).unwrap();
    fs::rename(&aside, &generations).unwrap();
    let resumed = output(&mut resume_command(&folder));
    assert!(resumed.status.success(), "{}", stderr(&resumed));
    let said = stderr(&resumed);
    assert!(
        said.contains("note: the process before failed at 2"),
        "{said}"
    );
    assert_eq!(LastSign::read(&folder), None);
    Record::of(&folder).assert_same(&Record::of(&undisturbed), "after a failure");
}

#[test]
fn a_kept_state_takes_the_place_of_a_damaged_checkpoint() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("my run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let (expected, expected_kept) = (Record::of(&folder), kept(&folder));
    let checkpoint = folder.join("checkpoint.json");
    let half = &expected.checkpoint[..expected.checkpoint.len() / 2];
    for damaged in [&b""[..], half, b"{}"] {
        // The latest kept state is the same file under another name.
        fs::remove_file(&checkpoint).unwrap();
        fs::write(&checkpoint, damaged).unwrap();
        let refused = output(&mut resume_command(&folder));
        assert_eq!(refused.status.code(), Some(1));
        let offer = format!(
            "take its place: maxq-lab resume '{}' --at 6",
            folder.display()
        );
        let said = stderr(&refused);
        assert!(said.contains(&offer), "{said}");
        let replayed = Recording::read(&folder).unwrap_err().to_string();
        assert!(replayed.contains(&offer), "{replayed}");

        for at in ["6", "1", "4"] {
            let resumed = output(resume_command(&folder).args(["--at", at]));
            let said = stderr(&resumed);
            assert!(resumed.status.success(), "{said}");
            assert!(said.contains(&format!("goes back to generation {at}; dropped")));
            let when = format!("resumed at {at} without its checkpoint");
            Record::of(&folder).assert_same(&expected, &when);
            assert!(kept(&folder) == expected_kept, "{when}");
        }
    }
}

#[test]
fn a_state_before_the_damage_of_the_log_is_offered() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let expected = Record::of(&folder);
    let log = folder.join("events.jsonl");
    // In the line of generation 3.
    let mut bytes = expected.events.clone();
    let ends = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n');
    let third = ends.map(|(at, _)| at).nth(2).unwrap();
    bytes[third + 50] ^= 1;
    fs::write(&log, bytes).unwrap();
    let said = stderr(&output(&mut resume_command(&folder)));
    assert!(said.contains("events.jsonl: found CRC-32") && said.contains("--at 2\n"));
    let said = stderr(&output(resume_command(&folder).args(["--at", "5"])));
    assert!(said.contains("--at 2\n"), "{said}");
    resume_at(&folder, 2, None, &threads(2))
        .unwrap()
        .join()
        .unwrap();
    Record::of(&folder).assert_same(&expected, "from before the damage");

    for missing in ["0", "7", "18446744073709551615"] {
        let said = stderr(&output(resume_command(&folder).args(["--at", missing])));
        let wanted = format!("--at: found {missing}; allowed: a generation whose state is kept");
        assert!(
            said.contains(&wanted) && said.contains("(1 to 6)"),
            "{said}"
        );
    }
    fs::remove_dir_all(folder.join("generations")).unwrap();
    fs::write(folder.join("checkpoint.json"), "").unwrap();
    let said = stderr(&output(&mut resume_command(&folder)));
    assert!(
        said.contains("no kept state in generations/ can take its place"),
        "{said}"
    );
}

#[test]
fn going_back_with_a_lower_limit_equals_a_run_with_that_limit() {
    let parent = TempDir::new().unwrap();
    let (folder, shorter) = (parent.path().join("run"), parent.path().join("shorter"));
    run_in(&folder, &short(&[]), 1, &threads(2));
    let limit = short(&["evolution.generation_limit=4"]);
    run_in(&shorter, &limit, 1, &threads(2));
    let run = resume_at(&folder, 2, Some(4), &threads(2)).unwrap();
    assert_eq!(run.join().unwrap().generations, 4);
    Record::of(&folder).assert_same(&Record::of(&shorter), "back to 2, on to 4");
    assert_eq!(kept_generations(&folder), [1, 2, 3, 4]);
}

#[test]
fn a_run_thins_out_what_it_keeps_also_when_it_is_resumed() {
    let scenario = smoke(
        &[
            common::SHORT,
            &[
                "evolution.variation=random_trees",
                "evolution.trial_step_limit=100",
                "evolution.generation_limit=140",
            ],
        ]
        .concat(),
    );
    let parent = TempDir::new().unwrap();
    let at = |name: &str| parent.path().join(name);
    let keeping = |keep| RunOptions {
        keep: Some(keep),
        ..threads(2)
    };
    run_in(&at("whole"), &scenario, 1, &threads(2));
    let expected: Vec<u64> = (1..=140)
        .filter(|generation| match 140 - generation {
            0..64 => true,
            64..128 => generation % 2 == 0,
            _ => generation % 4 == 0,
        })
        .collect();
    assert_eq!(kept_generations(&at("whole")), expected);

    let run = start(scenario.clone(), 1, &at("stopped"), &threads(2)).unwrap();
    stop_after(run, 80);
    resumed(&at("stopped"), None);
    assert_eq!(kept_generations(&at("stopped")), expected);
    Record::of(&at("stopped")).assert_same(&Record::of(&at("whole")), "thinned");

    // What was asked for at the start holds until something else is asked for.
    let run = start(scenario.clone(), 1, &at("even"), &keeping(Keep::Every(2))).unwrap();
    stop_after(run, 9);
    resumed(&at("even"), None);
    let even: Vec<u64> = (2..=140).step_by(2).collect();
    assert_eq!(kept_generations(&at("even")), even);
    resume(&at("even"), None, &keeping(Keep::Thinned))
        .unwrap()
        .join()
        .unwrap();
    let both: Vec<u64> = expected.iter().copied().filter(|n| n % 2 == 0).collect();
    assert_eq!(kept_generations(&at("even")), both);

    let experiment = lasting_experiment(scenario, 1).unwrap();
    let mut archive = Archive::new(experiment, &at("whole"), None);
    for (wanted, nearest) in [(3, 4), (5, 4), (13, 12), (16, 16), (139, 139), (500, 140)] {
        assert_eq!(archive.nearest(wanted).unwrap().generation, nearest);
    }
}
