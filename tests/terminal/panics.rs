//! A panic in any thread: the terminal is restored first, then the panic is reported.
//!
//! Nothing makes the program panic, so a test stands in for it: the test binary starts itself
//! inside a terminal, with one test to run.

use std::thread;

use maxq_lab::dashboard::terminal::Terminal;
use portable_pty::CommandBuilder;

use crate::pty::{Pty, in_environment};

/// The variable that tells a process to panic, and where.
const WHERE: &str = "MAXQ_LAB_TEST_PANICS_IN";

#[test]
fn a_panic_restores_the_terminal() {
    if std::env::var_os(WHERE).is_some() {
        return;
    }
    for place in ["main", "thread"] {
        let mut command = CommandBuilder::new(std::env::current_exe().unwrap());
        command.args(["--exact", "panics::the_process_that_panics", "--nocapture"]);
        let mut command = in_environment(command);
        command.env(WHERE, place);
        let mut pty = Pty::start(120, 40, command);
        pty.wait("the screen and back", |pty| {
            let raw = pty.raw();
            let has = |bytes: &[u8]| raw.windows(bytes.len()).any(|window| window == bytes);
            has(b"\x1b[?1049h") && has(b"\x1b[?1049l")
        });
        pty.wait_for(&format!("a defect in {place}"));
        pty.ended();
        pty.wait_given_back();
    }
}

#[test]
fn the_process_that_panics() {
    let Ok(place) = std::env::var(WHERE) else {
        return;
    };
    let mut terminal = Terminal::open(true, false).unwrap();
    terminal.show().unwrap();
    let draw = |frame: &mut ratatui::Frame<'_>| frame.render_widget("a frame", frame.area());
    terminal.draw(draw).unwrap();
    if place == "main" {
        panic!("a defect in main");
    }
    let thread = thread::spawn(|| panic!("a defect in thread"));
    assert!(thread.join().is_err());
    assert!(terminal.is_closed());
    assert!(terminal.show().is_err());
}
