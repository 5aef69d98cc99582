//! A session: start, pause, step, resize, quit.

use std::thread::sleep;
use std::time::Duration;

use maxq_lab::dashboard::terminal::LARGEST_SIDE;

use crate::pty::{Pty, program};
use crate::{ENDLESS, Place, USER_STOP, exists, leave, wait_for_end, wait_for_good_end};

#[test]
fn a_run_is_paused_stepped_quit_and_resumed() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.wait("a generation", |pty| Place::generation(pty).is_some());
    pty.press("p");
    pty.wait_for("PAUSED");
    let before = Place::generation(&pty).unwrap();
    let lines = place.lines();
    pty.press("n");
    pty.wait("the next generation", |pty| {
        Place::generation(pty) == Some(before + 1) && pty.screen().contains("PAUSED")
    });
    assert_eq!(place.lines(), lines + 1);
    pty.press("6");
    pty.wait_for("rank");
    pty.press("?");
    pty.wait_for("Help");
    pty.press("\u{1b}");
    pty.wait_gone("Help");
    pty.press("q");
    pty.wait_for("Save the run and quit?");
    pty.press("n");
    pty.wait_gone("Save the run and quit?");
    leave(&mut pty);
    pty.wait_for("resume with: maxq-lab resume");
    place.assert_saved();

    let mut pty = place.on("resume");
    pty.wait("the run to continue", |pty| {
        Place::generation(pty) > Some(before + 1)
    });
    pty.press("\u{3}y");
    wait_for_good_end(&mut pty, USER_STOP);
    place.assert_saved();
}

#[test]
fn the_dashboard_follows_the_size_of_the_window() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    for (columns, rows) in [(80, 24), (200, 60), (120, 40)] {
        pty.resize(columns, rows);
        // The hints are on the last line of any size.
        let hints = |pty: &Pty| pty.screen().contains("q quit");
        pty.wait(&format!("{columns}x{rows}"), |pty| {
            hints(pty) && pty.screen().contains("RUNNING")
        });
    }
    pty.resize(20, 5);
    pty.wait_for("too small");
    pty.resize(120, 40);
    pty.wait_for("RUNNING");
    leave(&mut pty);
}

#[test]
fn a_terminal_of_an_absurd_size_is_drawn_to_in_its_top_left_corner() {
    let place = Place::new();
    let arguments = place.run(ENDLESS);
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let mut pty = Pty::start(u16::MAX, u16::MAX, program(&arguments));
    pty.wait_for("RUNNING");
    pty.resize(120, 40);
    pty.wait("a frame of the new size", |pty| {
        pty.screen().lines().count() == 40
    });
    pty.resize(u16::MAX, u16::MAX);
    pty.wait("a frame of the largest size", |pty| {
        pty.screen().lines().count() == usize::from(LARGEST_SIDE)
    });
    leave(&mut pty);
    place.assert_saved();
}

#[test]
fn replies_of_the_terminal_and_pasted_text_are_not_keys() {
    let place = Place::new();
    let parent = place.folder.parent().unwrap();
    let arguments = place.run(ENDLESS);
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let mut command = program(&arguments);
    command.cwd(parent);
    let mut pty = Pty::start(120, 40, command);
    pty.wait_for("RUNNING");
    pty.press("6");
    pty.wait_for("rank");
    for reads in [
        &["\u{1b}]11;rgb:ecec/eaea/e4e4\u{1b}\\"][..],
        &["\u{1b}]11;rgb:ecec/", "eaea/e4e4\u{7}"],
        &["\u{1b}P>|tmux 3.5a\u{1b}", "\\"],
        &["\u{1b}", "[?6c"],
        &["\u{1b}[?6", "2;1c\u{1b}[24;80R"],
        &["\u{1b}[200~pe3", "c\rq\u{1b}", "[201~"],
    ] {
        for read in reads {
            pty.press(read);
            sleep(Duration::from_millis(20));
        }
    }
    pty.press("?");
    pty.wait_for("Help");
    // A lone ESC is still a key.
    pty.press("\u{1b}");
    pty.wait_gone("Help");
    let screen = pty.screen();
    assert!(
        screen.contains("RUNNING") && screen.contains("rank"),
        "{screen}"
    );
    let files = parent.read_dir().unwrap();
    assert_eq!(files.count(), 1, "only the run folder");
    leave(&mut pty);
    place.assert_saved();
}

#[test]
fn a_finished_run_stays_on_the_screen_and_its_result_is_printed_on_quit() {
    let place = Place::new();
    let arguments = place.run(&["evolution.generation_limit=3"]);
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    let mut pty = Pty::start(120, 40, program(&arguments));
    pty.wait_for("FINISHED");
    pty.press("q");
    wait_for_good_end(&mut pty, 0);
    pty.wait_for("best individual");
    assert!(exists(&place.folder, "summary.json"));
}

#[test]
fn the_mouse_is_captured_on_request_and_released() {
    let place = Place::new();
    let mouse = |pty: &Pty| pty.raw().windows(8).any(|bytes| bytes == b"\x1b[?1006h");
    let mut pty = place.start(&["--mouse"]);
    assert!(mouse(&pty));
    pty.press("\u{1b}[<65;10;10M");
    leave(&mut pty);

    let place = Place::new();
    let mut pty = place.start(&[]);
    assert!(!mouse(&pty));
    pty.signal("TERM");
    wait_for_end(&mut pty, 143);
}

#[test]
fn a_run_is_handed_over_to_a_background_process() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.press("q");
    pty.wait_for("let the run continue without a terminal");
    pty.press("d");
    wait_for_good_end(&mut pty, 0);
    pty.wait_for("continues the run");
    let screen = pty.screen();
    let before = screen.split(" continues the run").next().unwrap();
    let process: u32 = before.rsplit(' ').next().unwrap().parse().unwrap();
    pty.hang_up();
    place.wait_for_evolution();
    crate::pty::signal("TERM", process);
    crate::wait_until("the end", || !exists(&place.folder, "pulse.json"));
    place.assert_saved();
}

#[test]
fn an_invalid_theme_or_key_map_is_reported_before_anything_is_computed() {
    let place = Place::new();
    for wrong in [
        &["--theme", "pink"][..],
        &["--fps", "0"],
        &["--config", "/nowhere.toml"],
    ] {
        let arguments = place.run(ENDLESS);
        let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
        let mut pty = Pty::start(120, 40, program(&[&arguments, wrong].concat()));
        assert_ne!(pty.ended().exit_code(), 0);
        pty.wait_for(wrong[1]);
        pty.wait_given_back();
        assert!(!place.folder.exists());
    }
}

/// The colours of text in the themes `dark` and `light`, as they are sent.
const DARK: &[u8] = b"38;5;252";
const LIGHT: &[u8] = b"38;5;235";

#[test]
fn the_theme_suits_the_background_of_the_terminal() {
    let place = Place::new();
    maxq_lab::lab::start(
        crate::common::short(&[]),
        1,
        &place.folder,
        &crate::common::threads(1),
    )
    .unwrap()
    .join()
    .unwrap();
    let bright = "\u{1b}]11;rgb:ffff/ffff/ffff\u{1b}\\\u{1b}[?62c";
    let black = "\u{1b}]11;rgb:0000/0000/0000\u{7}\u{1b}[?62c";
    // The answer, the hint of the environment, an option, and the colour of text.
    for (answer, hint, option, text) in [
        (bright, "15;0", None, LIGHT),
        (black, "0;15", None, DARK),
        ("\u{1b}[?62c", "", None, DARK),
        ("\u{1b}[?62c", "0;15", None, LIGHT),
        ("", "0;15", None, LIGHT),
        (bright, "", Some("--theme=dark"), DARK),
    ] {
        let arguments: Vec<_> = ["replay", place.text()].into_iter().chain(option).collect();
        let mut command = program(&arguments);
        command.env("COLORFGBG", hint);
        let mut pty = Pty::answering(120, 40, command, answer);
        pty.wait_for("REPLAY");
        let raw = pty.raw();
        let has = |colour: &[u8]| raw.windows(colour.len()).any(|part| part == colour);
        assert!(has(text), "{answer:?} {hint:?} {option:?}");
        assert_eq!(has(DARK), text == DARK, "{answer:?} {hint:?} {option:?}");
        pty.press("q");
        wait_for_good_end(&mut pty, 0);
    }
}

#[test]
fn a_late_answer_and_keys_pressed_before_the_first_frame_do_no_harm() {
    let place = Place::new();
    let arguments = place.run(ENDLESS);
    let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
    // Typed while the terminal is asked: the help opens.
    let mut pty = Pty::answering(120, 40, program(&arguments), "?\u{1b}[?62c");
    pty.wait_for("Help");
    pty.press("\u{1b}");
    pty.wait_gone("Help");
    pty.send(b"\x1b]11;rgb:ecec/eaea/e4e4\x1b\\\x1b[?62c");
    pty.press("?");
    pty.wait_for("Help");
    pty.press("\u{1b}");
    pty.wait_gone("Help");
    leave(&mut pty);
}
