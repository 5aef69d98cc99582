//! Runs of other processes, earlier runs, and every built-in scenario.

use std::process::{Child, Stdio};

use maxq_lab::scenario::EMBEDDED;

use crate::common::program as plain_program;
use crate::pty::{Pty, program};
use crate::{ENDLESS, Place, leave, wait_for_end, wait_for_good_end, wait_until};

fn headless(place: &Place) -> Child {
    let mut command = plain_program();
    command.args(place.run(ENDLESS)).arg("--headless");
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

#[test]
fn a_run_is_watched_from_before_its_start_until_it_is_killed() {
    let place = Place::new();
    let mut pty = place.on("watch");
    pty.wait_for("waiting for a run");
    let mut run = headless(&place);
    pty.wait_for("RUNNING");
    let first = Place::generation(&pty);
    pty.wait("more generations", |pty| Place::generation(pty) > first);
    pty.press("p");
    pty.wait_for("watched, not steered");
    run.kill().unwrap();
    run.wait().unwrap();
    pty.wait_for("STOPPED");
    let mut resumed = plain_program();
    resumed.args(["resume", "--headless"]).arg(&place.folder);
    resumed.stdout(Stdio::null()).stderr(Stdio::null());
    let mut resumed = resumed.spawn().unwrap();
    pty.wait_for("RUNNING");
    pty.press("q");
    wait_for_good_end(&mut pty, 0);
    // Watching had no effect on the run.
    place.wait_for_evolution();
    resumed.kill().unwrap();
    resumed.wait().unwrap();
}

#[test]
fn waiting_for_a_run_can_be_cancelled() {
    let place = Place::new();
    let mut pty = place.on("watch");
    pty.wait_for("waiting for a run");
    pty.press("\u{3}");
    wait_for_good_end(&mut pty, 130);
}

#[test]
fn a_killed_run_is_replayed() {
    let place = Place::new();
    let mut run = headless(&place);
    wait_until("generations", || place.lines() > 4);
    run.kill().unwrap();
    run.wait().unwrap();
    let mut pty = place.on("replay");
    pty.wait_for("UNFINISHED");
    let last = place.lines() as u64 - 1;
    pty.wait("the last generation", |pty| {
        Place::generation(pty) == Some(last)
    });
    pty.press("[");
    pty.wait("the one before", |pty| {
        Place::generation(pty) == Some(last - 1)
    });
    pty.press("q");
    wait_for_good_end(&mut pty, 0);
}

#[test]
fn a_view_without_motion_sends_nothing() {
    let place = Place::new();
    let mut run = place.start(&[]);
    leave(&mut run);
    let mut pty = place.on("replay");
    pty.wait_for("UNFINISHED");
    pty.press(" ");
    // Messages disappear after a while, so silence begins later.
    let mut last = (pty.bytes(), std::time::Instant::now());
    pty.wait("two seconds of silence", |pty| {
        if pty.bytes() != last.0 {
            last = (pty.bytes(), std::time::Instant::now());
        }
        last.1.elapsed().as_secs() >= 2
    });
    pty.press("q");
    wait_for_end(&mut pty, 0);
}

#[test]
fn every_built_in_scenario_has_a_dashboard() {
    for embedded in EMBEDDED {
        let place = Place::new();
        let mut pty = Pty::start(
            120,
            40,
            program(&["run", embedded.name, "--out", place.text()]),
        );
        pty.wait_for(embedded.name);
        pty.wait("generation 1", |pty| Place::generation(pty) >= Some(1));
        for view in ["2", "3", "4", "5", "6", "1"] {
            pty.press(view);
        }
        pty.signal("TERM");
        let code = pty.ended().exit_code();
        assert!([0, 143].contains(&code), "{}: {code}", embedded.name);
        pty.wait_given_back();
    }
}
