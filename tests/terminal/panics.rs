//! A panic in any thread: the terminal is given back first, then the panic is reported.
//!
//! The program has no way to be made to panic, so a test plays the program: it starts this
//! test binary again, inside a terminal, with one test to be carried out.

use std::thread;

use maxq_lab::dashboard::terminal::Terminal;
use portable_pty::CommandBuilder;

use crate::pty::{Pty, in_environment};

/// Says that this process is the one that panics, and where.
const WHERE: &str = "MAXQ_LAB_TEST_PANICS_IN";

#[test]
fn a_panic_gives_the_terminal_back() {
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
    let mut terminal = Terminal::open(true).unwrap();
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
