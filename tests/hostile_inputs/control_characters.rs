//! Text from files and arguments must not control the terminal of its reader: control
//! characters are escaped on standard output and standard error.

use std::fs;

use super::common::{output, program, short, threads};
use super::{assert_no_controls, assert_says, check, fixture, refused, refused_with};

/// ESC, the one-character CSI, BEL, CR, backspace, DEL and a form feed.
const HOSTILE: &str = "x\u{1b}[31m\u{9b}2J\u{7}\r\u{8}\u{7f}\u{c}";

#[test]
fn keys_names_and_trees_of_files_are_escaped() {
    for (name, shown) in [
        (
            "control-characters-in-a-key.json",
            "evo\\u{1b}[31m\\u{9b}2J\\u{7}\\u{d}lution",
        ),
        (
            "control-characters-in-the-name.json",
            "\\u{1b}[2J\\u{9b}31m\\u{7}\\rvalid",
        ),
        (
            "control-characters-in-a-tree.json",
            "\\u{1b}[31m\\u{9b}2J\\u{7}",
        ),
    ] {
        let said = refused(&mut check(&fixture(name)));
        assert_says(&said, &[name, shown]);
        // JSON reports the errors on standard output, escaped.
        let json = output(
            program()
                .args(["check", "--format", "json"])
                .arg(fixture(name)),
        );
        assert_eq!(json.status.code(), Some(1));
        assert_no_controls(&json);
        let report: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
        assert_eq!(report[0]["valid"], false);
    }
}

#[test]
fn arguments_are_escaped() {
    let tree = format!("(Root {HOSTILE})");
    let setting = format!("learning.{HOSTILE}=1");
    for arguments in [
        &["check", HOSTILE][..],
        &["run", HOSTILE],
        &["run", "smoke", "--set", &setting],
        &["run", "smoke", "--set", HOSTILE],
        &["resume", HOSTILE],
        &["scenarios", HOSTILE],
        &["evaluate", "smoke", "--tree", &tree],
        &["evaluate", HOSTILE, "--tree", "(Root)"],
        &["tree", "show", &tree],
        &["tree", "check", HOSTILE],
        &["tree", "diff", &tree, &tree],
        &["tree", "dot", &tree],
    ] {
        refused(program().args(arguments));
    }
    let option = format!("--{HOSTILE}");
    for arguments in [
        &[HOSTILE][..],
        &[&option],
        &["run", "smoke", &option],
        &["run", "smoke", "--seed", HOSTILE],
        &["run", "smoke", "--keep", HOSTILE],
        &["run", "smoke", "--format", HOSTILE],
        &["tree", HOSTILE],
        &["completions", HOSTILE],
    ] {
        refused_with(2, program().args(arguments));
    }
}

#[test]
fn paths_and_descriptions_are_escaped() {
    let parent = tempfile::tempdir().unwrap();
    let strange = parent.path().join(HOSTILE);
    fs::create_dir(&strange).unwrap();

    // A valid file whose folder and description have control characters.
    let mut scenario = short(&["evolution.generation_limit=1"]);
    scenario.description = String::from(HOSTILE);
    let file = strange.join("scenario.json");
    fs::write(&file, serde_json::to_vec(&scenario).unwrap()).unwrap();
    let checked = output(&mut check(&file));
    assert!(checked.status.success());
    assert_no_controls(&checked);

    // A run in such a folder: its result, its rejection, its resumption.
    let out = strange.join("run");
    for format in ["text", "json"] {
        let run = output(
            program()
                .arg("run")
                .arg(&file)
                .arg("--out")
                .arg(&out)
                .args(["--force", "--format", format]),
        );
        assert!(run.status.success());
        assert_no_controls(&run);
    }
    refused(program().arg("run").arg(&file).arg("--out").arg(&out));
    assert_no_controls(&output(program().arg("resume").arg(&out)));
    fs::write(out.join("checkpoint.json"), "{").unwrap();
    refused(program().arg("resume").arg(&out));
    fs::remove_file(out.join("run.json")).unwrap();
    refused(program().arg("resume").arg(&out));
}

#[test]
fn keys_and_trees_of_a_run_folder_are_escaped() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    super::common::run_in(&folder, &short(&[]), 1, &threads(2));
    let escaped = serde_json::to_string(HOSTILE).unwrap();
    for file in ["run.json", "checkpoint.json"] {
        let path = folder.join(file);
        let whole = fs::read(&path).unwrap();
        fs::write(&path, format!("{{\"format\": 1, {escaped}: {escaped}}}")).unwrap();
        assert_says(
            &refused(program().arg("resume").arg(&folder)),
            &[file, "\\u{1b}[31m"],
        );
        fs::write(&path, whole).unwrap();
    }
}
