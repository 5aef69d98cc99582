//! The policy view: which primitive subtasks the policies select.

use std::collections::BTreeMap;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;

use super::shared::{
    THROUGH_TIME, below, csv_line, draw_no_generation, over_generations, right_of, row,
};
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::percent;
use crate::dashboard::look::{
    Chart, Curve, Paint, fitted, one_line, put, shortened, sparkline, width,
};
use crate::evolution::GenerationRecord;

/// Primitive-selection probabilities of each state type (Thesis Figure 4.10), as a bar for the
/// generation shown and as curves over generations.
///
/// ```text
///  ╭ Policy  selection probabilities ─────────╮
///  │ 2 empty-handed, a battery visible        │
///  │ ApproachBattery 53 %  |Wander 47 %       │
///  │ 1 ⠒⢄⡠⠔⠒│⠒⠒                               │
///  │ 0 ⠑⠒⠤⠔⠒┼⠒⠉                               │
///  ╰──────────────────────────────────────────╯
/// ```
pub(super) struct Policy;

/// From this many rows on, a state type has curves.
const WITH_CURVES: u16 = 4;
/// From this many columns on, two state types stand side by side.
const TWO_COLUMNS: u16 = 90;
/// Most curves of a chart, of the primitive subtasks with the highest peaks.
const CURVES: usize = 6;
/// Smaller probabilities are left out.
pub(super) const SMALL: f64 = 0.005;

impl View for Policy {
    fn name(&self) -> &'static str {
        "policy"
    }

    fn title(&self) -> &'static str {
        "Policy"
    }

    fn caption(&self, context: &ViewContext) -> String {
        let separator = context.look.signs.separator;
        format!("selection probabilities {separator} mean of the better half")
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let Some(record) = context.shown() else {
            return draw_no_generation(context, area, buffer);
        };
        let types = record.selection_probabilities.len();
        for (index, place) in places(area, types).into_iter().enumerate() {
            draw_type(context, record, index, place, buffer);
        }
    }

    fn hints(&self) -> &'static [Action] {
        THROUGH_TIME
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let mut csv = String::from("generation,state_type,primitive,probability\n");
        for record in context.history().generations() {
            for (index, of) in record.selection_probabilities.iter().enumerate() {
                for (name, share) in of.iter().flatten() {
                    let (number, name) = (&record.generation, one_line(name));
                    csv_line(&mut csv, &[number, &(index + 1), &name, share]);
                }
            }
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "The probability that the policy, followed from the root down, ends in each primitive\n\
         subtask, as the mean over sampled states of a type and over the better half of the\n\
         population (Thesis 4.5.4): as bars for the generation shown, as curves over all\n\
         generations (Figure 4.10). If a type has only one primitive, the structure has settled\n\
         the behaviour; if it has more, learning decides. Of many primitives, the bar joins those\n\
         with the least shares, and the six with the highest peaks have curves."
    }
}

/// Returns the title of a state type.
pub(super) fn title(index: usize, description: &str) -> String {
    format!("{} {description}", index + 1)
}

/// Returns the areas of the state types, as many as fit.
fn places(area: Rect, types: usize) -> Vec<Rect> {
    let columns = if area.width >= TWO_COLUMNS { 2 } else { 1 };
    let types = types.min(usize::from(area.height) * columns);
    let rows = u16::try_from(types.div_ceil(columns)).unwrap_or(u16::MAX);
    let place = |index: usize| {
        let (column, row) = ((index % columns) as u16, (index / columns) as u16);
        let width = area.width / columns as u16;
        let height = area.height / rows;
        Rect {
            x: area.x + column * width,
            y: area.y + row * height,
            width: width.saturating_sub(column),
            height,
        }
    };
    (0..types).map(place).collect()
}

fn draw_type(
    context: &ViewContext,
    record: &GenerationRecord,
    index: usize,
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &context.look;
    let info = context.catalogue().state_types.get(index);
    let title = title(index, info.map_or("", |info| &info.description));
    let room = usize::from(area.width.saturating_sub(1));
    let title = fitted(&title, room, look.signs);
    let bar_row = u16::from(area.height > 1);
    if bar_row == 1 {
        put(buffer, area, (1, 0), &title, look.style(Paint::Title));
    }
    match &record.selection_probabilities[index] {
        Some(of) => draw_bar(context, of, row(area, bar_row), buffer),
        None => {
            let text = "does not occur in this arena";
            put(buffer, area, (1, bar_row), text, look.style(Paint::Dim));
        }
    }
    if area.height + 1 == WITH_CURVES {
        draw_course(context, record, index, row(area, 2), buffer);
    }
    if area.height >= WITH_CURVES {
        let below = right_of(below(area, 2), 1);
        chart(context, index).draw(look, below, buffer);
    }
}

/// Draws how the probability of the primitive subtask selected most has changed.
fn draw_course(
    context: &ViewContext,
    record: &GenerationRecord,
    index: usize,
    line: Rect,
    buffer: &mut Buffer,
) {
    let Some(of) = &record.selection_probabilities[index] else {
        return;
    };
    let Some((name, _)) = of.iter().max_by(|a, b| a.1.total_cmp(b.1)) else {
        return;
    };
    let records = context.history().generations().iter();
    let shares = records.filter_map(|record| probability(record, index, name));
    let shares: Vec<_> = shares.collect();
    let columns = usize::from(line.width.saturating_sub(2));
    let text = sparkline(&shares, [0.0, 1.0], columns, context.look.signs);
    // In the bar's colour, the line would merge with the bar above it.
    put(buffer, line, (1, 0), &text, context.look.style(Paint::Dim));
}

/// Returns the probability of selecting a primitive subtask in states of a type.
pub(super) fn probability(record: &GenerationRecord, index: usize, name: &str) -> Option<f64> {
    let of = record.selection_probabilities.get(index)?;
    of.as_ref()?.get(name).copied()
}

/// Returns the paint of a primitive subtask.
fn paint(context: &ViewContext, name: &str) -> Paint {
    let catalogue = context.catalogue();
    let mut primitives = catalogue.primitives();
    let place = primitives.position(|primitive| primitive.name(catalogue) == name);
    Paint::series(place.unwrap_or(0))
}

/// A part of a bar.
struct Part {
    name: String,
    share: f64,
    paint: Paint,
}

/// Returns the parts of a bar of some columns, the largest first. Several parts that are too
/// short for a name are one.
fn parts(context: &ViewContext, of: &BTreeMap<String, f64>, columns: f64) -> Vec<Part> {
    let shares = of.iter().filter(|(_, share)| **share >= SMALL);
    let mut parts: Vec<_> = shares
        .map(|(name, &share)| Part {
            name: one_line(name),
            share,
            paint: paint(context, name),
        })
        .collect();
    parts.sort_by(|a, b| b.share.total_cmp(&a.share));
    let named = parts.partition_point(|part| part.share * columns >= NAMED);
    if parts.len() > named + 1 && parts.len() > FEW {
        let rest = parts.split_off(named);
        let share: f64 = rest.iter().map(|part| part.share).sum();
        let count = rest.len();
        let name = if share * columns >= 2.0 * NAMED {
            format!("{count} more")
        } else {
            format!("+{count}")
        };
        let paint = Paint::Dim;
        parts.push(Part { name, share, paint });
    }
    parts
}

/// Draws a bar with a part for each primitive subtask, as long as it is probable.
fn draw_bar(context: &ViewContext, of: &BTreeMap<String, f64>, line: Rect, buffer: &mut Buffer) {
    let look = &context.look;
    let columns = f64::from(line.width.saturating_sub(2));
    let (mut sum, mut from) = (0.0, 1);
    for (index, part) in parts(context, of, columns).iter().enumerate() {
        sum += part.share;
        let to = 1 + (sum.min(1.0) * columns).round() as u16;
        let style = look.style(part.paint).add_modifier(Modifier::REVERSED);
        let room = usize::from(to.saturating_sub(from));
        let separator = if index > 0 { "|" } else { "" };
        let room_for_label = room.saturating_sub(separator.len());
        let text = label(context, &part.name, part.share, room_for_label);
        let text = format!("{separator}{text}");
        let text = fitted(&format!("{text:<room$}"), room, look.signs);
        from = put(buffer, line, (from, 0), &text, style);
    }
}

/// Fewest columns of a part with a name.
const NAMED: f64 = 5.0;
/// So many parts are drawn however short they are.
const FEW: usize = 5;

/// Fewest columns of a shortened name.
const SHORT: usize = 8;

/// Returns name and share, as far as they fit. The share gives way first: the bar shows it too.
fn label(context: &ViewContext, name: &str, share: f64, room: usize) -> String {
    if room < 3 {
        return String::new();
    }
    let percent = format!(" {}", percent(share));
    let rest = room.saturating_sub(width(&percent));
    if rest < width(name).min(SHORT) {
        return shortened(name, room, context.look.signs);
    }
    shortened(name, rest, context.look.signs) + &percent
}

fn chart(context: &ViewContext, index: usize) -> Chart {
    let catalogue = context.catalogue();
    let (records, letters) = (context.history().generations(), catalogue.letters());
    let curves = catalogue
        .primitives()
        .enumerate()
        .map(|(place, primitive)| {
            let name = primitive.name(catalogue);
            let point = |record: &GenerationRecord| {
                let share = probability(record, index, name)?;
                Some([record.generation as f64, share])
            };
            Curve {
                points: records.iter().map(|record| point(record)).collect(),
                paint: Paint::series(place),
                letter: letters.get(place).copied(),
            }
        });
    // A primitive that is never selected has no curve.
    let peak = |curve: &Curve| {
        let points = curve.points.iter().flatten();
        points.fold(0.0, |peak: f64, point| peak.max(point[1]))
    };
    let mut curves: Vec<_> = curves.filter(|curve| peak(curve) >= SMALL).collect();
    if curves.len() > CURVES {
        curves.sort_by(|a, b| peak(b).total_cmp(&peak(a)));
        curves.truncate(CURVES);
    }
    over_generations(context, curves, [0.0, 1.0])
}
