//! Contract: the run folder holds exactly the documented files, only one process at a time writes
//! to it, and nothing is overwritten or deleted without being asked.
//!
//! Why it matters: a run takes hours. Two processes in one folder, or a mistyped --out, must not
//! destroy it.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, SystemTime};

use common::{
    Record, lines, output, program, run_in, short, smoke, stderr, stdout, threads, wait_until,
};
use maxq_lab::lab::{Keep, RunOptions, resume};
use serde_json::Value;
use tempfile::TempDir;

/// Returns the command `run smoke --out` with settings that make the run short.
fn run(out: &Path) -> Command {
    let mut command = program();
    command.args([
        "run",
        "smoke",
        "--format",
        "json",
        "--threads",
        "2",
        "--out",
    ]);
    command.arg(out);
    common::set(&mut command, common::SHORT);
    command
}

/// Returns the paths of everything in a folder, sorted.
fn contents(folder: &Path) -> Vec<PathBuf> {
    let mut paths = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            paths.push(path.strip_prefix(folder).unwrap().to_owned());
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    paths.sort();
    paths
}

fn refused(command: &mut Command) -> String {
    let output = output(command);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(stdout(&output).is_empty());
    said
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn the_folder_holds_the_documented_files_and_no_others() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let outcome = run_in(&folder, &short(&[]), 7, &threads(2));
    let generations = (1..=outcome.generations).map(|g| format!("generations/{g:06}.json"));
    let files = [
        "checkpoint.json",
        "events.jsonl",
        "generations",
        "lock",
        "run.json",
        "summary.json",
    ];
    let mut expected: Vec<PathBuf> = files.iter().map(PathBuf::from).collect();
    expected.extend(generations.map(PathBuf::from));
    expected.sort();
    assert_eq!(contents(&folder), expected);
    assert_eq!(
        contents(parent.path()).len(),
        expected.len() + 1,
        "something lies beside it"
    );
    // One line for the start, one for each generation, one for the end.
    assert_eq!(
        lines(&folder.join("events.jsonl")) as u64,
        outcome.generations + 2
    );
    assert_eq!(
        json(&folder.join("summary.json")),
        serde_json::to_value(&outcome).unwrap()
    );
}

#[test]
fn run_json_holds_scenario_seed_and_invocation() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let whole = output(run(&folder).args(["--seed", "7"]));
    assert!(whole.status.success());
    let manifest = json(&folder.join("run.json"));
    assert_eq!(manifest["format"], 1);
    assert_eq!(manifest["seed"], 7);
    assert_eq!(
        manifest["scenario"],
        serde_json::to_value(short(&[])).unwrap()
    );
    assert_eq!(manifest["resumed"], serde_json::json!([]));
    let started = &manifest["started"];
    assert_eq!(started["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(started["threads"], 2);
    assert_eq!(started["command_line"][0], "maxq-lab");
    assert_eq!(started["command_line"][1], "run");
    for field in ["commit", "host", "time"] {
        assert!(!started[field].as_str().unwrap().is_empty(), "{field}");
    }
    let time = started["time"].as_str().unwrap();
    assert!(time.len() == 20 && time.ends_with('Z'), "{time}");

    assert!(
        output(program().arg("resume").arg(&folder))
            .status
            .success()
    );
    let resumed = json(&folder.join("run.json"));
    assert_eq!(resumed["started"], manifest["started"]);
    assert_eq!(resumed["resumed"][0]["command_line"][1], "resume");
}

#[test]
fn without_out_the_folder_is_named_after_scenario_and_seed() {
    let parent = TempDir::new().unwrap();
    let mut command = program();
    command
        .current_dir(&parent)
        .args(["run", "smoke", "--seed", "3"]);
    common::set(&mut command, common::SHORT);
    assert!(output(&mut command).status.success());
    assert!(parent.path().join("runs/smoke-seed3/run.json").is_file());
}

#[test]
fn keep_selects_the_generations_that_are_kept() {
    for (keep, kept) in [
        ("all", &[1, 2, 3, 4, 5, 6][..]),
        ("thinned", &[1, 2, 3, 4, 5, 6]),
        ("none", &[]),
        ("2", &[2, 4, 6]),
        ("5", &[5]),
    ] {
        let keep: Keep = keep.parse().unwrap();
        let parent = TempDir::new().unwrap();
        let folder = parent.path().join("run");
        let options = RunOptions {
            keep: Some(keep),
            ..threads(2)
        };
        let outcome = run_in(&folder, &short(&[]), 1, &options);
        assert_eq!(
            outcome.generations, 6,
            "this test needs a seed that does not converge"
        );
        let expected: Vec<_> = kept
            .iter()
            .map(|g| PathBuf::from(format!("{g:06}.json")))
            .collect();
        assert_eq!(contents(&folder.join("generations")), expected, "{keep:?}");
    }
}

/// A run that computes until it is killed.
struct Endless {
    child: Child,
    folder: PathBuf,
}

impl Endless {
    fn start(folder: PathBuf) -> Self {
        let mut command = program();
        command.args(["run", "smoke", "--out"]).arg(&folder);
        // Batteries that cannot be captured: a generation takes hours.
        let endless = [
            "world.foraging.robot.capture_distance_mm=1",
            "evolution.trials_per_generation=1024",
            "evolution.trial_step_limit=100000",
        ];
        common::set(&mut command, &endless);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let child = command.spawn().unwrap();
        wait_until("a checkpoint", || folder.join("checkpoint.json").exists());
        Self { child, folder }
    }

    fn is_alive(&mut self) -> bool {
        self.child.try_wait().unwrap().is_none()
    }
}

impl Drop for Endless {
    fn drop(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

#[test]
fn a_second_process_is_refused_and_changes_nothing() {
    let parent = TempDir::new().unwrap();
    let mut first = Endless::start(parent.path().join("run"));
    let manifest = fs::read(first.folder.join("run.json")).unwrap();
    let said = refused(program().arg("resume").arg(&first.folder));
    assert!(said.contains("another process works on this run"), "{said}");
    let said = refused(run(&first.folder).arg("--force"));
    assert!(said.contains("another process works on this run"), "{said}");
    let said = refused(&mut run(&first.folder));
    assert!(
        said.contains("exists already and holds another run"),
        "{said}"
    );
    assert!(first.is_alive());
    assert_eq!(fs::read(first.folder.join("run.json")).unwrap(), manifest);
    assert!(first.folder.join("events.jsonl").is_file());
}

#[test]
fn a_killed_process_leaves_no_lock_behind() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    drop(Endless::start(folder.clone()));
    assert!(output(run(&folder).arg("--force")).status.success());
}

#[test]
fn an_existing_run_is_replaced_only_with_force() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(
        &folder,
        &smoke(&["evolution.generation_limit=2"]),
        5,
        &threads(2),
    );
    let before = Record::of(&folder);
    let said = refused(&mut run(&folder));
    for part in [
        "exists already and holds another run: seed is 5 there, 1 here; ",
        "evolution.generation_limit is 2 there, ",
        "to keep both: maxq-lab run smoke",
        "allowed: another --out, or --force",
    ] {
        assert!(said.contains(part), "{said}");
    }
    assert!(!said.contains("resume"), "{said}");
    Record::of(&folder).assert_same(&before, "after a refusal");

    assert!(output(run(&folder).arg("--force")).status.success());
    let expected = common::record(&short(&[]), 1, &threads(2));
    Record::of(&folder).assert_same(&expected, "after --force");
    let said = refused(&mut run(&folder));
    assert!(said.contains("exists already and holds this run"), "{said}");
    assert!(said.contains("to resume it: maxq-lab resume "), "{said}");
    // The old run had fewer generations; nothing of either is left beside the new one.
    assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1);
}

#[test]
fn a_run_folder_given_as_a_scenario_is_refused_with_a_hint() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let said = refused(program().arg("run").arg(&folder));
    assert!(
        said.contains("found a run folder; allowed: a scenario file"),
        "{said}"
    );
    assert!(
        said.contains("to resume this run: maxq-lab resume "),
        "{said}"
    );
}

#[test]
fn a_run_folder_does_not_hide_a_built_in_scenario_of_the_same_name() {
    let parent = TempDir::new().unwrap();
    run_in(&parent.path().join("smoke"), &short(&[]), 1, &threads(2));
    let said = output(
        program()
            .current_dir(parent.path())
            .args(["check", "smoke"]),
    );
    assert!(said.status.success());
    let mut run = program();
    run.current_dir(parent.path());
    run.args(["run", "smoke", "--headless", "--generations", "1"]);
    assert!(output(&mut run).status.success());
}

#[test]
fn force_leaves_files_that_are_not_the_runs_own() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 5, &threads(2));
    let own = ["notes.txt", "generations/sketch.svg", "plots/a.png"].map(|name| folder.join(name));
    fs::create_dir(folder.join("plots")).unwrap();
    for path in &own {
        fs::write(path, "years of work").unwrap();
    }
    let done = output(run(&folder).arg("--force"));
    assert!(done.status.success());
    let said = stderr(&done);
    assert!(said.contains("run: notes.txt, plots"), "{said}");
    for path in &own {
        assert_eq!(fs::read_to_string(path).unwrap(), "years of work");
    }
    Record::of(&folder).assert_same(
        &common::record(&short(&[]), 1, &threads(2)),
        "beside the user's files",
    );
}

#[test]
fn a_symbolic_link_is_no_place_for_a_new_run() {
    let parent = TempDir::new().unwrap();
    let (folder, link) = (parent.path().join("run"), parent.path().join("link"));
    run_in(&folder, &short(&[]), 5, &threads(2));
    let before = Record::of(&folder);
    std::os::unix::fs::symlink(&folder, &link).unwrap();
    for path in [link.clone(), link.join("")] {
        for force in [&["--force"][..], &[]] {
            let said = refused(run(&path).args(force));
            assert!(said.contains("found a symbolic link"), "{said}");
        }
    }
    Record::of(&folder).assert_same(&before, "after the refusals");
}

#[test]
fn export_writes_over_no_file_of_a_run() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 5, &threads(2));
    let before = Record::of(&folder);
    for name in [
        "events.jsonl",
        "checkpoint.json",
        "run.json",
        "generations/000001.json",
        "generations/../summary.json",
    ] {
        let to = folder.join(name);
        let said = refused(
            program()
                .args(["export", "--format", "csv"])
                .arg(&folder)
                .arg("--out")
                .arg(&to),
        );
        assert!(said.contains("a file of a run or study"), "{said}");
    }
    Record::of(&folder).assert_same(&before, "after the refusals");
    let to = folder.join("table.csv");
    assert!(
        output(
            program()
                .args(["export", "--format", "csv"])
                .arg(&folder)
                .arg("--out")
                .arg(&to)
        )
        .status
        .success()
    );
    assert!(to.is_file());
}

#[test]
fn force_deletes_only_run_folders() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("thesis");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("chapter-1.tex"), "years of work").unwrap();
    for force in [&["--force"][..], &[]] {
        let said = refused(run(&folder).args(force));
        assert!(
            said.contains("thesis: exists already and is no run folder"),
            "{said}"
        );
        assert!(!said.contains("--force"), "{said}");
        assert_eq!(contents(&folder), [PathBuf::from("chapter-1.tex")]);
    }
    let file = folder.join("chapter-1.tex");
    for force in [&["--force"][..], &[]] {
        refused(run(&file).args(force));
        refused(run(&file.join("run")).args(force));
        assert_eq!(fs::read_to_string(&file).unwrap(), "years of work");
    }
}

#[test]
fn an_empty_folder_is_used_and_parents_are_created() {
    let parent = TempDir::new().unwrap();
    let empty = parent.path().join("empty");
    fs::create_dir(&empty).unwrap();
    assert!(output(&mut run(&empty)).status.success());
    let deep = parent.path().join("not/there/yet");
    assert!(output(&mut run(&deep)).status.success());
    assert!(empty.join("summary.json").is_file() && deep.join("summary.json").is_file());
}

#[test]
fn resuming_a_finished_run_keeps_its_wall_clock_time() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let summary = fs::read(folder.join("summary.json")).unwrap();
    let moved = parent.path().join("moved");
    fs::rename(&folder, &moved).unwrap();
    resume(&moved, None, &threads(1)).unwrap().join().unwrap();
    assert_eq!(fs::read(moved.join("summary.json")).unwrap(), summary);
    // A summary that no longer fits the run is replaced.
    let longer = resume(&moved, Some(50), &threads(1))
        .unwrap()
        .join()
        .unwrap();
    assert!(longer.generations > 6);
    assert_eq!(
        json(&moved.join("summary.json"))["generations"],
        longer.generations
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_path_that_cannot_be_written_is_refused() {
    // Refuses new folders even to root, unlike a folder without write permission.
    let said = refused(&mut run(Path::new("/proc/maxq-lab-run")));
    assert!(said.starts_with("error: /proc"), "{said}");
    assert!(
        !said.contains(".new-run-"),
        "the name of a temporary folder: {said}"
    );
    let said = refused(&mut run(Path::new("/proc/maxq-lab/run")));
    assert!(said.starts_with("error: /proc/maxq-lab"), "{said}");
}

#[cfg(unix)]
#[test]
fn a_read_only_parent_is_refused() {
    use std::os::unix::fs::PermissionsExt;

    let parent = TempDir::new().unwrap();
    let locked = parent.path().join("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::create_dir(locked.join("probe")).is_ok() {
        // Permissions do not bind root; the test above covers that case.
        return;
    }
    let said = refused(&mut run(&locked.join("run")));
    assert!(said.contains("locked") && said.contains("denied"), "{said}");
}

#[test]
fn a_run_that_cannot_start_creates_no_folder() {
    let parent = TempDir::new().unwrap();
    let out = parent.path().join("run");
    let walls = "world.foraging.arena.size_mm=[300, 300]";
    let points = [
        "world.foraging.arena.batteries_mm=[[9, 9]]",
        "world.foraging.arena.nest_mm=[9, 9]",
    ];
    let block = "world.foraging.arena.walls_mm=[[150, 0, 150, 300], [0, 150, 300, 150]]";
    let mut command = run(&out);
    common::set(&mut command, &[walls, points[0], points[1], block]);
    let said = refused(&mut command);
    assert!(
        said.contains("world.foraging.arena: found no free place"),
        "{said}"
    );
    assert!(contents(parent.path()).is_empty());
}

#[test]
fn unfinished_files_of_a_dead_process_are_removed() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let whole = contents(&folder);
    fs::write(folder.join(".writing-abc"), "half").unwrap();
    fs::write(folder.join("generations/.writing-def"), "half").unwrap();
    let old = parent.path().join(".new-run-old");
    fs::create_dir_all(old.join("generations")).unwrap();
    let long_ago = SystemTime::now() - Duration::from_secs(7200);
    let opened = fs::File::open(&old).unwrap();
    opened.set_modified(long_ago).unwrap();
    let fresh = parent.path().join(".new-run-fresh");
    fs::create_dir(&fresh).unwrap();
    resume(&folder, None, &threads(2)).unwrap().join().unwrap();
    assert_eq!(contents(&folder), whole);
    run_in(&parent.path().join("other"), &short(&[]), 1, &threads(2));
    assert!(!old.exists());
    assert!(fresh.exists(), "another process may be making a run in it");
}
