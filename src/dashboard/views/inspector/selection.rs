//! The selection page: selection probabilities, beside the mean of the better half.

use ratatui::text::Line;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::lines::{Pen, percent};
use crate::dashboard::look::{Paint, shortened, wrapped};
use crate::dashboard::views::policy::{SMALL, probability, title};
use crate::dashboard::views::shared::{csv_line, line};
use crate::learning::SelectionProbabilities;

/// Lists for each state type the primitive subtasks that the policy ends in.
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
        let title = wrapped(&title(index, about), columns, "  ").into_iter();
        lines.extend(title.map(|line| self::line(look, line, Paint::Title)));
        let Some(shares) = shares else {
            let text = "  does not occur in this arena";
            lines.push(line(look, text, Paint::Dim));
            continue;
        };
        for (place, (primitive, &share)) in catalogue.primitives().zip(shares).enumerate() {
            let name = primitive.name(catalogue);
            let mean = context
                .shown()
                .and_then(|shown| probability(shown, index, name));
            if share < SMALL && mean.is_none_or(|mean| mean < SMALL) {
                continue;
            }
            let pen = Pen::new(look)
                .to(2)
                .text(shortened(name, names, look.signs), Paint::Text)
                .to(2 + names)
                .right(&percent(share), 6, Paint::Title);
            let pen = if bar > 0 {
                let gap = pen.text("  ", Paint::Text);
                gap.bar(share, bar, Paint::series(place))
            } else {
                pen
            };
            let mean = mean.map_or(String::new(), |mean| format!("  mean {}", percent(mean)));
            lines.push(pen.text(mean, Paint::Dim).line());
        }
    }
    lines
}

/// Writes the selection probabilities as CSV.
pub(super) fn csv(context: &ViewContext, selection: &SelectionProbabilities) -> String {
    let catalogue = context.catalogue();
    let mut csv = String::from("state_type,primitive,probability\n");
    for (index, shares) in selection.iter().enumerate() {
        let shares = shares.iter().flatten();
        for (primitive, share) in catalogue.primitives().zip(shares) {
            let name = primitive.name(catalogue);
            csv_line(&mut csv, &[&(index + 1), &name, share]);
        }
    }
    csv
}
