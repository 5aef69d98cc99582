//! Signals and lost terminals.

use maxq_lab::lab::Checkpoint;
use portable_pty::CommandBuilder;

use crate::common::wait_until;
use crate::pty::{Pty, in_environment, program};
use crate::{ENDLESS, Place, exists, leave, wait_for_end, wait_for_good_end};

#[test]
fn a_signal_saves_the_run_and_restores_the_terminal() {
    for (signal, code) in [("TERM", 143), ("INT", 130), ("QUIT", 131)] {
        let place = Place::new();
        let mut pty = place.start(&[]);
        place.wait_for_evolution();
        pty.signal(signal);
        wait_for_good_end(&mut pty, code);
        place.assert_saved();
    }
}

#[test]
fn a_paused_run_reacts_to_signals() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.press("p");
    pty.wait_for("PAUSED");
    pty.signal("TERM");
    wait_for_good_end(&mut pty, 143);
    place.assert_saved();
}

#[test]
fn a_run_that_loses_its_terminal_continues_to_its_end() {
    let place = Place::new();
    let mut arguments = place.run(&["evolution.variation=none"]);
    arguments.extend(["--set", "evolution.generation_limit=40"].map(String::from));
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let mut pty = Pty::start(120, 40, program(&arguments));
    pty.wait("the dashboard", Pty::is_taken);
    // A paused run continues, because nobody else could resume it.
    pty.press("p");
    wait_until("the pulse", || exists(&place.folder, "pulse.json"));
    pty.hang_up();
    wait_for_end(&mut pty, 0);
    assert!(exists(&place.folder, "summary.json"));
}

#[test]
fn sighup_alone_counts_as_a_lost_terminal() {
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
fn a_run_that_loses_its_terminal_is_saved_with_on_hangup_stop() {
    let place = Place::new();
    let mut pty = place.start(&["--on-hangup", "stop"]);
    pty.hang_up();
    wait_for_end(&mut pty, 129);
    place.assert_saved();
}

#[test]
fn no_command_spins_without_its_terminal() {
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
fn a_headless_run_survives_its_terminal_too() {
    let place = Place::new();
    let arguments = [place.run(ENDLESS), vec![String::from("--headless")]].concat();
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    continues_without_a_terminal(Pty::start(120, 40, program(&arguments)), &place);
}

/// Asserts that a run continues after two SIGHUPs and ends on another signal.
fn continues_without_a_terminal(mut pty: Pty, place: &Place) {
    place.wait_for_evolution();
    pty.signal("HUP");
    pty.signal("HUP");
    place.wait_for_evolution();
    pty.signal("TERM");
    wait_for_end(&mut pty, 143);
    place.assert_saved();
}

#[test]
fn an_ignored_sighup_stays_ignored_whatever_on_hangup_says() {
    let place = Place::new();
    // As `nohup` does.
    let mut command = CommandBuilder::new("/bin/sh");
    command.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]);
    command.arg(env!("CARGO_BIN_EXE_maxq-lab"));
    command.args(place.run(ENDLESS));
    command.args(["--headless", "--on-hangup", "stop"]);
    continues_without_a_terminal(Pty::start(120, 40, in_environment(command)), &place);
}

#[test]
fn two_signals_end_the_program_at_once_and_lose_at_most_the_current_generation() {
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
fn sighup_alone_ends_the_run_with_on_hangup_stop() {
    let place = Place::new();
    let mut pty = place.start(&["--on-hangup", "stop"]);
    place.wait_for_evolution();
    pty.signal("HUP");
    wait_for_good_end(&mut pty, 129);
    place.assert_saved();
}

#[test]
fn a_terminal_lost_in_the_middle_of_a_frame_does_not_harm_the_run() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.stall(true);
    // Whole frames, until the terminal accepts no more.
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
