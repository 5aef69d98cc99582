//! Signals, and lines that drop.

use maxq_lab::lab::Checkpoint;
use portable_pty::CommandBuilder;

use crate::common::wait_until;
use crate::pty::{Pty, in_environment, program};
use crate::{ENDLESS, Place, exists, leave, wait_for_end, wait_for_good_end};

#[test]
fn a_signal_saves_the_run_and_gives_the_terminal_back() {
    for (signal, code) in [("TERM", 143), ("INT", 130)] {
        let place = Place::new();
        let mut pty = place.start(&[]);
        place.wait_for_evolution();
        pty.signal(signal);
        wait_for_good_end(&mut pty, code);
        place.assert_saved();
    }
}

#[test]
fn a_paused_run_hears_signals_too() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.press("p");
    pty.wait_for("PAUSED");
    pty.signal("TERM");
    wait_for_good_end(&mut pty, 143);
    place.assert_saved();
}

#[test]
fn when_the_line_drops_the_run_goes_on_to_its_end() {
    let place = Place::new();
    let mut arguments = place.run(&["evolution.variation=none"]);
    arguments.extend(["--set", "evolution.generation_limit=40"].map(String::from));
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let mut pty = Pty::start(120, 40, program(&arguments));
    pty.wait("the dashboard", Pty::is_taken);
    // Nobody could let it go on: what waits goes on when its person is cut off.
    pty.press("p");
    wait_until("the pulse", || exists(&place.folder, "pulse.json"));
    pty.hang_up();
    wait_for_end(&mut pty, 0);
    assert!(exists(&place.folder, "summary.json"));
}

#[test]
fn a_signal_that_says_that_the_line_dropped_is_believed() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.signal("HUP");
    pty.wait_given_back();
    place.wait_for_evolution();
    pty.signal("HUP");
    place.wait_for_evolution();
    let watch = place.on("watch");
    watch.wait_for("RUNNING");
    pty.signal("TERM");
    wait_for_end(&mut pty, 143);
    place.assert_saved();
    watch.wait_for("STOPPED");
}

#[test]
fn when_the_line_drops_the_run_is_saved_if_that_is_wanted() {
    let place = Place::new();
    let mut pty = place.start(&["--on-hangup", "stop"]);
    pty.hang_up();
    wait_for_end(&mut pty, 129);
    place.assert_saved();
}

#[test]
fn nobody_spins_when_the_terminal_has_gone() {
    let place = Place::new();
    let mut run = place.start(&[]);
    leave(&mut run);
    for command in ["replay", "watch"] {
        let mut pty = place.on(command);
        pty.wait_for("smoke");
        pty.hang_up();
        wait_for_end(&mut pty, 129);
    }
}

#[test]
fn a_run_without_a_dashboard_survives_the_line_too() {
    let place = Place::new();
    let arguments = [place.run(ENDLESS), vec![String::from("--headless")]].concat();
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    goes_on_without_a_line(Pty::start(120, 40, program(&arguments)), &place);
}

/// A run is told twice that its line is gone, goes on, and is ended by another signal.
fn goes_on_without_a_line(mut pty: Pty, place: &Place) {
    place.wait_for_evolution();
    pty.signal("HUP");
    pty.signal("HUP");
    place.wait_for_evolution();
    pty.signal("TERM");
    wait_for_end(&mut pty, 143);
    place.assert_saved();
}

#[test]
fn who_was_started_to_survive_a_line_that_drops_does_whatever_is_wanted_otherwise() {
    let place = Place::new();
    // What `nohup` does, and a shell that was told to.
    let mut command = CommandBuilder::new("/bin/sh");
    command.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]);
    command.arg(env!("CARGO_BIN_EXE_maxq-lab"));
    command.args(place.run(ENDLESS));
    command.args(["--headless", "--on-hangup", "stop"]);
    goes_on_without_a_line(Pty::start(120, 40, in_environment(command)), &place);
}

#[test]
fn two_signals_end_the_program_at_once_and_cost_no_more_than_the_generation_under_way() {
    for (first, second, codes) in [
        ("TERM", "TERM", [143, 143]),
        ("INT", "INT", [130, 130]),
        ("INT", "TERM", [130, 143]),
    ] {
        let place = Place::new();
        let mut pty = place.start(&[]);
        place.wait_for_evolution();
        pty.signal(first);
        pty.signal(second);
        let code = pty.ended().exit_code();
        assert!(codes.contains(&code), "{first}, {second}: {code}");
        pty.wait_given_back();
        if let Ok(text) = std::fs::read_to_string(place.folder.join("checkpoint.json")) {
            assert!(Checkpoint::from_text(&text).is_ok());
        }
        let mut pty = place.on("resume");
        pty.wait_for("RUNNING");
        place.wait_for_evolution();
        pty.signal("TERM");
        wait_for_end(&mut pty, 143);
        place.assert_saved();
    }
}

#[test]
fn a_signal_that_says_that_the_line_dropped_ends_the_run_if_that_is_wanted() {
    let place = Place::new();
    let mut pty = place.start(&["--on-hangup", "stop"]);
    place.wait_for_evolution();
    pty.signal("HUP");
    wait_for_good_end(&mut pty, 129);
    place.assert_saved();
}

#[test]
fn a_line_that_drops_in_the_middle_of_a_frame_leaves_the_run_alone() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.stall(true);
    // Whole frames, until the terminal has no room for the next.
    for columns in [200, 120].repeat(8) {
        pty.resize(columns, 60);
        place.wait_for_evolution();
    }
    pty.hang_up();
    place.wait_for_evolution();
    pty.signal("TERM");
    wait_for_end(&mut pty, 143);
    place.assert_saved();
}
