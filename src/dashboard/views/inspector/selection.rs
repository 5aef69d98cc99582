//! Selection probabilities of one individual, beside the mean of the better half.

use std::fmt::Write;

use ratatui::text::Line;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::lines::{Pen, percent};
use crate::dashboard::look::{Paint, shortened, wrapped};
use crate::learning::SelectionProbabilities;

/// Least share that is listed.
const LEAST: f64 = 0.005;

/// For each state type the primitive subtasks that the policy ends in.
///
/// ```text
///  1 empty-handed, no battery visible
///    Avoid            100 %  ━━━━━━━━━━   mean 98 %
/// ```
pub(super) fn lines(
    context: &ViewContext,
    selection: &SelectionProbabilities,
    columns: usize,
) -> Vec<Line<'static>> {
    let look = &context.look;
    let catalogue = context.catalogue();
    let names = columns.saturating_sub(2 + 6 + 12).clamp(8, 16);
    let bar = columns.saturating_sub(2 + names + 6 + 2 + 12).min(20);
    let mut lines = Vec::new();
    for (index, shares) in selection.iter().enumerate() {
        let about = catalogue.state_types.get(index);
        let about = about.map_or("", |info| &info.description);
        let title = format!("{} {about}", index + 1);
        let title = wrapped(&title, columns, "  ").into_iter();
        lines.extend(title.map(|line| Pen::new(look).text(line, Paint::Title).line()));
        let Some(shares) = shares else {
            let text = "  no such state in this arena";
            lines.push(Pen::new(look).text(text, Paint::Dim).line());
            continue;
        };
        for (place, (primitive, &share)) in catalogue.primitives().zip(shares).enumerate() {
            let name = primitive.name(catalogue);
            let mean = mean(context, index, name);
            if share < LEAST && mean.is_none_or(|mean| mean < LEAST) {
                continue;
            }
            let pen = Pen::new(look)
                .to(2)
                .text(shortened(name, names, look.signs), Paint::Text)
                .to(2 + names)
                .right(&percent(share), 6, Paint::Title);
            let pen = match bar {
                0 => pen,
                bar => pen
                    .text("  ", Paint::Text)
                    .bar(share, bar, Paint::series(place)),
            };
            let mean = mean.map_or(String::new(), |mean| format!("  mean {}", percent(mean)));
            lines.push(pen.text(mean, Paint::Dim).line());
        }
    }
    lines
}

/// The mean of the better half of the generation shown.
fn mean(context: &ViewContext, state_type: usize, primitive: &str) -> Option<f64> {
    let of = context.shown()?.selection_probabilities.get(state_type)?;
    of.as_ref()?.get(primitive).copied()
}

/// The same as a table.
pub(super) fn csv(context: &ViewContext, selection: &SelectionProbabilities) -> String {
    let catalogue = context.catalogue();
    let mut csv = String::from("state_type,primitive,probability\n");
    for (index, shares) in selection.iter().enumerate() {
        let shares = shares.iter().flatten();
        for (primitive, share) in catalogue.primitives().zip(shares) {
            let name = primitive.name(catalogue);
            // Writing to a string cannot fail.
            let _ = writeln!(csv, "{},{name},{share}", index + 1);
        }
    }
    csv
}
