//! Worlds of cells on the screen: the numbers of Thesis 2.2.2, values and greedy actions.

use std::sync::OnceLock;

use maxq_lab::hierarchy::Glyphs::{Ascii, Unicode};
use maxq_lab::scenario::Scenario;

use super::frames::assert_looks;
use super::recorded::{Recorded, Screen, cells};

const HAND_MADE: &str = "(Root (Get (NavigateToPassenger North South East West) Pickup) \
     (Put (NavigateToDestination North South East West) Putdown))";

/// A run without variation, in which individuals only learn.
pub fn learned() -> &'static Recorded {
    static RUN: OnceLock<Recorded> = OnceLock::new();
    RUN.get_or_init(|| {
        let population = vec![format!("{HAND_MADE:?}"); 6].join(",");
        let settings = [
            String::from("evolution.variation=none"),
            String::from("evolution.population_size=6"),
            String::from("evolution.generation_limit=40"),
            format!("evolution.initial_population=[{population}]"),
        ];
        let scenario = Scenario::load("taxi").unwrap();
        Recorded::new(&scenario.with_settings(&settings).unwrap())
    })
}

/// The state of Thesis Figure 2.6, in which the passenger is one cell to the north.
const FIGURE_2_6: &str = "from R to B at 0,3";

/// The numbers after a name in the stepper's table.
fn row(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines().filter_map(|line| line.split_once(name));
    let after = lines
        .next()
        .unwrap_or_else(|| panic!("{name} in\n{text}"))
        .1;
    let words = after.split_whitespace();
    words.map_while(|word| word.parse().ok()).collect()
}

/// V(Root, s1) = 10 and its decomposition (Thesis 2.2.2), read from the frame.
#[test]
fn the_stepper_shows_the_numbers_of_the_thesis() {
    for (glyphs, size) in [
        (Unicode, (120, 40)),
        (Unicode, (200, 60)),
        (Ascii, (120, 40)),
    ] {
        let start = learned().experiment.read_start(FIGURE_2_6).unwrap();
        let mut screen = learned().screen_from(Some(start), "dark", glyphs, size);
        screen.press("t .");
        let text = screen.text();
        assert_eq!(row(&text, " Root  V"), [10.0], "{text}");
        // C~+V, V, C~, C and the probability in percent.
        assert_eq!(
            row(&text, " Get  "),
            [10.0, -2.0, 12.0, 12.0, 100.0],
            "{text}"
        );
        assert_eq!(row(&text, " Get  V"), [-2.0], "{text}");
        let navigate = row(&text, " NavigateToPassenger  ");
        assert_eq!(navigate[..4], [-2.0, -1.0, -1.0, -1.0], "{text}");
        assert_eq!(row(&text, " NavigateToPassenger  V"), [-1.0], "{text}");
        assert_eq!(
            row(&text, " North  ")[..4],
            [-1.0, -1.0, 0.0, 0.0],
            "{text}"
        );
        assert!(text.contains("from R to B"), "{text}");
        // The next trial starts in the same state.
        screen.press("N .");
        assert_eq!(row(&screen.text(), " Root  V"), [10.0]);
    }
}

#[test]
fn cells_show_values_and_greedy_actions() {
    let start = learned().experiment.read_start(FIGURE_2_6).unwrap();
    for (name, theme, glyphs, size, keys) in [
        ("cells_taxi_80x24", "dark", Unicode, (80, 24), "2"),
        ("cells_taxi_80x24_ascii", "mono", Ascii, (80, 24), "2"),
        ("cells_taxi_overview_80x24", "dark", Unicode, (80, 24), "1"),
        (
            "cells_taxi_overview_120x40",
            "mono",
            Unicode,
            (120, 40),
            "1",
        ),
        ("cells_taxi_120x40", "light", Unicode, (120, 40), "2"),
        (
            "cells_taxi_stepper_80x24",
            "dark",
            Unicode,
            (80, 24),
            "t . . . ,",
        ),
    ] {
        let mut screen = learned().screen_from(Some(start), theme, glyphs, size);
        screen.press("space . .");
        screen.press(keys);
        assert_looks(name, &screen);
    }
    let mut screen = learned().screen_from(Some(start), "dark", Unicode, (120, 40));
    screen.press("space 2");
    let cells = screen
        .0
        .app()
        .context()
        .player
        .rollout()
        .unwrap()
        .cells()
        .unwrap();
    assert!((cells.cell(0, 1).unwrap().value - 10.0).abs() < 0.001);
    assert!(screen.text().contains(" 10.0"), "{}", screen.text());
}

/// The cells of the stepper show what was learned by the end of the shown step, however far the
/// rollout has advanced, and the screen says so.
#[test]
fn the_stepper_shows_the_cells_of_its_step() {
    let unlearned = cells("cliff");
    let mut screen = unlearned.screen("dark", Unicode, (120, 40));
    screen.press("t .");
    let number = |screen: &Screen| {
        let text = screen.text();
        let after = text.split("cells: V after step ").nth(1);
        let after = after.unwrap_or_else(|| panic!("{text}"));
        after
            .split_whitespace()
            .next()
            .unwrap()
            .parse::<u32>()
            .unwrap()
    };
    let values = |screen: &Screen, back: usize| {
        let cells = screen.0.app().context().player.cells(back).unwrap();
        cells
            .cells
            .iter()
            .flatten()
            .map(|cell| cell.value.to_bits())
            .collect::<Vec<_>>()
    };
    let (first, frame) = (values(&screen, 0), screen.text());
    let step = number(&screen);
    screen.press(". . . . . . . .");
    assert_eq!(number(&screen), step + 8);
    assert_ne!(values(&screen, 0), first, "it has learned since");
    screen.press(", , , , , , , ,");
    assert_eq!(number(&screen), step);
    assert_eq!(values(&screen, 8), first);
    let arena = |text: &str| -> Vec<String> {
        let rows = text.lines().skip(2).take(30);
        rows.map(|row| row.chars().take(48).collect()).collect()
    };
    assert_eq!(arena(&screen.text()), arena(&frame));
}

/// A world of cells that is wider than high, with hazards.
#[test]
fn the_cliff_fits_into_the_overview() {
    let cliff = cells("cliff");
    for (name, glyphs) in [
        ("cells_cliff_overview", Unicode),
        ("cells_cliff_ascii", Ascii),
    ] {
        let mut screen = cliff.screen("high-contrast", glyphs, (80, 24));
        screen.wait(1.0);
        assert_looks(name, &screen);
    }
}

/// Eleven rows of cells do not fit into the overview of a small terminal: the world is drawn
/// without cells there, and with cells in its own view.
#[test]
fn a_world_of_many_cells_is_drawn_in_a_small_overview() {
    let rooms = cells("four-rooms");
    let mut screen = rooms.screen("dark", Unicode, (80, 24));
    screen.wait(1.0);
    assert_looks("cells_four_rooms_80x24", &screen);
    assert!(screen.text().contains('⌂') && screen.text().contains('●'));
    screen.press("2");
    assert_looks("cells_four_rooms_arena", &screen);
}

/// The error names the allowed states.
#[test]
fn an_impossible_start_state_is_refused() {
    for wrong in [
        "from R to X at 0,3",
        "from R to B",
        "from R to B at 5,0",
        "",
    ] {
        let error = learned()
            .experiment
            .read_start(wrong)
            .unwrap_err()
            .to_string();
        assert!(error.contains(&format!("{wrong:?}")), "{error}");
        assert!(
            error.contains("from R to G") && error.contains("5,5"),
            "{error}"
        );
    }
}
