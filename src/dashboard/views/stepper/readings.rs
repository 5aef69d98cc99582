//! The sensor readings before and after a time step.

use ratatui::text::Line;

use super::ShownStep;
use crate::dashboard::context::ViewContext;
use crate::dashboard::look::Paint;
use crate::dashboard::look::lines::Pen;
use crate::dashboard::views::shared::{line, variant_name};

/// Columns of a reading.
const VALUE: usize = 7;

/// Returns the readings after the step and, where they fit, before it.
///
/// ```text
///  readings               before  after
///  proximity +0deg mm        350    312
///  target angle deg            -  -12.4
/// ```
pub(super) fn lines(
    context: &ViewContext,
    shown: &ShownStep<'_>,
    columns: usize,
) -> Vec<Line<'static>> {
    let trace = shown.trace;
    let both = columns >= 34;
    let name = columns.saturating_sub(if both { 2 * VALUE } else { VALUE });
    let numbers = |mut pen: Pen<'_>, before: &str, after: &str, paint| {
        pen = pen.to(name);
        if both {
            pen = pen.right(before, VALUE, Paint::Dim);
        }
        pen.right(after, VALUE, paint).line()
    };
    let head = Pen::new(shown.look).cell("readings", name, Paint::Dim);
    let mut lines = vec![numbers(head, "before", "after", Paint::Dim)];
    for (before, after) in trace.before.readings.iter().zip(&trace.after.readings) {
        let words = after.name.replace('_', " ");
        let (words, unit) = words.rsplit_once(' ').unwrap_or((&words, ""));
        let mut pen = Pen::new(shown.look).text(words, Paint::Text);
        if unit.len() + 2 <= name.saturating_sub(pen.column()) {
            pen = pen.text(format!(" {unit}"), Paint::Dim);
        }
        let (before, after) = (value(before.value), value(after.value));
        lines.push(numbers(pen, &before, &after, Paint::Title));
    }
    if let Some(variant) = variant_name(context, &trace.after) {
        lines.push(line(shown.look, variant, Paint::Notice));
    }
    if context.scenery().grid.is_some() {
        // The stack beside them shows the values before the step's updates.
        let text = format!("cells: V after step {}", trace.step);
        lines.push(line(shown.look, text, Paint::Dim));
    }
    if let Some(carried) = &trace.after.carries {
        lines.push(line(
            shown.look,
            format!("carries {carried}"),
            Paint::Object,
        ));
    }
    lines
}

/// Writes a reading; `-` where there is none.
fn value(value: Option<f64>) -> String {
    match value {
        None => String::from("-"),
        Some(value) if value.abs() >= 100.0 => format!("{value:.0}"),
        Some(value) => format!("{value:.1}"),
    }
}
