//! Little room: at 80x24, and in the panels of 120x40, nothing essential is cut, and cut text
//! ends with an ellipsis.

use maxq_lab::hierarchy::Glyphs::Unicode;

use super::common;
use super::frames::{MIDDLE, SMALL};
use super::recorded::{Recorded, cells, foraging};
use super::textbook::learned;

/// The text of a panel, its lines joined by blanks.
fn panel(text: &str, title: &str) -> String {
    let lines: Vec<Vec<char>> = text.lines().map(|line| line.chars().collect()).collect();
    let found = lines.iter().enumerate().find_map(|(row, line)| {
        let line: String = line.iter().collect();
        let tops = ["╭ ", "╭▸ "].map(|corner| line.find(&format!("{corner}{title} ")));
        let top = tops.into_iter().flatten().next()?;
        Some((row, line[..top].chars().count()))
    });
    let (row, left) = found.unwrap_or_else(|| panic!("{title:?} in\n{text}"));
    let right = (left..).find(|&at| lines[row][at] == '╮').unwrap();
    let inside = lines[row + 1..].iter().take_while(|line| line[left] == '│');
    let inside = inside.map(|line| line[left + 1..right].iter().collect::<String>());
    let joined = inside.collect::<Vec<_>>().join(" ");
    joined.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Holds for the longest names of states, also in the arena of the overview.
#[test]
fn the_state_is_named_in_full() {
    for (case, state) in [
        (
            "from R to B at 0,3",
            "from R to B: 1 passenger waits, taxi elsewhere",
        ),
        (
            "in taxi to B at 0,3",
            "in taxi to B: 3 passenger in taxi, not at destination",
        ),
    ] {
        let start = learned().experiment.read_start(case).unwrap();
        let screen = learned().screen_from(Some(start), "dark", Unicode, SMALL);
        let arena = panel(&screen.text(), "Arena");
        assert!(arena.contains(state), "{state}: {arena}");
    }
    let mut screen = foraging().screen("dark", Unicode, SMALL);
    let names = &foraging().experiment.catalogue().state_types;
    for _ in 0..40 {
        screen.press("space . space");
        screen.wait(0.5);
        let player = &screen.0.app().context().player;
        let rollout = player.rollout().unwrap();
        let number = rollout.snapshot().state_type.number();
        if rollout.status().ended.is_none() {
            let name = format!("{number} {}", names[number - 1].description);
            let arena = panel(&screen.text(), "Arena");
            assert!(arena.contains(&name), "{name}: {arena}");
        }
    }
}

/// A cut number would be another number.
#[test]
fn lengths_of_trials_are_whole_or_left_out() {
    for size in [SMALL, (60, 24), (40, 12), MIDDLE] {
        let mut screen = learned().screen("dark", Unicode, size);
        for _ in 0..30 {
            screen.wait(1.0);
            let arena = panel(&screen.text(), "Arena");
            let player = &screen.0.app().context().player;
            let history = player.rollout().unwrap().status().history.clone();
            let latest: Vec<_> = history
                .iter()
                .rev()
                .map(|trial| trial.steps.to_string())
                .collect();
            if let Some((_, before)) = arena.split_once("before ") {
                let shown: Vec<_> = before.split(' ').map(|n| n.trim_end_matches('!')).collect();
                assert_eq!(shown[..], latest[..shown.len()], "{arena}");
            }
        }
    }
}

#[test]
fn state_types_are_named_in_full_in_the_policy_panel() {
    for run in [foraging(), learned(), &cells("cliff")] {
        let policy = panel(&run.screen("dark", Unicode, MIDDLE).text(), "Policy");
        for (index, info) in run.experiment.catalogue().state_types.iter().enumerate() {
            let title = format!("{} {}", index + 1, info.description);
            assert!(policy.contains(&title), "{title}: {policy}");
        }
    }
}

/// Shortened names of subtasks stay distinct; temperature and rule of every node of the call
/// stack are visible.
#[test]
fn the_stepper_is_complete_in_little_room() {
    let start = learned()
        .experiment
        .read_start("in taxi to B at 2,2")
        .unwrap();
    let mut screen = learned().screen_from(Some(start), "dark", Unicode, SMALL);
    screen.press("t . .");
    let text = screen.text();
    for (level, rule) in [
        ("Root  V", "continues Put"),
        ("Put  V", "NavToDes"),
        ("NavigateToDestination  V", "greedy"),
    ] {
        let line = text.lines().find(|line| line.contains(level));
        let line = line.unwrap_or_else(|| panic!("{level} in\n{text}"));
        assert!(
            line.contains("τ 0.050") && line.contains(rule),
            "{rule}: {line}"
        );
        assert!(!line.contains('…'), "{line}");
    }
}

/// Below the table of the population, where there is room.
#[test]
fn the_hierarchy_of_the_selected_individual_is_complete() {
    let mut screen = foraging().screen("dark", Unicode, SMALL);
    screen.press("6 j j");
    let selected = screen.0.app().context().selected().unwrap();
    let whole = format!("{}: {}", selected.id, selected.tree);
    let population = panel(&screen.text(), "Population");
    assert!(population.contains(&whole), "{whole}: {population}");
}

/// With random selection, the first ranks are not the best individuals.
#[test]
fn ranks_by_chance_are_marked() {
    let run = Recorded::new(&common::short(&["evolution.selection=random"]));
    let mut screen = run.screen("dark", Unicode, MIDDLE);
    for (key, words) in [
        ("1", "drawn at random"),
        ("1", "ranked at random"),
        ("1", "middle "),
        ("4", "random 4 of 8"),
        ("6", "ranked at random"),
    ] {
        screen.press(key);
        assert!(screen.text().contains(words), "{}", screen.text());
    }
    assert!(
        !foraging()
            .screen("dark", Unicode, MIDDLE)
            .text()
            .contains("at random")
    );
}

/// A scenario that differs from the built-in one of its name says in what.
#[test]
fn changed_settings_are_named() {
    let run = Recorded::new(&common::short(&["evolution.selection=random"]));
    let screen = run.screen("dark", Unicode, MIDDLE);
    let status = panel(&screen.text(), "Status");
    assert!(
        status.contains("changed") && status.contains(" more"),
        "{status}"
    );
    let mut screen = run.screen("dark", Unicode, (120, 40));
    screen.press("7");
    let text = screen.text();
    assert!(text.contains("evolution.generation_limit=6"), "{text}");
}

/// Both sides of a comparison can be read to their ends, in little room by pages.
#[test]
fn a_comparison_can_be_read_to_its_end() {
    let mut screen = learned().screen("dark", Unicode, SMALL);
    screen.press("c");
    assert!(!screen.text().contains("selects"), "{}", screen.text());
    screen.press("page-down page-down");
    let text = screen.text();
    assert!(text.contains("selects") && !text.contains("▼"), "{text}");
    screen.press("page-up page-up");
    assert!(screen.text().contains("selected: rank 1"));
}

/// The inspector names what its charts show.
#[test]
fn charts_of_the_inspector_say_what_they_show() {
    let mut screen = learned().screen("dark", Unicode, SMALL);
    screen.press("i");
    let text = screen.text();
    assert_eq!(text.matches("to 4.5").count(), 2, "across and down: {text}");
    assert!(!text.contains('…'), "{text}");
    screen.press("tab");
    assert!(!screen.text().contains('…'), "{}", screen.text());
}

/// Help that is longer than the screen marks the rest.
#[test]
fn long_help_says_that_there_is_more() {
    let mut screen = foraging().screen("dark", Unicode, SMALL);
    screen.press("?");
    assert!(screen.text().contains("▼ ") && !screen.text().contains("▲ "));
    screen.press("page-down");
    assert!(screen.text().contains("▲ 12 more"), "{}", screen.text());
}

/// Text that does not fit ends with an ellipsis.
#[test]
fn cut_text_ends_with_an_ellipsis() {
    let mut screen = foraging().screen("dark", Unicode, (44, 14));
    screen.press("t . . .");
    let text = screen.text();
    let cut = text.lines().filter(|line| line.contains("…│")).count();
    assert!(cut > 0, "{text}");
}
