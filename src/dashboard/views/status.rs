//! The status view: what the run is doing.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::shared::random_ranks;
use super::view::View;
use crate::dashboard::context::{Mode, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, fitted_end, one_line, put, width, wrapped};
use crate::files::ByteCount;
use crate::lab::Ending;

/// The state of the run, its settings, and the latest messages.
///
/// ```text
///  ╭ Status ────────────────────────────╮
///  │ evolution    ▶ RUNNING             │
///  │ generation   12 of at most 200     │
///  │ individuals  ━━━━━━━━───── 7 of 14 │
///  │ time left    at most 3 min         │
///  │ ...                                │
///  │ 0:12 checkpoint saved              │   the latest message
///  ╰────────────────────────────────────╯
/// ```
pub(super) struct Status;

/// Column in which the values start.
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
                // The end of a path tells more than its beginning.
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
        "What the run is doing. computed: the time steps simulated so far. time left: until the\n\
         generation limit; evolution ends earlier when it has converged, that is, when the\n\
         better half of the population has one structure. Reproduced individuals survive into\n\
         the next generation. Pausing stops evolution; freezing holds the display while\n\
         evolution continues."
    }
}

/// A name, a value, and how the value is painted.
type Fact = (&'static str, String, Paint);

fn facts(context: &ViewContext, room: usize) -> Vec<Fact> {
    let scenario = context.scenario();
    let (sign, word, paint) = context.activity_mark();
    let mut facts = vec![("evolution", format!("{sign} {word}"), paint)];
    facts.extend(last_sign(context, room));
    facts.extend(progress(context, room));
    let saved = match context.live_history().checkpoint() {
        Some(generation) => format!("after generation {generation}"),
        None => String::from("none yet"),
    };
    let evolution = &scenario.evolution;
    let (size, reproduced) = (evolution.population_size, evolution.reproduced);
    let population = format!("{size} ({reproduced} reproduced)");
    let trials = format!("{} (last half scored)", evolution.trials_per_generation);
    facts.extend([
        ("checkpoint", saved, Paint::Text),
        ("scenario", scenario.name.clone(), Paint::Text),
        ("seed", context.experiment.seed().to_string(), Paint::Text),
        ("population", population, Paint::Text),
        ("trials", trials, Paint::Text),
        ("folder", context.folder.clone(), Paint::Text),
    ]);
    let bytes = context
        .folder_bytes
        .map(|bytes| ByteCount(bytes).to_string());
    facts.extend(bytes.map(|bytes| ("folder size", bytes, Paint::Text)));
    if random_ranks(context).is_some() {
        facts.push(("ranks", String::from("drawn at random"), Paint::Notice));
    }
    facts.extend(changed(context, room));
    facts
}

/// Tells when the process that is gone was last alive, and why it failed.
fn last_sign(context: &ViewContext, room: usize) -> Vec<Fact> {
    let Some(sign) = &context.last_sign else {
        return Vec::new();
    };
    let mut facts = vec![("last alive", sign.time.clone(), Paint::Notice)];
    if let Some(error) = &sign.error {
        let names = std::iter::once("failed").chain(std::iter::repeat(""));
        let lines = wrapped(&one_line(error), room, "").into_iter().take(LISTED);
        facts.extend(
            names
                .zip(lines)
                .map(|(name, line)| (name, line, Paint::Bad)),
        );
    }
    facts
}

/// Most changed settings that are listed, and most lines of an error.
const LISTED: usize = 4;

/// Returns a setting with as much of its path as fits.
fn in_columns(setting: &str, room: usize) -> String {
    let (path, value) = setting.split_once('=').unwrap_or((setting, ""));
    let inner = path.match_indices('.').map(|(dot, _)| &path[dot + 1..]);
    let mut shorter = std::iter::once(path).chain(inner);
    let fits = |path: &&str| width(path) + 1 + width(value) <= room;
    let path = shorter.find(fits).or(path.rsplit('.').next());
    format!("{}={value}", path.unwrap_or(""))
}

/// Lists the settings in which the scenario differs from the embedded scenario of its name.
fn changed(context: &ViewContext, room: usize) -> Vec<Fact> {
    let names = std::iter::once("changed").chain(std::iter::repeat(""));
    let settings = names.zip(context.changed.iter().take(LISTED));
    let fact = |(name, setting): (_, &String)| (name, in_columns(setting, room), Paint::Text);
    let mut facts: Vec<_> = settings.map(fact).collect();
    let more = context.changed.len().saturating_sub(LISTED);
    if more > 0 {
        facts.push(("", format!("and {more} more"), Paint::Dim));
    }
    facts
}

/// Tells how far evolution has come, and how fast it runs.
fn progress(context: &ViewContext, room: usize) -> Vec<Fact> {
    let history = context.live_history();
    let evolution = &context.scenario().evolution;
    let (limit, step_limit) = (evolution.generation_limit, evolution.control_step_limit);
    let latest = history.latest().map_or(0, |record| record.generation);
    let text = |name, text: String| (name, text, Paint::Text);
    let mut facts = vec![text("generation", format!("{latest} of at most {limit}"))];
    if let Some(progress) = history.progress() {
        facts.push(match progress.generation {
            0 => text("training", String::from("primitive subtasks")),
            _ => {
                let bar = bar(context, progress.lived, progress.population, room);
                text("individuals", bar)
            }
        });
    }
    if let Some(record) = history.latest() {
        let steps = thousands(record.control_steps);
        let most = step_limit.map_or_else(String::new, |limit| format!(" of {}", thousands(limit)));
        facts.push(text("computed", format!("{steps}{most} steps")));
    }
    match history.ending() {
        Some(Ending::Converged) => {
            facts.push(("ended", String::from("converged"), Paint::Good));
        }
        Some(Ending::GenerationLimit) => {
            facts.push(("ended", String::from("at generation limit"), Paint::Notice));
        }
        Some(Ending::ControlStepLimit) => {
            let text = String::from("at limit of control steps");
            facts.push(("ended", text, Paint::Notice));
        }
        None if context.mode != Mode::Replay => {
            let unknown = || String::from("?");
            let rate = context.pace.steps_per_second();
            let lived = history.latest().map_or(0, |record| record.control_steps);
            let by_steps = rate.zip(step_limit).and_then(|(rate, limit)| {
                let seconds = limit.saturating_sub(lived) as f64 / rate;
                Duration::try_from_secs_f64(seconds).ok()
            });
            let left = context
                .pace
                .time_to(limit)
                .into_iter()
                .chain(by_steps)
                .min();
            let left = left.map_or_else(unknown, duration);
            let rate = rate.map_or_else(unknown, |rate| thousands(rate as u64));
            facts.push(text("speed", format!("{rate} steps/s")));
            facts.push(text("time left", format!("at most {left}")));
        }
        None => {}
    }
    facts
}

/// Returns a progress bar with its numbers.
fn bar(context: &ViewContext, part: usize, whole: usize, room: usize) -> String {
    let numbers = format!(" {part} of {whole}");
    let columns = room.saturating_sub(numbers.len() + 1).min(24);
    let filled = (columns * part.min(whole)).checked_div(whole).unwrap_or(0);
    let signs = context.look.signs;
    let unfilled = signs.unfilled.repeat(columns - filled);
    format!("{}{unfilled}{numbers}", signs.filled.repeat(filled))
}

/// Writes a number with its digits in groups of three.
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

/// Writes a time since the dashboard was opened, as minutes and seconds.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    format!("{}:{:02}", seconds / 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped_in_threes() {
        assert_eq!(thousands(7), "7");
        assert_eq!(thousands(1_791_820), "1 791 820");
        assert_eq!(duration(Duration::from_secs(3725)), "1 h 2 min");
    }

    #[test]
    fn a_setting_keeps_the_end_of_its_path() {
        let setting = "world.foraging.turn.rate=0.5";
        assert_eq!(in_columns(setting, 40), setting);
        assert_eq!(in_columns(setting, 14), "turn.rate=0.5");
        assert_eq!(in_columns(setting, 9), "rate=0.5");
        assert_eq!(in_columns(setting, 3), "rate=0.5");
    }
}
