//! The header and the hint bar: the first and the last line of the screen.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::hints;
use crate::dashboard::context::{Mode, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Look, Paint, fitted, fitted_parts, one_line, put, width};
use crate::dashboard::view_id::ViewId;

/// Draws the header: what the run is doing, the view, the generation, the scenario.
///
/// ```text
///  ▶ RUNNING  Overview · generation 11 · environment-1 seed 1             ✱ VIEW FROZEN at 11
/// ```
pub(in crate::dashboard) fn draw(
    context: &ViewContext,
    view: ViewId,
    area: Rect,
    buffer: &mut Buffer,
) {
    let line = Rect {
        height: area.height.min(1),
        ..area
    };
    let look = &context.look;
    let (sign, word, paint) = context.activity_mark();
    let state = format!(" {sign} {word} ");
    let mut column = put(buffer, line, (0, 0), &state, look.style(paint));
    let marks = marks(context);
    let right = marks.iter().map(|mark| width(mark) + 1).sum::<usize>();
    let room = usize::from(line.width.saturating_sub(column)).saturating_sub(right);
    let separator = look.signs.separator;
    let name = one_line(&context.scenario().name);
    let time = match context.shown() {
        Some(record) => format!("generation {}", record.generation),
        None => String::from("before the first generation"),
    };
    let text = format!(
        " {} {separator} {time} {separator} {name} seed {}",
        view.title(),
        context.experiment.seed()
    );
    column = put(
        buffer,
        line,
        (column, 0),
        &fitted_parts(&text, room, look.signs),
        look.style(Paint::Text),
    );
    let mut start = line
        .width
        .saturating_sub(u16::try_from(right).unwrap_or(u16::MAX))
        .max(column);
    for mark in marks {
        start = put(buffer, line, (start, 0), &mark, look.style(Paint::Frozen)) + 1;
    }
}

/// Returns the marks that say that the screen does not show the current state of a live run.
fn marks(context: &ViewContext) -> Vec<String> {
    let mut marks = Vec::new();
    match context.mode {
        Mode::Live => {}
        Mode::Watch => marks.push(String::from(" WATCHING ")),
        Mode::Replay => marks.push(String::from(" REPLAY ")),
    }
    if context.frozen() {
        let latest = context
            .history()
            .latest()
            .map_or(0, |record| record.generation);
        marks.push(format!(
            " {} VIEW FROZEN at {latest} ",
            context.look.signs.frozen
        ));
    } else if context.is_in_the_past() {
        let latest = context
            .live_history()
            .latest()
            .map_or(0, |record| record.generation);
        marks.push(format!(" PAST of {latest} "));
    }
    marks
}

/// Draws the hint bar: a message, or what keys do.
pub(in crate::dashboard) fn hint_bar(
    context: &ViewContext,
    hints: &[Action],
    area: Rect,
    buffer: &mut Buffer,
) {
    let line = last_line(area);
    if let Some(text) = context.message() {
        return put_message(&context.look, text, line, buffer);
    }
    let named = |actions: &[Action]| -> Vec<Hint> {
        let hints = actions.iter().filter_map(|&action| {
            let (keys, _) = context.keys.hint(action, context.look.signs)?;
            Some((keys, hints::word(context, action)))
        });
        hints.collect()
    };
    let always = named(hints::always(context));
    put_hints(&context.look, &named(hints), &always, line, buffer);
}

/// Returns the last line of an area.
pub(in crate::dashboard) fn last_line(area: Rect) -> Rect {
    Rect {
        y: area.bottom().saturating_sub(1),
        height: area.height.min(1),
        ..area
    }
}

/// Draws a message in place of the hints.
pub(in crate::dashboard) fn put_message(look: &Look, text: &str, line: Rect, buffer: &mut Buffer) {
    let text = fitted(&one_line(text), usize::from(line.width), look.signs);
    put(buffer, line, (0, 0), &text, look.style(Paint::Notice));
}

/// Draws as many hints as there is room for.
///
/// The hints of `always`, help and the way out, stand at the right end.
pub(in crate::dashboard) fn put_hints(
    look: &Look,
    hints: &[Hint],
    always: &[Hint],
    line: Rect,
    buffer: &mut Buffer,
) {
    let right: u16 = always.iter().map(columns).sum();
    let right = line.width.saturating_sub(right);
    let mut column = 0;
    for pair in hints {
        if column + columns(pair) > right {
            break;
        }
        column = put_hint(look, line, column, pair, buffer);
    }
    let mut column = right;
    for pair in always {
        column = put_hint(look, line, column, pair, buffer);
    }
}

/// A key and its effect.
pub(in crate::dashboard) type Hint = (String, &'static str);

/// Returns the columns that a hint takes, two of them blank.
fn columns((key, hint): &Hint) -> u16 {
    u16::try_from(width(key) + width(hint) + 3).unwrap_or(u16::MAX)
}

fn put_hint(look: &Look, line: Rect, column: u16, (key, hint): &Hint, buffer: &mut Buffer) -> u16 {
    let column = put(buffer, line, (column, 0), key, look.style(Paint::Key));
    put(buffer, line, (column + 1, 0), hint, look.style(Paint::Dim)) + 2
}
