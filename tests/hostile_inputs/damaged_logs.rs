//! Logs that are damaged or of another run: every reader refuses them, also where each line
//! alone is a valid event.

use std::fs;
use std::path::Path;

use maxq_lab::lab::{Recording, check_log};
use tempfile::TempDir;

use super::common::{output, program, run_in, short, threads};
use super::{assert_says, refused};

/// The messages of the commands that read a run folder; all of them are the same.
fn said_of(folder: &Path) -> String {
    let export = refused(program().args(["export", "--format", "csv"]).arg(folder));
    let figure = refused(
        program()
            .args(["export", "--figure", "4.8", "--format", "csv"])
            .arg(folder),
    );
    let frame = refused(program().arg("frame").arg(folder));
    assert_eq!(export, frame);
    assert_eq!(export, figure);
    export
}

/// A finished run, and the lines of its log.
fn victim() -> (TempDir, Vec<String>) {
    let folder = TempDir::new().unwrap();
    let run = folder.path().join("run");
    run_in(&run, &short(&[]), 2, &threads(2));
    let text = fs::read_to_string(run.join("events.jsonl")).unwrap();
    let lines = text.split_inclusive('\n').map(str::to_owned).collect();
    (folder, lines)
}

/// Every damage with a part of the message that it causes where no checkpoint holds a checksum.
fn damages(lines: &[String], other: &[String]) -> Vec<(&'static str, String, String)> {
    let n = lines.len();
    let with = |change: &dyn Fn(&mut Vec<String>)| {
        let mut changed = lines.to_vec();
        change(&mut changed);
        changed.concat()
    };
    let fitness = lines[2].find("\"fitness_steps\":").unwrap() + 16;
    vec![
        (
            "a generation twice",
            with(&|lines| lines.insert(2, lines[1].clone())),
            String::from("line 3: found generation 1; allowed: generation 2, or the end"),
        ),
        (
            "lines in reverse",
            with(&|lines| lines.reverse()),
            String::from("line 1: found the end after"),
        ),
        (
            "no start",
            with(&|lines| drop(lines.remove(0))),
            String::from("line 1: found generation 1; allowed: the start of the run"),
        ),
        (
            "no end",
            with(&|lines| drop(lines.pop())),
            format!("line {}: found generation {}", n - 1, n - 2),
        ),
        (
            "an incomplete last line",
            with(&|lines| assert_eq!(lines[n - 1].pop(), Some('\n'))),
            format!("line {}: found", n - 1),
        ),
        (
            "the log of another seed",
            other.concat(),
            String::from(
                "line 1: found the events of smoke with seed 3; allowed: those of smoke with seed 2",
            ),
        ),
        (
            "a fitness edited by hand",
            with(&|lines| lines[2].insert(fitness, '1')),
            String::from("line 3: individuals[0].fitness_steps: found 1"),
        ),
    ]
}

#[test]
fn a_damaged_log_is_refused_by_every_reader() {
    let (folder, lines) = victim();
    let run = folder.path().join("run");
    let other = folder.path().join("other");
    run_in(&other, &short(&[]), 3, &threads(2));
    let other = fs::read_to_string(other.join("events.jsonl")).unwrap();
    let other: Vec<_> = other.split_inclusive('\n').map(str::to_owned).collect();
    let log = run.join("events.jsonl");
    assert!(
        output(program().args(["export", "--format", "csv"]).arg(&run))
            .status
            .success()
    );
    for (what, damaged, _) in damages(&lines, &other) {
        fs::write(&log, damaged).unwrap();
        assert_says(&said_of(&run), &["events.jsonl: ", "found", "allowed"]);
        let recording = Recording::read(&run);
        assert!(recording.is_err(), "{what}");
    }
    // Without a checkpoint there is no checksum, but the result and the order of events still tell.
    let (ends, orders): (Vec<_>, Vec<_>) = damages(&lines, &other)
        .into_iter()
        .partition(|(what, ..)| what.contains("end") || what.contains("last"));
    for (missing, damages) in [("checkpoint.json", ends), ("summary.json", orders)] {
        fs::remove_file(run.join(missing)).unwrap();
        for (what, damaged, says) in damages {
            fs::write(&log, damaged).unwrap();
            let said = said_of(&run);
            assert!(said.contains(&says), "{what}: {said}");
        }
    }
    fs::write(&log, lines.concat()).unwrap();
    assert!(
        output(program().args(["export", "--format", "csv"]).arg(&run))
            .status
            .success()
    );
}

#[test]
fn a_digit_that_no_rule_covers_is_found_by_the_checksum() {
    let (folder, lines) = victim();
    let run = folder.path().join("run");
    let changed = lines
        .concat()
        .replacen("\"composites\":", "\"composites\":1", 1);
    fs::write(run.join("events.jsonl"), changed).unwrap();
    assert_says(
        &said_of(&run),
        &[
            "events.jsonl: found CRC-32 ",
            "the checkpoint was taken after",
        ],
    );
}

#[test]
fn a_result_of_another_run_is_refused() {
    let (folder, _) = victim();
    let run = folder.path().join("run");
    let summary = run.join("summary.json");
    let whole = fs::read_to_string(&summary).unwrap();
    for (found, other) in [
        ("\"seed\": 2", "\"seed\": 3"),
        ("\"fitness\": ", "\"fitness\": 1"),
    ] {
        fs::write(&summary, whole.replacen(found, other, 1)).unwrap();
        assert_says(
            &said_of(&run),
            &["summary.json: is not the result of this run"],
        );
    }
}

#[test]
fn an_interrupted_run_may_end_within_a_line() {
    let (folder, lines) = victim();
    let run = folder.path().join("run");
    fs::remove_file(run.join("summary.json")).unwrap();
    fs::write(
        run.join("events.jsonl"),
        lines.concat() + "{\"event\":\"gen",
    )
    .unwrap();
    let recording = Recording::read(&run).unwrap();
    assert_eq!(recording.generations(), lines.len() as u64 - 2);
    check_log(&run, &recording.manifest).unwrap();
}
