//! Random keys, bursts of resizes, a terminal that accepts no output.

use maxq_lab::random::{Purpose, stream};
use rand::RngExt;

use crate::common::wait_until;
use crate::{Place, USER_STOP, wait_for_end, wait_for_good_end};

#[test]
fn random_keys_and_bursts_of_resizes_do_no_harm() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    let mut rng = stream(1, 0, 0, Purpose::Trials);
    for _ in 0..200 {
        let length = rng.random_range(1..40);
        // No keys that ask a question, which later random keys might answer. No Ctrl-Z.
        let rubbish: Vec<u8> = (0..length)
            .map(|_| rng.random_range(0..=255))
            .filter(|byte| ![3, b'q', b'X', b'T', b'e', 26].contains(byte))
            .collect();
        pty.send(&rubbish);
        pty.resize(rng.random_range(1..250), rng.random_range(1..80));
    }
    pty.resize(120, 40);
    // Leave whatever the random keys started or opened.
    pty.press("\u{1b}\u{1b}\u{1b}1");
    wait_until("the header", || pty.screen().contains("seed 1"));
    pty.press("q");
    pty.wait_for("Save the run and quit?");
    pty.press("y");
    wait_for_good_end(&mut pty, USER_STOP);
    place.assert_saved();
}

#[test]
fn a_terminal_that_accepts_no_output_blocks_neither_evolution_nor_keys_nor_signals() {
    let place = Place::new();
    let mut pty = place.start(&[]);
    pty.stall(true);
    // More frames than the terminal buffers.
    for _ in 0..20 {
        place.wait_for_evolution();
    }
    let pulse = || std::fs::read_to_string(place.folder.join("pulse.json")).unwrap_or_default();
    pty.press("p");
    wait_until("the pause", || pulse().contains("paused"));
    pty.press("p");
    wait_until("the end of the pause", || pulse().contains("running"));
    pty.stall(false);
    pty.wait_for("RUNNING");
    pty.stall(true);
    for _ in 0..20 {
        place.wait_for_evolution();
    }
    pty.signal("TERM");
    wait_for_end(&mut pty, 143);
    place.assert_saved();
    pty.stall(false);
}
