//! The table of a study's runs: its contents and its keys, at every size.

use maxq_lab::dashboard::keys::{Action, Key, KeyMap};
use maxq_lab::dashboard::look::{Look, Signs, Theme};
use maxq_lab::dashboard::{
    FrameFormat, RowStatus, RunRow, RunsEffect, RunsNews, RunsTable, Work, render,
};
use maxq_lab::hierarchy::Glyphs;
use proptest::prelude::*;

use super::frames::assert_frame;

fn run(place: usize, status: RowStatus, generations: u64) -> RunRow {
    let arms = ["evolved", "random_selection", "hand_designed"];
    let scenario = 1 + place / arms.len() % 2;
    let start = 900.0 + 10.0 * place as f64;
    let course = (0..generations).map(|n| 300.0 + start / (1.0 + n as f64 / 4.0));
    RunRow {
        scenario: format!("environment-{scenario}"),
        arm: String::from(arms[place % arms.len()]),
        seed: 1 + (place / (2 * arms.len())) as u64,
        status,
        generations,
        course: course.collect(),
        fresh: (status == RowStatus::Done).then_some(402.25 + place as f64),
        trouble: (status == RowStatus::Unreadable).then(|| String::from("run.json: \u{1b}[2J")),
    }
}

/// A study in progress: runs of every status, and many that wait.
fn rows() -> Vec<RunRow> {
    let begun = [
        (RowStatus::Done, 40),
        (RowStatus::Done, 60),
        (RowStatus::Evolved, 12),
        (RowStatus::Running, 9),
        (RowStatus::Interrupted, 3),
        (RowStatus::Unreadable, 0),
        (RowStatus::Running, 0),
    ];
    let waiting = [(RowStatus::Waiting, 0); 40];
    let all = begun.into_iter().chain(waiting).enumerate();
    all.map(|(place, (status, n))| run(place, status, n))
        .collect()
}

fn blank(theme: &str, glyphs: Glyphs, (columns, rows): (u16, u16)) -> RunsTable {
    let look = Look::new(Theme::all(), theme, Signs::of(glyphs));
    let (name, folder) = (String::from("thesis"), String::from("studies/thesis"));
    let mut table = RunsTable::new(name, folder, look, KeyMap::default());
    table.resize(columns, rows);
    table
}

pub fn table(theme: &str, glyphs: Glyphs, size: (u16, u16)) -> RunsTable {
    let mut table = blank(theme, glyphs, size);
    table.set_rows(rows());
    table
}

fn press(table: &mut RunsTable, keys: &str) -> Option<RunsEffect> {
    let keys = keys.split_whitespace().map(|key| key.parse().unwrap());
    keys.fold(None, |_, key| table.key(key))
}

fn text(table: &RunsTable) -> String {
    render(&table.frame(), FrameFormat::Text)
}

#[test]
fn the_table() {
    for (name, theme, glyphs, size, keys) in [
        ("runs_80x24_dark", "dark", Glyphs::Unicode, (80, 24), "j"),
        ("runs_120x40_dark", "dark", Glyphs::Unicode, (120, 40), ""),
        ("runs_80x24_ascii", "mono", Glyphs::Ascii, (80, 24), "s G"),
        ("runs_40x12_mono", "mono", Glyphs::Unicode, (40, 12), "j j"),
        ("runs_help_80x24", "dark", Glyphs::Unicode, (80, 24), "?"),
    ] {
        let mut table = table(theme, glyphs, size);
        press(&mut table, keys);
        assert_frame(name, &table.frame());
    }
}

/// Enter opens the selected run, whatever the table is sorted by, and only if there is
/// something to show.
#[test]
fn enter_opens_the_selected_run() {
    let mut table = table("dark", Glyphs::Unicode, (80, 24));
    assert_eq!(press(&mut table, "enter"), Some(RunsEffect::Open(0)));
    assert_eq!(press(&mut table, "j j j enter"), Some(RunsEffect::Open(3)));
    // Sorted by state, running ones first; the selected run stays selected.
    assert_eq!(press(&mut table, "s enter"), Some(RunsEffect::Open(3)));
    assert_eq!(press(&mut table, "j enter"), Some(RunsEffect::Open(6)));
    assert_eq!(press(&mut table, "G enter"), None);
    assert!(text(&table).contains("this run has not started"));
    // In reverse order the last run is first.
    assert_eq!(press(&mut table, "S end enter"), Some(RunsEffect::Open(3)));
    assert_eq!(press(&mut table, "q"), Some(RunsEffect::Leave));
}

/// A run with an error shows the error instead of opening; control characters are escaped.
#[test]
fn an_unreadable_run_says_why() {
    let mut table = table("dark", Glyphs::Unicode, (80, 24));
    assert_eq!(press(&mut table, "j j j j j enter"), None);
    assert!(text(&table).contains("run.json: \\u{1b}[2J"));
    press(&mut table, "k");
    assert!(!text(&table).contains("run.json"));
}

/// Only changes need a redraw, so that a waiting study sends no bytes.
#[test]
fn the_same_rows_need_no_redraw() {
    let mut table = blank("dark", Glyphs::Unicode, (80, 24));
    assert!(text(&table).contains("reading the runs"));
    assert!(table.set_rows(rows()));
    assert!(!table.set_rows(rows()));
    let mut changed = rows();
    changed[3].generations += 1;
    assert!(table.set_rows(changed));
}

/// Work of the program is never ended without a question, and nothing is asked once it is over.
#[test]
fn quitting_during_work_asks_a_question() {
    let mut table = blank("dark", Glyphs::Unicode, (80, 24));
    let left = Some(std::time::Duration::from_secs(754));
    let news = |work| RunsNews { rows: rows(), work };
    assert!(table.update(news(Some(Work { left }))));
    assert!(!table.update(news(Some(Work { left }))));
    assert!(text(&table).contains("about 12 min left"));
    assert_eq!(press(&mut table, "q"), None);
    assert_frame("runs_question_80x24", &table.frame());
    assert_eq!(press(&mut table, "n enter"), Some(RunsEffect::Open(0)));
    assert_eq!(press(&mut table, "q d"), Some(RunsEffect::Detach));
    assert_eq!(press(&mut table, "q y"), Some(RunsEffect::Leave));
    assert_eq!(press(&mut table, "q"), None);
    assert!(table.update(news(None)));
    assert!(!text(&table).contains("Question"));
    assert_eq!(press(&mut table, "q"), Some(RunsEffect::Leave));
}

fn value() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..2000.0, 1 => any::<f64>()]
}

fn any_row() -> impl Strategy<Value = RunRow> {
    let texts = (any::<String>(), any::<String>());
    let status = prop::sample::select(RowStatus::ALL.to_vec());
    let course = prop::collection::vec(value(), 0..90);
    let fresh = prop::option::of(value());
    let numbers = (any::<u64>(), any::<u64>());
    (texts, status, course, fresh, numbers).prop_map(
        |((scenario, arm), status, course, fresh, (seed, generations))| RunRow {
            scenario,
            trouble: Some(arm.clone()),
            arm,
            seed,
            status,
            generations,
            course,
            fresh,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_rows_keys_and_sizes(
        rows in prop::collection::vec(any_row(), 0..20),
        fewer in 0..20_usize,
        keys in prop::collection::vec(prop::sample::select(Action::ALL.to_vec()), 0..30),
        size in (0..250_u16, 0..90_u16),
        ascii in any::<bool>(),
    ) {
        let glyphs = if ascii { Glyphs::Ascii } else { Glyphs::Unicode };
        let mut table = blank("dark", glyphs, size);
        table.set_rows(rows.clone());
        for (index, action) in keys.iter().enumerate() {
            let key: Key = action.default_keys()[0].parse().unwrap();
            if let Some(RunsEffect::Open(place)) = table.key(key) {
                prop_assert!(place < rows.len());
            }
            if index == 9 {
                table.set_rows(rows[..fewer.min(rows.len())].to_vec());
            }
            let frame = table.frame();
            let mut symbols = frame.content.iter().flat_map(|cell| cell.symbol().chars());
            prop_assert!(!symbols.any(char::is_control));
        }
    }
}
