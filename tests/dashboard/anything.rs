//! No sequence of keys, sizes, events and times makes the dashboard panic.

use std::time::Duration;

use maxq_lab::dashboard::keys::{Action, Key};
use maxq_lab::dashboard::{Gesture, Input, Mode, Mouse};
use maxq_lab::evolution::GenerationRecord;
use maxq_lab::hierarchy::Glyphs;
use maxq_lab::lab::{Ending, Event};
use proptest::prelude::*;
use ratatui::layout::Position;

use super::recorded::foraging;

fn key() -> impl Strategy<Value = Key> {
    let bound = Action::ALL.iter().flat_map(|action| action.default_keys());
    let bound: Vec<Key> = bound.map(|key| key.parse().unwrap()).collect();
    prop_oneof![
        9 => prop::sample::select(bound),
        1 => any::<char>().prop_map(Key::char),
    ]
}

/// A recorded generation, or one with missing, strange or huge parts.
fn record() -> impl Strategy<Value = GenerationRecord> {
    let numbers = (
        1..7_usize,
        prop_oneof![1..9_u64, Just(u64::MAX)],
        0..9_usize,
    );
    (numbers, 0..6).prop_map(|((which, generation, individuals), how)| {
        let Event::Generation(record) = foraging().events[which].clone() else {
            panic!("not a generation");
        };
        let mut record = *record;
        record.generation = generation;
        record.individuals.truncate(individuals);
        match how {
            0 => record.mean_difference = -1e308,
            1 => record.selection_probabilities.truncate(1),
            2 => record.selection_probabilities.extend(vec![None; 40]),
            3 => {
                for individual in &mut record.individuals {
                    individual.trials.clear();
                    individual.fitness_steps = u64::MAX;
                    individual.difference_to_best = i64::MIN;
                    individual.tree = String::from("(Root \u{1b}[2J\u{202e}");
                    individual.rank = usize::MAX;
                }
            }
            _ => {}
        }
        record
    })
}

fn event() -> impl Strategy<Value = Event> {
    let progress = (0..9_u64, 0..99_usize, 0..9_usize, any::<u64>());
    prop_oneof![
        4 => record().prop_map(|record| Event::Generation(Box::new(record))),
        2 => progress.prop_map(|(generation, lived, population, control_steps)| Event::Progress {
            generation,
            lived,
            population,
            control_steps,
        }),
        1 => Just(Event::Paused),
        1 => Just(Event::Resumed),
        1 => any::<u64>().prop_map(|generation| Event::CheckpointSaved { generation }),
        1 => any::<u64>().prop_map(|generations| Event::Ended {
            generations,
            ending: Ending::Converged,
        }),
    ]
}

fn mouse() -> impl Strategy<Value = Mouse> {
    let what = prop::sample::select(vec![Gesture::Click, Gesture::WheelUp, Gesture::WheelDown]);
    (0..130_u16, 0..50_u16, what).prop_map(|(x, y, what)| Mouse {
        at: Position::new(x, y),
        what,
    })
}

fn input() -> impl Strategy<Value = Input> {
    prop_oneof![
        8 => key().prop_map(Input::Key),
        3 => mouse().prop_map(Input::Mouse),
        2 => (0..250_u16, 0..90_u16).prop_map(|(columns, rows)| Input::Resize(columns, rows)),
        3 => event().prop_map(|event| Input::Event(Box::new(event))),
        3 => (0..3000_u64).prop_map(|ms| Input::Tick(Duration::from_millis(ms))),
        1 => any::<String>().prop_map(Input::Message),
        1 => Just(Input::Closed),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_sequence_of_inputs_draws_a_clean_frame(
        inputs in prop::collection::vec(input(), 1..60),
        mode in prop::sample::select(vec![Mode::Live, Mode::Watch, Mode::Replay]),
        ascii in any::<bool>(),
    ) {
        let glyphs = if ascii { Glyphs::Ascii } else { Glyphs::Unicode };
        let mut screen = foraging().blank(mode, "dark", glyphs);
        for input in inputs {
            screen.0.update(input);
            let frame = screen.0.app().frame();
            let mut symbols = frame.content.iter().flat_map(|cell| cell.symbol().chars());
            prop_assert!(!symbols.any(char::is_control));
        }
    }
}
