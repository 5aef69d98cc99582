//! Run folders with a broken `checkpoint.json`, `events.jsonl` or `run.json`.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use super::common::{Record, output, program, run_in, short, threads};
use super::{assert_says, refused};

/// A finished run whose files can be broken and restored.
struct Victim {
    _parent: TempDir,
    folder: PathBuf,
    whole: Vec<(PathBuf, Vec<u8>)>,
}

impl Victim {
    fn new() -> Self {
        let parent = TempDir::new().unwrap();
        let folder = parent.path().join("run");
        run_in(&folder, &short(&[]), 1, &threads(2));
        let whole = ["run.json", "checkpoint.json", "events.jsonl"].map(|name| {
            let path = folder.join(name);
            let bytes = fs::read(&path).unwrap();
            (path, bytes)
        });
        Self {
            _parent: parent,
            folder,
            whole: whole.into(),
        }
    }

    /// The error of `resume` with the file `name` replaced; restores the file.
    fn says_with(&self, name: &str, bytes: &[u8]) -> String {
        fs::write(self.folder.join(name), bytes).unwrap();
        self.says()
    }

    fn says(&self) -> String {
        let manifest = self.folder.join("run.json");
        let before = fs::read(&manifest).ok();
        let said = refused(program().arg("resume").arg(&self.folder));
        let after = fs::read(&manifest).ok();
        assert!(before == after, "a refused resume leaves run.json alone");
        for (path, bytes) in &self.whole {
            fs::write(path, bytes).unwrap();
        }
        said
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.folder.join(name)).unwrap()
    }

    /// The state in the checkpoint.
    fn state(&self) -> Value {
        let checkpoint: Value = serde_json::from_str(&self.text("checkpoint.json")).unwrap();
        checkpoint["state"].clone()
    }

    /// The error for a checkpoint with a changed state and its correct checksum.
    fn says_of_state(&self, change: impl FnOnce(&mut Value)) -> String {
        let mut state = self.state();
        change(&mut state);
        self.says_with("checkpoint.json", envelope(&state.to_string()).as_bytes())
    }
}

/// A checkpoint file with the correct checksum.
fn envelope(state: &str) -> String {
    let crc32 = crc32fast::hash(state.as_bytes());
    format!("{{\"format\":1,\"crc32\":\"{crc32:08x}\",\"state\":{state}}}\n")
}

#[test]
fn a_malformed_checkpoint_is_rejected() {
    let victim = Victim::new();
    let whole = victim.text("checkpoint.json");
    let says = |bytes: &[u8]| victim.says_with("checkpoint.json", bytes);
    let file = "checkpoint.json: ";
    assert_says(
        &says(&whole.as_bytes()[..whole.len() / 2]),
        &[file, "line 1, column", "at state: "],
    );
    assert_says(&says(b""), &[file, "line 1, column 0", "the text ends"]);
    assert_says(
        &says(b"\xff\xfe"),
        &[file, "found text in UTF-16; allowed: text in UTF-8"],
    );
    assert_says(
        &says((whole.clone() + "{}").as_bytes()),
        &[file, "line 2", "trailing characters"],
    );
    let other = whole.replacen("\"format\":1", "\"format\":2", 1);
    assert_says(
        &says(other.as_bytes()),
        &[file, "format: found 2; allowed: 1"],
    );
    let without = whole.replacen("\"format\":1,", "", 1);
    assert_says(&says(without.as_bytes()), &[file, "missing field `format`"]);
    let deep = format!(
        "{{\"format\":1,\"crc32\":\"\",\"state\":{}",
        "[".repeat(1_000_000)
    );
    assert_says(&says(deep.as_bytes()), &[file, "line 1, column"]);
    let deep = envelope(&format!(
        "{}{}",
        "[".repeat(1_000_000),
        "]".repeat(1_000_000)
    ));
    assert_says(&says(deep.as_bytes()), &[file, "line 1, column"]);
}

#[test]
fn a_changed_digit_of_a_learned_value_is_detected() {
    let victim = Victim::new();
    let mut bytes = victim.text("checkpoint.json").into_bytes();
    let learned = victim
        .text("checkpoint.json")
        .find("\"c_tilde\":[")
        .unwrap();
    let digit = (learned..bytes.len())
        .find(|&at| bytes[at].is_ascii_digit())
        .unwrap()
        + 3;
    bytes[digit] = if bytes[digit] == b'5' { b'6' } else { b'5' };
    let said = victim.says_with("checkpoint.json", &bytes);
    assert_says(
        &said,
        &[
            "checkpoint.json: crc32: the state has ",
            "changed or damaged",
        ],
    );
}

#[test]
fn numbers_that_are_not_finite_are_rejected_despite_a_correct_checksum() {
    let victim = Victim::new();
    let state = victim.state().to_string();
    let first =
        victim.state()["individuals"][0]["composites"][0]["children"][0]["c"][0].to_string();
    let begin = format!("\"c\":[{first}");
    assert!(state.contains(&begin));
    for hostile in [
        "NaN",
        "-Infinity",
        "1e999",
        "1e39",
        "-1e39",
        "null",
        "\"0\"",
        "[]",
    ] {
        let state = state.replacen(&begin, &format!("\"c\":[{hostile}"), 1);
        let said = victim.says_with("checkpoint.json", envelope(&state).as_bytes());
        assert_says(&said, &["checkpoint.json: line 1, column "]);
    }
}

#[test]
fn a_state_that_does_not_fit_its_scenario_is_rejected() {
    let victim = Victim::new();
    type Change = fn(&mut Value);
    let changes: &[(Change, &str)] = &[
        (
            |s| {
                s.as_object_mut().unwrap().remove("next_id");
            },
            "missing field `next_id`",
        ),
        (
            |s| s["surprise"] = json!(1),
            "at state.surprise: found the unknown field \"surprise\"",
        ),
        (
            |s| s["generation"] = json!(-1),
            "at state.generation: found -1; allowed: a whole number",
        ),
        (
            |s| s["generation"] = json!(u64::MAX),
            "state.generation: found 18446744073709551615; allowed: 0 to",
        ),
        (
            |s| s["next_id"] = json!(u64::MAX),
            "state.next_id: found 18446744073709551615; allowed: 0 to",
        ),
        (
            |s| s["control_steps"] = json!(u64::MAX),
            "state.control_steps: found 18446744073709551615",
        ),
        (
            |s| s["scenario"]["learning"]["discount"] = json!(2),
            "state.scenario: ",
        ),
        (
            |s| s["seed"] = json!(2),
            "run.json: seed: found 1; allowed: 2, as in checkpoint.json",
        ),
        (
            |s| s["scenario"]["name"] = json!("other"),
            "run.json: scenario: found another",
        ),
        (
            |s| {
                s["individuals"].as_array_mut().unwrap().pop();
            },
            "state.individuals: found 7; allowed: 8",
        ),
        (
            |s| s["individuals"][1]["tree"] = json!("(Root Wonder)"),
            "state.individuals[1].tree: at byte 6: found \"Wonder\"",
        ),
        (
            |s| s["individuals"][1]["tree"] = json!("(Root Turn)"),
            "state.individuals[1].tree: nothing can act",
        ),
        (
            |s| s["individuals"][1]["composites"] = json!([]),
            "state.individuals[1].composites (Root): allowed: ",
        ),
        (
            |s| s["individuals"][0]["composites"][0]["subtask"] = json!("Deliver"),
            "state.individuals[0].composites (Root)",
        ),
        (
            |s| {
                pop(&mut s["individuals"][0]["composites"][0]["children"]);
            },
            "state.individuals[0].composites (Root)",
        ),
        (
            |s| {
                pop(&mut s["individuals"][0]["composites"][0]["children"][0]["c"]);
            },
            "state.individuals[0].composites (Root): allowed: 128 numbers",
        ),
        (
            |s| {
                pop(&mut s["individuals"][0]["composites"][0]["children"][0]["c_tilde"]);
            },
            "composites (Root): allowed: 128 numbers",
        ),
        (
            |s| double_last(&mut s["individuals"][2]["composites"]),
            "state.individuals[2]: allowed: one entry in composites for each",
        ),
        (
            |s| s["individuals"][0]["composites"][0]["temperature"] = json!(0),
            "temperature: found 0; allowed: 0.05 to 2",
        ),
        (
            |s| s["individuals"][0]["composites"][0]["temperature"] = json!(-1),
            "temperature: found -1; allowed: 0.05 to 2",
        ),
        (
            |s| s["individuals"][0]["origin"] = json!({"kind": "stolen"}),
            "at state.individuals[0].origin",
        ),
        (
            |s| {
                pop(&mut s["primitives"]);
            },
            "state.primitives: allowed: each primitive subtask once",
        ),
        (
            |s| double_last(&mut s["primitives"]),
            "state.primitives: allowed: each primitive subtask once",
        ),
        (
            |s| s["primitives"][0]["subtask"] = json!("Fly"),
            "state.primitives[0]: found subtask \"Fly\"",
        ),
        (
            |s| s["primitives"][0]["subtask"] = json!("Root"),
            "state.primitives[0]: ",
        ),
        (
            |s| {
                pop(&mut s["primitives"][0]["actions"]);
            },
            "state.primitives[0]: allowed: 5 vectors of 32 numbers",
        ),
        (
            |s| {
                pop(&mut s["primitives"][0]["actions"][4]);
            },
            "state.primitives[0]: allowed: 5 vectors of 32 numbers",
        ),
        (
            |s| s["events"]["bytes"] = json!(1),
            "events.jsonl: found CRC-32 ",
        ),
        (
            |s| s["events"]["bytes"] = json!(u64::MAX),
            "events.jsonl: found ",
        ),
        (
            |s| s["events"]["crc32"] = json!(0),
            "events.jsonl: found CRC-32 ",
        ),
    ];
    for (change, says) in changes {
        assert_says(&victim.says_of_state(change), &[says]);
    }
}

fn pop(list: &mut Value) {
    list.as_array_mut().unwrap().pop().unwrap();
}

fn double_last(list: &mut Value) {
    let list = list.as_array_mut().unwrap();
    list.push(list.last().unwrap().clone());
}

#[test]
fn an_event_log_that_does_not_match_the_checkpoint_is_rejected() {
    let victim = Victim::new();
    let whole = victim.text("events.jsonl");
    let says = |bytes: &[u8]| victim.says_with("events.jsonl", bytes);
    let allowed = "allowed: a file that begins with the ";
    let shorter = whole.len() - 200;
    let said = says(&whole.as_bytes()[..shorter]);
    assert_says(
        &said,
        &[
            "events.jsonl: found ",
            &format!("{shorter} bytes; {allowed}"),
        ],
    );
    assert_says(&says(b""), &["events.jsonl: found 0 bytes", allowed]);
    let changed = whole.replacen("\"rank\":1", "\"rank\":9", 1);
    assert_says(
        &says(changed.as_bytes()),
        &["events.jsonl: found CRC-32", allowed],
    );
    fs::remove_file(victim.folder.join("events.jsonl")).unwrap();
    assert_says(&victim.says(), &["events.jsonl: ", "No such file"]);
    fs::remove_file(victim.folder.join("events.jsonl")).unwrap();
    fs::create_dir(victim.folder.join("events.jsonl")).unwrap();
    let said = refused(program().arg("resume").arg(&victim.folder));
    assert_says(&said, &["events.jsonl: ", "directory"]);
}

#[test]
fn a_line_that_is_no_event_is_rejected_despite_a_correct_checksum() {
    let victim = Victim::new();
    let whole = victim.text("events.jsonl");
    let first = whole.lines().next().unwrap();
    let long = format!("{first}\n{}", "x".repeat(1 << 20));
    for (log, says) in [
        (
            format!("{first}\n{{\"event\":\"nonsense\"}}\n"),
            "events.jsonl: line 2: found \"nonsense\"; allowed: ",
        ),
        (
            format!("{first}\n\n"),
            "events.jsonl: line 2: the text ends",
        ),
        (
            format!("{first}\n\0\n"),
            "events.jsonl: line 2: found no JSON value",
        ),
        (long + "\n", "events.jsonl: line 2: found no JSON value"),
        (
            format!("{first}\n{}\n", "[".repeat(100_000)),
            "events.jsonl: line 2: ",
        ),
        (
            first.replacen("\"format\":1", "\"format\":2", 1) + "\n",
            "events.jsonl: line 1: format: found 2; allowed: 1",
        ),
    ] {
        fs::write(victim.folder.join("events.jsonl"), &log).unwrap();
        let said = victim.says_of_state(|state| {
            let crc32 = crc32fast::hash(log.as_bytes());
            let lines = log.lines().count();
            state["events"] = json!({"lines": lines, "bytes": log.len(), "crc32": crc32});
        });
        assert_says(&said, &[says]);
    }
}

#[test]
fn a_damaged_run_json_is_rejected() {
    let victim = Victim::new();
    let whole = victim.text("run.json");
    let says = |text: &str| victim.says_with("run.json", text.as_bytes());
    assert_says(
        &says(&whole[..whole.len() / 2]),
        &["run.json: line ", ", at scenario."],
    );
    assert_says(&says(""), &["run.json: ", "the text ends"]);
    assert_says(
        &says(&(whole.clone() + "{}")),
        &["run.json: line ", ", at the end of the file: trailing"],
    );
    let other = whole.replacen("\"format\": 1", "\"format\": 7, \"new\": 1", 1);
    assert_says(&says(&other), &["run.json: format: found 7; allowed: 1"]);
    let other = whole.replacen("\"seed\": 1", "\"seed\": 3", 1);
    assert_says(&says(&other), &["run.json: seed: found 3; allowed: 1"]);
    let other = whole.replacen("\"discount\": 0.9", "\"discount\": 0.8", 1);
    assert_says(&says(&other), &["run.json: scenario: found another"]);
    let other = whole.replacen("\"discount\": 0.9", "\"discount\": 9", 1);
    assert_says(
        &says(&other),
        &["run.json: ", "learning.discount: found 9; allowed: 0 to 1"],
    );
    let other = whole.replacen("\"seed\"", "\"sead\"", 1);
    assert_says(
        &says(&other),
        &["run.json: line ", ", at sead: found the unknown field"],
    );
    fs::remove_file(victim.folder.join("run.json")).unwrap();
    assert_says(
        &victim.says(),
        &["holds no run.json; allowed: a run folder"],
    );
}

#[test]
fn a_rejected_resume_changes_nothing_that_is_needed_to_resume() {
    let victim = Victim::new();
    let expected = Record::of(&victim.folder);
    let lines: Vec<_> = victim
        .text("events.jsonl")
        .lines()
        .map(str::to_owned)
        .collect();
    victim.says_with("events.jsonl", lines[0].as_bytes());
    victim.says_of_state(|state| state["next_id"] = json!(u64::MAX));
    Record::of(&victim.folder).assert_same(&expected, "after refusals");
    let resumed = output(program().arg("resume").arg(&victim.folder));
    assert!(resumed.status.success());
    Record::of(&victim.folder).assert_same(&expected, "resumed after refusals");
}

#[test]
fn a_folder_without_a_run_is_rejected() {
    let parent = TempDir::new().unwrap();
    let resume = |path: &Path| refused(program().arg("resume").arg(path));
    let says = "holds no run.json; allowed: a run folder";
    assert_says(&resume(parent.path()), &[says]);
    assert_says(
        &resume(&parent.path().join("missing")),
        &["missing: ", says],
    );
    let file = parent.path().join("file");
    fs::write(&file, "x").unwrap();
    assert_says(&resume(&file), &["file: ", says]);
}

#[test]
fn the_generation_limit_cannot_be_below_the_finished_generations() {
    let victim = Victim::new();
    for limit in ["0", "1", "100001"] {
        let mut command = program();
        command
            .args(["resume", "--generations", limit])
            .arg(&victim.folder);
        let said = refused(&mut command);
        assert_says(
            &said,
            &[&format!("--generations: found {limit}; allowed: ")],
        );
    }
}
