//! What the agent reads off its sensors, before and after a time step.

use ratatui::text::Line;

use super::Shown;
use crate::dashboard::context::ViewContext;
use crate::dashboard::look::Paint;
use crate::dashboard::look::lines::Pen;
use crate::dashboard::views::shared::case;

/// Columns of a reading.
const VALUE: usize = 7;

/// The readings; what was read before the step too, where there is room.
///
/// ```text
///  readings               before  after
///  proximity +0deg mm        350    312
///  target angle deg            -  -12.4
/// ```
pub(super) fn lines(
    context: &ViewContext,
    shown: &Shown<'_>,
    columns: usize,
) -> Vec<Line<'static>> {
    let trace = shown.trace;
    let both = columns >= 34;
    let name = columns.saturating_sub(if both { 2 * VALUE } else { VALUE });
    let head = Pen::new(shown.look).cell("readings", name, Paint::Dim);
    let head = match both {
        true => head.right("before", VALUE, Paint::Dim),
        false => head,
    };
    let mut lines = vec![head.right("after", VALUE, Paint::Dim).line()];
    for (before, after) in trace.before.readings.iter().zip(&trace.after.readings) {
        let words = after.name.replace('_', " ");
        let (words, unit) = words.rsplit_once(' ').unwrap_or((&words, ""));
        let pen = Pen::new(shown.look).text(words, Paint::Text);
        let room = (name.saturating_sub(pen.column())).saturating_sub(2);
        let pen = match unit.len() <= room {
            true => pen.text(format!(" {unit}"), Paint::Dim),
            false => pen,
        };
        let pen = pen.to(name);
        let pen = match both {
            true => pen.right(&value(before.value), VALUE, Paint::Dim),
            false => pen,
        };
        lines.push(pen.right(&value(after.value), VALUE, Paint::Title).line());
    }
    if let Some(case) = case(context, &trace.after) {
        lines.push(Pen::new(shown.look).text(case, Paint::Notice).line());
    }
    if context.scenery().grid.is_some() {
        // Beside them stands what was the case before the step's lessons.
        let text = format!("cells: V after step {}", trace.step);
        lines.push(Pen::new(shown.look).text(text, Paint::Dim).line());
    }
    if let Some(carried) = &trace.after.carries {
        let text = format!("carries {carried}");
        lines.push(Pen::new(shown.look).text(text, Paint::Object).line());
    }
    lines
}

fn value(value: Option<f64>) -> String {
    match value {
        None => String::from("-"),
        Some(value) if value.abs() >= 100.0 => format!("{value:.0}"),
        Some(value) => format!("{value:.1}"),
    }
}
