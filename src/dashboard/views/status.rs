//! What the run is doing.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::shared::by_chance;
use super::view::View;
use crate::dashboard::context::{Mode, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, fitted_end, one_line, put, width};
use crate::lab::Ending;

/// What the run is doing.
///
/// ```text
///  ╭ Status ────────────────────────────╮
///  │ evolution    ▶ RUNNING             │
///  │ generation   12 of at most 200     │
///  │ individuals  ━━━━━━━━───── 7 of 14 │
///  │ time left    at most 3 min         │
///  │ ...                                │
///  │ 0:12 checkpoint saved              │   what was said last
///  ╰────────────────────────────────────╯
/// ```
pub(super) struct Status;

/// Column of the values.
const VALUES: u16 = 13;

impl View for Status {
    fn name(&self) -> &'static str {
        "status"
    }

    fn title(&self) -> &'static str {
        "Status"
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let look = &context.look;
        let room = usize::from(area.width.saturating_sub(VALUES));
        let mut row = 0;
        for (name, value, paint) in facts(context, room) {
            put(buffer, area, (1, row), name, look.style(Paint::Dim));
            let value = match name {
                // Of a path the end tells more.
                "folder" => fitted_end(&one_line(&value), room, look.signs),
                _ => fitted(&one_line(&value), room, look.signs),
            };
            put(buffer, area, (VALUES, row), &value, look.style(paint));
            row += 1;
        }
        let left = area.height.saturating_sub(row + 1);
        let log = context.log();
        let skipped = log.len().saturating_sub(usize::from(left));
        for (index, (text, when)) in log.iter().skip(skipped).enumerate() {
            let at = row + 1 + index as u16;
            let time = format!("{} ", clock(*when));
            let column = put(buffer, area, (1, at), &time, look.style(Paint::Dim));
            let room = usize::from(area.width.saturating_sub(column));
            let text = fitted(&one_line(text), room, look.signs);
            put(buffer, area, (column, at), &text, look.style(Paint::Text));
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Checkpoint, Action::Stop]
    }

    fn help_text(&self) -> &'static str {
        "What the run is doing. A control step is one time step of one individual. The time left\n\
         is that to the generation limit; evolution ends as soon as the better half of the\n\
         population has one structure. Pausing stops evolution; freezing holds what you see\n\
         while evolution goes on."
    }
}

/// A name, a value, and how the value is painted.
type Fact = (&'static str, String, Paint);

fn facts(context: &ViewContext, room: usize) -> Vec<Fact> {
    let scenario = context.scenario();
    let (sign, word, paint) = context.activity_mark();
    let mut facts = vec![("evolution", format!("{sign} {word}"), paint)];
    facts.extend(progress(context, room));
    let saved = match context.live_history().checkpoint() {
        Some(generation) => format!("after generation {generation}"),
        None => String::from("none yet"),
    };
    let evolution = &scenario.evolution;
    let survivors = format!(
        "{}, {} of them live on",
        evolution.population_size, evolution.reproduced
    );
    let trials = format!("{}, last half scored", evolution.trials_per_generation);
    facts.extend([
        ("checkpoint", saved, Paint::Text),
        ("scenario", scenario.name.clone(), Paint::Text),
        ("seed", context.experiment.seed().to_string(), Paint::Text),
        ("population", survivors, Paint::Text),
        ("trials", trials, Paint::Text),
        ("folder", context.folder.clone(), Paint::Text),
    ]);
    if by_chance(context).is_some() {
        facts.push(("ranks", String::from("drawn by chance"), Paint::Notice));
    }
    facts.extend(changed(context, room));
    facts
}

/// Settings that are told one by one.
const TOLD: usize = 4;

/// A setting with as much of its path as there is room for.
fn in_columns(setting: &str, room: usize) -> String {
    let (path, value) = setting.split_once('=').unwrap_or((setting, ""));
    let inner = path.match_indices('.').map(|(dot, _)| &path[dot + 1..]);
    let mut shorter = std::iter::once(path).chain(inner);
    let fits = |path: &&str| width(path) + 1 + width(value) <= room;
    let path = shorter.find(fits).or(path.rsplit('.').next());
    format!("{}={value}", path.unwrap_or(""))
}

/// In what the scenario departs from the embedded one of its name.
fn changed(context: &ViewContext, room: usize) -> Vec<Fact> {
    let names = std::iter::once("changed").chain(std::iter::repeat(""));
    let told = context.changed.iter().take(TOLD);
    let told = names
        .zip(told)
        .map(|(name, setting)| (name, in_columns(setting, room), Paint::Text));
    let mut facts: Vec<_> = told.collect();
    match context.changed.len().saturating_sub(TOLD) {
        0 => {}
        more => facts.push(("", format!("and {more} more"), Paint::Dim)),
    }
    facts
}

/// How far evolution is, and how fast.
fn progress(context: &ViewContext, room: usize) -> Vec<Fact> {
    let model = context.live_history();
    let limit = context.scenario().evolution.generation_limit;
    let lived = model.latest().map_or(0, |record| record.generation);
    let mut facts = vec![(
        "generation",
        format!("{lived} of at most {limit}"),
        Paint::Text,
    )];
    if let Some(progress) = model.progress() {
        let (lived, all) = (progress.lived, progress.population);
        let (name, text) = match progress.generation {
            0 => ("learning", String::from("primitive subtasks")),
            _ => ("individuals", bar(context, lived, all, room)),
        };
        facts.push((name, text, Paint::Text));
    }
    if let Some(record) = model.latest() {
        let steps = format!("{} steps", thousands(record.control_steps));
        facts.push(("computed", steps, Paint::Text));
    }
    match model.ending() {
        Some(Ending::Converged) => {
            let text = String::from("one structure is left");
            facts.push(("ended", text, Paint::Good));
        }
        Some(Ending::GenerationLimit) => {
            let text = String::from("generation limit");
            facts.push(("ended", text, Paint::Notice));
        }
        None if context.mode != Mode::Replay => {
            let rate = context.pace.steps_per_second();
            let rate = rate.map_or(String::from("?"), |rate| thousands(rate as u64));
            facts.push(("speed", format!("{rate} steps/s"), Paint::Text));
            let left = context
                .pace
                .time_to(limit)
                .map_or(String::from("?"), duration);
            facts.push(("time left", format!("at most {left}"), Paint::Text));
        }
        None => {}
    }
    facts
}

/// A bar with its numbers.
fn bar(context: &ViewContext, part: usize, whole: usize, room: usize) -> String {
    let numbers = format!(" {part} of {whole}");
    let columns = room.saturating_sub(numbers.len() + 1).min(24);
    let filled = (columns * part.min(whole)).checked_div(whole).unwrap_or(0);
    let signs = context.look.signs;
    let unfilled = signs.unfilled.repeat(columns - filled);
    format!("{}{unfilled}{numbers}", signs.filled.repeat(filled))
}

/// A number with its digits in threes.
fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

fn duration(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}

/// Minutes and seconds since the dashboard was opened.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_in_threes() {
        assert_eq!(thousands(7), "7");
        assert_eq!(thousands(1_791_820), "1 791 820");
        assert_eq!(duration(Duration::from_secs(3725)), "1 h 2 min");
    }

    #[test]
    fn a_setting_keeps_its_last_name() {
        let setting = "world.foraging.turn.rate=0.5";
        assert_eq!(in_columns(setting, 40), setting);
        assert_eq!(in_columns(setting, 14), "turn.rate=0.5");
        assert_eq!(in_columns(setting, 9), "rate=0.5");
        assert_eq!(in_columns(setting, 3), "rate=0.5");
    }
}
