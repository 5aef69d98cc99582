//! Random bytes, and random changes to valid files, may be rejected but never cause a panic.

use std::fs;
use std::sync::LazyLock;

use maxq_lab::evolution::read_tree;
use maxq_lab::hierarchy::{canonical, parse, to_text};
use maxq_lab::lab::{Checkpoint, experiment, read_events};
use maxq_lab::scenario::Scenario;
use proptest::prelude::*;

use super::common::{Record, record, short, smoke, threads};

/// Text to insert into valid files: what parsers are likely to mishandle.
const TOKENS: &[&str] = &[
    "",
    "0",
    "-1",
    "1e999",
    "1e-999",
    "1e38",
    "0.1",
    "18446744073709551615",
    "null",
    "true",
    "\"\"",
    "\"Root\"",
    "NaN",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "\"",
    "\\",
    "\\u0000",
    "\\ud800",
    "(",
    ")",
    "Wander",
    " ",
    "\n",
    "\u{1b}",
    "\u{9b}",
    "\u{fffd}",
    "é",
];

/// A change: the place, as a fraction of the text; the number of characters removed; the index of
/// the token inserted.
type Change = (f64, usize, usize);

fn changes() -> impl Strategy<Value = Vec<Change>> {
    prop::collection::vec((0.0..1.0, 0_usize..12, 0..TOKENS.len()), 1..4)
}

fn changed(text: &str, changes: &[Change]) -> String {
    let mut text: Vec<char> = text.chars().collect();
    for &(at, gone, token) in changes {
        let from = (at * text.len() as f64) as usize;
        let to = (from + gone).min(text.len());
        text.splice(from..to, TOKENS[token].chars());
    }
    text.into_iter().collect()
}

/// Reads a scenario and prepares its world.
fn make_ready(text: &str) {
    if let Ok(scenario) = Scenario::parse(text, "fuzzed.json") {
        let _rejected_or_ready = experiment(scenario, 1);
    }
}

fn rebuild(text: &str) {
    if let Ok(checkpoint) = Checkpoint::from_text(text) {
        let experiment = experiment(checkpoint.scenario.clone(), checkpoint.seed);
        let _rejected_or_rebuilt = experiment.map(|experiment| experiment.population(&checkpoint));
    }
}

fn read_any_tree(text: &str) {
    let experiment = experiment(smoke(&[]), 1).unwrap();
    let catalogue = experiment.catalogue();
    if let Ok(tree) = parse(text, catalogue) {
        assert!(!canonical(&tree, catalogue).is_empty());
    }
    if let Ok(tree) = read_tree(text, catalogue, 4) {
        let again = read_tree(&to_text(&tree, catalogue), catalogue, 4);
        assert_eq!(again, Ok(tree), "{text:?}");
    }
}

static RECORD: LazyLock<Record> = LazyLock::new(|| record(&short(&[]), 1, &threads(2)));

fn text_of(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// The state of the checkpoint as text.
fn state() -> &'static str {
    let text = text_of(&RECORD.checkpoint);
    let from = text.find("\"state\":").unwrap() + "\"state\":".len();
    text[from..].trim_end().strip_suffix('}').unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_read_or_rejected(bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        let text = String::from_utf8_lossy(&bytes);
        make_ready(&text);
        rebuild(&text);
        read_any_tree(&text);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("events.jsonl");
        fs::write(&path, &bytes).unwrap();
        let _rejected_or_read = read_events(&path);
    }

    #[test]
    fn any_changed_scenario_is_read_or_rejected(changes in changes()) {
        let valid = serde_json::to_string(&smoke(&[])).unwrap();
        make_ready(&changed(&valid, &changes));
    }

    #[test]
    fn any_changed_checkpoint_is_read_or_rejected(changes in changes()) {
        rebuild(&changed(text_of(&RECORD.checkpoint), &changes));
        let state = changed(state(), &changes);
        let crc32 = crc32fast::hash(state.as_bytes());
        rebuild(&format!("{{\"format\":1,\"crc32\":\"{crc32:08x}\",\"state\":{state}}}"));
    }

    #[test]
    fn any_changed_event_log_is_read_or_rejected(changes in changes()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("events.jsonl");
        fs::write(&path, changed(text_of(&RECORD.events), &changes)).unwrap();
        let _rejected_or_read = read_events(&path);
    }

    #[test]
    fn any_words_and_parentheses_are_read_or_rejected(
        words in prop::collection::vec(
            prop::sample::select(vec!["(", ")", "Root", "Wander", "Capture", "Turn", "Nest", "é"]),
            0..40,
        ),
    ) {
        read_any_tree(&words.join(" "));
        read_any_tree(&words.concat());
        read_any_tree(&format!("(Root {})", words.join(" ")));
    }
}

#[test]
fn the_files_are_readable_without_a_change() {
    let crc32 = crc32fast::hash(state().as_bytes());
    let text = format!(
        "{{\"format\":1,\"crc32\":\"{crc32:08x}\",\"state\":{}}}\n",
        state()
    );
    assert_eq!(text.as_bytes(), RECORD.checkpoint);
    assert!(Checkpoint::from_text(&text).is_ok());
}
