//! The table of a study's runs: opened, gone into, come back from, left.

use std::path::Path;
use std::process::{Child, Stdio};

use maxq_lab::report::{Arm, Base, Plan, Study};

use crate::common::{SHORT, program as plain_program};
use crate::pty::{Pty, program};
use crate::{ENDLESS, wait_for_end};

/// A study of one run with settings, done by another process.
fn study(settings: &[&str], folder: &str) -> Child {
    let settings = SHORT.iter().chain(settings).copied().map(String::from);
    let arm = Arm {
        settings: settings.collect(),
        ..Arm::of(Base::Evolved)
    };
    let plan = Plan::of(&[String::from("smoke")], "1".parse().unwrap(), vec![arm]).unwrap();
    Study::create(plan, Path::new(folder)).unwrap();
    let mut command = plain_program();
    command.args(["study", &format!("{folder}/study.json")]);
    command.args(["--headless", "--jobs", "1", "--out", folder]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

#[test]
fn a_run_that_is_done_is_replayed_and_come_back_from() {
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
    wait_for_end(&mut pty, 0);
    pty.wait_given_back();
}

#[test]
fn a_run_that_goes_on_is_watched_until_it_is_broken_off() {
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
    pty.wait_for("1 broken off");
    pty.press("\u{3}");
    wait_for_end(&mut pty, 0);
    pty.wait_given_back();
}

#[test]
fn a_folder_without_a_study_is_refused_before_the_screen_is_taken() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().to_str().unwrap();
    let mut pty = Pty::start(80, 24, program(&["study", "watch", folder]));
    pty.wait_for("holds no study.json");
    wait_for_end(&mut pty, 1);
    pty.wait_given_back();
}
