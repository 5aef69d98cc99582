//! The mouse: clicks and the wheel in the overview, in lists, and in the table of runs.

use maxq_lab::dashboard::{Gesture, Input, Mouse, RunsEffect, ViewId};
use maxq_lab::hierarchy::Glyphs::Unicode;
use ratatui::layout::Position;

use super::recorded::{Screen, foraging};
use super::runs;

/// The position of a text on the screen.
fn find(text: &str, wanted: &str) -> Position {
    let mut lines = text.lines().enumerate();
    let found = lines.find_map(|(row, line)| {
        let (before, _) = line.split_once(wanted)?;
        Some(Position::new(before.chars().count() as u16 + 1, row as u16))
    });
    found.unwrap_or_else(|| panic!("{wanted} in\n{text}"))
}

fn act(screen: &mut Screen, what: Gesture, wanted: &str) {
    let at = find(&screen.text(), wanted);
    screen.0.update(Input::Mouse(Mouse { at, what }));
}

fn selected(screen: &Screen) -> usize {
    screen.0.app().context().selected().unwrap().rank
}

#[test]
fn a_click_focuses_a_panel_and_a_second_opens_it() {
    let mut screen = foraging().screen("dark", Unicode, (120, 40));
    act(&mut screen, Gesture::Click, "Fitness");
    let app = screen.0.app();
    assert_eq!(
        (app.view(), app.context().focus),
        (ViewId::Overview, ViewId::Fitness)
    );
    act(&mut screen, Gesture::Click, "Fitness");
    assert_eq!(screen.0.app().view(), ViewId::Fitness);
}

#[test]
fn a_click_selects_an_individual_and_a_second_opens_it() {
    let mut screen = foraging().screen("dark", Unicode, (120, 40));
    for rank in [3, 2, 5] {
        let id = screen.0.app().context().shown().unwrap().individuals[rank - 1].id;
        act(&mut screen, Gesture::Click, &format!("   {rank} {id:>5} "));
        assert_eq!(
            (selected(&screen), screen.0.app().view()),
            (rank, ViewId::Overview)
        );
    }
    act(&mut screen, Gesture::WheelDown, "Population");
    assert_eq!(selected(&screen), 6);
    act(&mut screen, Gesture::WheelUp, "Population");
    act(&mut screen, Gesture::WheelUp, "Population");
    assert_eq!(selected(&screen), 4);
    act(&mut screen, Gesture::Click, "▸   4");
    assert_eq!(screen.0.app().view(), ViewId::Population);
    act(&mut screen, Gesture::Click, "    1 ");
    assert_eq!(selected(&screen), 1);
    act(&mut screen, Gesture::Click, "▸   1");
    assert_eq!(screen.0.app().view(), ViewId::Inspector);
}

#[test]
fn a_click_selects_a_subtask_of_the_inspector() {
    for size in [(80, 24), (120, 40)] {
        let mut screen = foraging().screen("dark", Unicode, size);
        screen.press("i");
        let tree = screen.0.app().context().player.tree().unwrap().clone();
        let last = tree.subtask(tree.nodes().len() - 1);
        let name = last.name(foraging().experiment.catalogue());
        act(&mut screen, Gesture::Click, &format!("└─ {name}"));
        assert!(screen.text().contains("▸"), "{}", screen.text());
        assert_eq!(find(&screen.text(), "▸ ").y, find(&screen.text(), name).y);
    }
}

/// In the hierarchy, both as a panel and as a view; the inspector shows the same subtask.
#[test]
fn a_click_selects_a_subtask_and_a_second_inspects_it() {
    let mut screen = foraging().screen("dark", Unicode, (120, 40));
    let tree = screen.0.app().context().inspected_tree().unwrap();
    let last = tree.nodes().len() - 1;
    let line = format!(
        "└─ {}",
        foraging()
            .experiment
            .catalogue()
            .subtask(tree.subtask(last))
            .name
    );
    act(&mut screen, Gesture::Click, &line);
    assert_eq!(screen.0.app().context().node_in(&tree), last);
    assert_eq!(screen.0.app().view(), ViewId::Overview);
    act(&mut screen, Gesture::WheelUp, &line);
    assert_eq!(screen.0.app().context().node_in(&tree), last - 1);
    act(&mut screen, Gesture::Click, &line);
    act(&mut screen, Gesture::Click, &line);
    assert_eq!(screen.0.app().view(), ViewId::Hierarchy);
    act(&mut screen, Gesture::Click, "rank");
    assert_eq!(
        screen.0.app().view(),
        ViewId::Hierarchy,
        "nothing was there"
    );
    act(&mut screen, Gesture::Click, &line);
    assert_eq!(screen.0.app().view(), ViewId::Inspector);
    assert_eq!(find(&screen.text(), "▸ ").y, find(&screen.text(), &line).y);
}

#[test]
fn a_click_closes_help_and_the_wheel_scrolls_it() {
    let mut screen = foraging().screen("dark", Unicode, (80, 24));
    screen.press("?");
    let first = screen.text();
    act(&mut screen, Gesture::WheelDown, "Help");
    assert_ne!(screen.text(), first);
    assert!(screen.text().contains("Help"));
    act(&mut screen, Gesture::Click, "Help");
    assert!(!screen.text().contains("Help"));
}

#[test]
fn a_click_selects_a_run_and_a_second_opens_it() {
    let mut table = runs::table("dark", Unicode, (80, 24));
    let click = |table: &mut maxq_lab::dashboard::RunsTable, row: u16| {
        let at = Position::new(10, row);
        table.mouse(Mouse {
            at,
            what: Gesture::Click,
        })
    };
    // Below header, border and headings.
    assert_eq!(click(&mut table, 3 + 3), None);
    assert_eq!(click(&mut table, 3 + 3), Some(RunsEffect::Open(3)));
    assert_eq!(click(&mut table, 3), None);
    assert_eq!(click(&mut table, 3), Some(RunsEffect::Open(0)));
    assert_eq!(click(&mut table, 0), None);
}
