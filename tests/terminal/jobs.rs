//! The shell's job control: Ctrl-Z, `fg`, `bg`.

use portable_pty::CommandBuilder;

use crate::pty::{Pty, in_environment};
use crate::{ENDLESS, Place, leave};

/// A shell with job control and an unmistakable prompt.
fn shell() -> Pty {
    let mut command = CommandBuilder::new("/bin/sh");
    command.arg("-i");
    let mut command = in_environment(command);
    command.env("PS1", "ready% ");
    command.env_remove("ENV");
    let pty = Pty::start(120, 40, command);
    pty.wait_for("ready%");
    pty
}

fn quoted(arguments: &[String]) -> String {
    let quoted: Vec<_> = arguments.iter().map(|one| format!("'{one}'")).collect();
    quoted.join(" ")
}

fn start_in_shell(place: &Place) -> Pty {
    let mut pty = shell();
    let program = env!("CARGO_BIN_EXE_maxq-lab");
    pty.press(&format!("{program} {}\n", quoted(&place.run(ENDLESS))));
    pty.wait_for("RUNNING");
    pty
}

#[test]
fn ctrl_z_gives_the_terminal_to_the_shell_and_fg_takes_it_back() {
    let place = Place::new();
    let mut pty = start_in_shell(&place);
    for _ in 0..2 {
        pty.press("\u{1a}");
        pty.wait_given_back();
        pty.press("echo it is $((40 + 2))\n");
        pty.wait_for("it is 42");
        let before = place.lines();
        pty.press("fg\n");
        pty.wait_for("RUNNING");
        assert!(pty.is_taken());
        crate::wait_until("evolution", || place.lines() > before);
    }
    pty.press("qy");
    pty.wait_given_back();
    pty.wait_for("resume with: maxq-lab resume");
    place.assert_saved();
}

#[test]
fn in_the_background_evolution_continues_and_the_shell_has_the_terminal() {
    let place = Place::new();
    let mut pty = start_in_shell(&place);
    pty.press("\u{1a}");
    pty.wait_given_back();
    pty.press("bg\n");
    place.wait_for_evolution();
    // The shell receives what is typed.
    pty.press("echo it is $((40 + 2))\n");
    pty.wait_for("it is 42");
    place.wait_for_evolution();
    pty.press("jobs\n");
    pty.wait_for("Running");
    pty.press("fg\n");
    pty.wait_for("RUNNING");
    pty.press("p");
    pty.wait_for("PAUSED");
    pty.press("qy");
    pty.wait_for("resume with: maxq-lab resume");
    pty.wait_given_back();
    place.assert_saved();
}

#[test]
fn started_in_the_background_the_dashboard_waits_for_the_terminal_but_evolution_does_not() {
    let place = Place::new();
    let mut pty = shell();
    let program = env!("CARGO_BIN_EXE_maxq-lab");
    pty.press(&format!("{program} {} &\n", quoted(&place.run(ENDLESS))));
    place.wait_for_evolution();
    pty.press("echo it is $((40 + 2))\n");
    pty.wait_for("it is 42");
    assert!(!pty.is_taken());
    pty.press("fg\n");
    pty.wait_for("RUNNING");
    pty.press("qy");
    pty.wait_for("resume with: maxq-lab resume");
    pty.wait_given_back();
}

#[test]
fn after_sigstop_and_sigcont_a_whole_frame_is_drawn() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.press("p");
    pty.wait_for("PAUSED");
    pty.signal("STOP");
    let before = pty.bytes();
    pty.signal("CONT");
    pty.wait("a whole frame", |pty| pty.bytes() > before + 1000);
    leave(&mut pty);
}

#[test]
fn without_a_shell_that_could_continue_it_the_program_does_not_stop() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.press("\u{1a}");
    pty.wait_for("no shell is there");
    place.wait_for_evolution();
    pty.signal("TSTP");
    place.wait_for_evolution();
    leave(&mut pty);
}
