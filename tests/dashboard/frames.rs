//! Snapshots of every view: the characters, and below them a letter for the style of each.

use std::fmt::Write;

use maxq_lab::dashboard::Mode;
use maxq_lab::hierarchy::Glyphs::{self, Ascii, Unicode};
use maxq_lab::lab::Event;
use ratatui::buffer::{Buffer, Cell};

use super::recorded::{Recorded, Screen, cells, foraging};

/// The characters of a frame, then a letter for the style of each, then the meaning of the
/// letters.
fn with_styles(frame: &Buffer) -> String {
    let mut styles: Vec<String> = Vec::new();
    let (mut characters, mut letters) = (String::new(), String::new());
    for row in frame.content.chunks(usize::from(frame.area.width).max(1)) {
        let line: String = row.iter().map(Cell::symbol).collect();
        let _ = writeln!(characters, "|{line}|");
        letters.push('|');
        for cell in row {
            let style = format!("{} on {} {:?}", cell.fg, cell.bg, cell.modifier);
            let index = styles.iter().position(|known| *known == style);
            let index = index.unwrap_or_else(|| {
                styles.push(style);
                styles.len() - 1
            });
            letters.push(char::from(
                b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"[index],
            ));
        }
        letters.push_str("|\n");
    }
    let legend = styles.iter().enumerate();
    let legend: String = legend
        .map(|(index, style)| {
            format!(
                "{} {style}\n",
                char::from(b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"[index])
            )
        })
        .collect();
    format!("{characters}\n{letters}\n{legend}")
}

#[track_caller]
pub fn assert_looks(name: &str, screen: &Screen) {
    assert_frame(name, &screen.0.app().frame());
}

#[track_caller]
pub fn assert_frame(name: &str, frame: &Buffer) {
    insta::with_settings!({
        snapshot_path => "../../snapshots",
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        insta::assert_snapshot!(format!("frame_{name}"), with_styles(frame));
    });
}

pub const SMALL: (u16, u16) = (80, 24);
pub const MIDDLE: (u16, u16) = (120, 40);
pub const LARGE: (u16, u16) = (200, 60);

/// Name, theme, signs and size of a frame, and the keys that lead to it.
pub type Shot = (&'static str, &'static str, Glyphs, (u16, u16), &'static str);

/// Checks frames of a run: `seconds` are waited before and after the keys.
pub fn assert_shots(run: &Recorded, [before, after]: [f64; 2], shots: &[Shot]) {
    for (name, theme, glyphs, size, keys) in shots {
        let mut screen = run.screen(theme, *glyphs, *size);
        screen.wait(before);
        screen.press(keys);
        screen.wait(after);
        assert_looks(name, &screen);
    }
}

#[test]
fn the_overview() {
    let shots = [
        ("overview_80x24_dark", "dark", Unicode, SMALL, ""),
        ("overview_120x40_dark", "dark", Unicode, MIDDLE, ""),
        ("overview_200x60_dark", "dark", Unicode, LARGE, ""),
        ("overview_120x40_mono", "mono", Unicode, MIDDLE, ""),
        ("overview_80x24_ascii", "mono", Ascii, SMALL, ""),
        ("overview_200x60_ascii", "light", Ascii, LARGE, ""),
    ];
    assert_shots(foraging(), [2.0, 0.0], &shots);
}

#[test]
fn the_views() {
    let shots = [
        ("arena_80x24_dark", "dark", Unicode, SMALL, "2"),
        ("arena_120x40_mono", "mono", Unicode, MIDDLE, "2"),
        ("arena_80x24_ascii", "high-contrast", Ascii, SMALL, "2"),
        ("hierarchy_80x24_dark", "dark", Unicode, SMALL, "3"),
        ("hierarchy_120x40_ascii", "mono", Ascii, MIDDLE, "3"),
        ("fitness_80x24_dark", "dark", Unicode, SMALL, "4"),
        ("fitness_120x40_ascii", "mono", Ascii, MIDDLE, "4 [ ["),
        ("policy_80x24_mono", "mono", Unicode, SMALL, "5"),
        ("policy_200x60_dark", "dark", Unicode, LARGE, "5"),
        ("policy_120x40_ascii", "dark", Ascii, MIDDLE, "5"),
        ("population_80x24_dark", "dark", Unicode, SMALL, "6 j j"),
        (
            "population_120x40_sorted",
            "light",
            Unicode,
            MIDDLE,
            "6 s s s s S",
        ),
        ("status_80x24_dark", "dark", Unicode, SMALL, "7"),
    ];
    assert_shots(foraging(), [0.0, 2.0], &shots);
}

#[test]
fn windows_over_a_view() {
    for (name, size, keys) in [
        ("help_80x24", SMALL, "?"),
        ("help_80x24_scrolled", SMALL, "4 ? page-down down"),
        ("help_200x60", LARGE, "6 ?"),
        ("export_80x24", SMALL, "e"),
    ] {
        let mut screen = foraging().screen("dark", Unicode, size);
        screen.press(keys);
        assert_looks(name, &screen);
    }
}

/// Paused evolution and a frozen display look different.
#[test]
fn paused_and_frozen() {
    let mut screen = foraging().blank(Mode::Live, "dark", Unicode);
    let (some, rest) = foraging().events.split_at(4);
    assert_looks("live_before_anything", &screen);
    for event in some {
        screen.send(event.clone());
    }
    screen.send(Event::Progress {
        generation: 4,
        lived: 3,
        population: 6,
        control_steps: 123_456,
    });
    screen.wait(1.0);
    assert_looks("live_running", &screen);
    screen.press("f");
    for event in &rest[..1] {
        screen.send(event.clone());
    }
    screen.wait(1.0);
    assert_looks("live_frozen", &screen);
    screen.press("f p");
    screen.send(Event::Paused);
    screen.wait(1.0);
    assert_looks("live_paused", &screen);
    screen.press("q");
    assert_looks("live_question", &screen);
}

#[test]
fn worlds_of_cells() {
    for (world, keys) in [("taxi", "2"), ("cliff", "2")] {
        let mut screen = cells(world).screen("dark", Unicode, SMALL);
        screen.press(keys);
        screen.wait(1.0);
        assert_looks(&format!("arena_{world}"), &screen);
    }
}
