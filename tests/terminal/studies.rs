//! The table of the runs of a study.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};

use maxq_lab::report::{Arm, Base, Plan, Study};

use crate::common::{SHORT, program as plain_program};
use crate::pty::{Pty, program};
use crate::{ENDLESS, USER_STOP, wait_for_end, wait_for_good_end, wait_until};

/// Creates a study with one arm that has settings.
fn create(settings: &[&str], seeds: &str, folder: &str) -> Study {
    let settings = SHORT.iter().chain(settings).copied().map(String::from);
    let arm = Arm {
        settings: settings.collect(),
        ..Arm::of(Base::Evolved)
    };
    let plan = Plan::of(&[String::from("smoke")], seeds.parse().unwrap(), vec![arm]).unwrap();
    Study::create(plan, Path::new(folder)).unwrap()
}

/// Another process that does a study of one run with settings.
fn study(settings: &[&str], folder: &str) -> Child {
    create(settings, "1", folder);
    let mut command = plain_program();
    command.args(["study", &format!("{folder}/study.json")]);
    command.args(["--headless", "--jobs", "1", "--out", folder]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

#[test]
fn a_finished_run_is_replayed_and_closed() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("study");
    let folder = folder.to_str().unwrap();
    assert!(study(&[], folder).wait().unwrap().success());
    let mut pty = Pty::start(120, 40, program(&["study", "watch", folder]));
    pty.wait_for("1 done");
    assert!(pty.is_taken());
    for leave in ["q", "\u{1b}"] {
        pty.press("\r");
        pty.wait_for("REPLAY");
        pty.press(leave);
        pty.wait_for("1 done");
        assert!(pty.is_taken());
    }
    pty.resize(80, 24);
    pty.wait_for("1 done");
    pty.press("q");
    wait_for_good_end(&mut pty, 0);
}

#[test]
fn a_running_run_is_watched_until_it_is_killed() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("study");
    let folder = folder.to_str().unwrap();
    let mut runs = study(ENDLESS, folder);
    let mut pty = Pty::start(120, 40, program(&["study", "watch", folder]));
    pty.wait_for("1 running");
    pty.press("\r");
    pty.wait_for("WATCHING");
    runs.kill().unwrap();
    runs.wait().unwrap();
    pty.wait_for("STOPPED");
    pty.press("q");
    pty.wait_for("1 interrupted");
    pty.press("\u{3}");
    wait_for_good_end(&mut pty, 0);
}

#[test]
fn a_folder_without_a_study_is_rejected_before_the_screen_is_taken() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().to_str().unwrap();
    let mut pty = Pty::start(80, 24, program(&["study", "watch", folder]));
    pty.wait_for("holds no study.json");
    wait_for_good_end(&mut pty, 1);
}

/// The bytes of a study are the same, however often it is interrupted and resumed.
#[test]
fn a_study_is_interrupted_and_resumed() {
    let parent = tempfile::tempdir().unwrap();
    let folder = |name: &str| parent.path().join(name).display().to_string();
    let (shown, whole) = (folder("shown"), folder("whole"));
    create(&[], "1..20", &shown);
    let study = create(&[], "1..20", &whole);
    let start = |size: (u16, u16)| {
        let arguments = ["study", &shown, "--jobs", "1"];
        Pty::start(size.0, size.1, program(&arguments))
    };
    let mut pty = start((80, 24));
    let second = Path::new(&shown).join(study.name(&study.runs()[1]));
    wait_until("the second run", || second.join("run.json").exists());
    pty.signal("TERM");
    wait_for_good_end(&mut pty, 143);
    pty.wait_for("the same command to resume");

    let mut pty = start((120, 40));
    pty.wait_for("20 done");
    pty.wait_for("DONE");
    assert!(pty.is_taken(), "the table stays when all runs are done");
    // Nothing is left to stop.
    pty.press("q");
    wait_for_end(&mut pty, 0);
    pty.wait_for("20 of 20 runs done");

    let headless = ["study", &whole, "--headless"];
    assert!(plain_program().args(headless).status().unwrap().success());
    for run in study.runs() {
        for file in ["events.jsonl", "checkpoint.json", "evaluation.json"] {
            let of = |folder: &str| fs::read(Path::new(folder).join(study.name(&run)).join(file));
            assert!(of(&shown).unwrap() == of(&whole).unwrap(), "{file}");
        }
    }
}

#[test]
fn quitting_a_study_asks_whether_to_stop_it() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("study").display().to_string();
    create(ENDLESS, "1", &folder);
    let start = || Pty::start(80, 24, program(&["study", &folder, "--jobs", "1"]));
    let mut pty = start();
    pty.wait_for("1 running");
    pty.press("\r");
    pty.wait_for("WATCHING");
    pty.press("q");
    pty.wait_for("1 running");
    pty.press("q");
    pty.wait_for("Stop them?");
    pty.press("n");
    pty.wait_gone("Stop them?");
    pty.press("q");
    pty.wait_for("Stop them?");
    pty.press("y");
    wait_for_good_end(&mut pty, USER_STOP);
    pty.wait_for("0 of 1 runs done");

    let mut pty = start();
    pty.wait_for("1 running");
    pty.press("q");
    pty.wait_for("continue with a progress bar");
    pty.press("d");
    pty.wait_given_back();
    pty.wait_for("0/1");
    pty.signal("HUP");
    let status = || {
        let mut command = plain_program();
        let output = command.args(["study", "status", &folder]).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(
        status().contains("1 running"),
        "a lost terminal stops nothing"
    );
    pty.signal("TERM");
    wait_for_end(&mut pty, 143);
    assert!(status().contains("1 interrupted"));
}

#[test]
fn the_error_of_a_failed_run_is_shown_in_the_table_and_at_the_end() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("study").display().to_string();
    let study = create(&[], "1", &folder);
    let run = study.run_folder(&study.runs()[0]);
    fs::create_dir_all(run.parent().unwrap()).unwrap();
    fs::write(&run, "not a folder").unwrap();
    let mut pty = Pty::start(120, 40, program(&["study", &folder]));
    pty.wait_for("1 failed");
    pty.press("\r");
    pty.wait_for("error: smoke/evolved/seed-1: ");
    pty.press("q");
    wait_for_good_end(&mut pty, 1);
    pty.wait_for("0 of 1 runs done");
}
