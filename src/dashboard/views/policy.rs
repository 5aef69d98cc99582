//! Which primitive subtasks the policies select.

use std::collections::BTreeMap;
use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;

use super::shared::{THROUGH_TIME, nothing_yet, over_generations};
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::percent;
use crate::dashboard::look::{
    Chart, Curve, Paint, fitted, one_line, put, shortened, sparkline, width,
};
use crate::evolution::GenerationRecord;

/// Primitive-selection probabilities of each state type (Thesis Figure 4.10): now, as a
/// bar, and over generations, as curves.
///
/// ```text
///  ╭ Policy  primitive subtask selected ──────╮
///  │ 2 empty-handed, a battery visible        │
///  │ ApproachBattery 53 %  |Wander 47 %       │
///  │ 1 ⠒⢄⡠⠔⠒│⠒⠒                               │
///  │ 0 ⠑⠒⠤⠔⠒┼⠒⠉                               │
///  ╰──────────────────────────────────────────╯
/// ```
pub(super) struct Policy;

/// Rows of a state type from which on there are curves.
const WITH_CURVES: u16 = 4;
/// Columns from which on two state types stand beside each other.
const TWO_COLUMNS: u16 = 90;
/// Probabilities below this are not named.
const SMALL: f64 = 0.005;

impl View for Policy {
    fn name(&self) -> &'static str {
        "policy"
    }

    fn title(&self) -> &'static str {
        "Policy"
    }

    fn caption(&self, context: &ViewContext) -> String {
        let separator = context.look.signs.separator;
        format!("primitives selected {separator} mean of the better half")
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let Some(record) = context.shown() else {
            return nothing_yet(context, area, buffer);
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
                    let (number, name) = (record.generation, one_line(name));
                    // Writing to a string cannot fail.
                    let _ = writeln!(csv, "{number},{},{name},{share}", index + 1);
                }
            }
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "With which probability the policy, followed from the root down, ends in each primitive\n\
         subtask, averaged over sampled states of a type and the better half of the population\n\
         (Thesis 4.5.4): now, and over generations (Figure 4.10). A type with one primitive has\n\
         its behaviour settled by the structure; where there are two, learning chooses."
    }
}

/// The title of a state type.
pub(super) fn title(index: usize, description: &str) -> String {
    format!("{} {description}", index + 1)
}

/// A place for each state type, as many as there is room for.
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
    let line = |row: u16| Rect {
        y: area.y + row,
        height: u16::from(row < area.height),
        ..area
    };
    let info = context.catalogue().state_types.get(index);
    let title = title(index, info.map_or("", |info| &info.description));
    let room = usize::from(area.width.saturating_sub(1));
    let title = fitted(&title, room, look.signs);
    let bar_row = u16::from(area.height > 1);
    if bar_row == 1 {
        put(buffer, line(0), (1, 0), &title, look.style(Paint::Title));
    }
    match &record.selection_probabilities[index] {
        Some(of) => draw_bar(context, of, line(bar_row), buffer),
        None => {
            let text = "no such state in this arena";
            put(buffer, line(bar_row), (1, 0), text, look.style(Paint::Dim));
        }
    }
    if area.height + 1 == WITH_CURVES {
        draw_course(context, record, index, line(2), buffer);
    }
    if area.height >= WITH_CURVES {
        let below = Rect {
            x: area.x + 1.min(area.width),
            y: area.y + 2,
            width: area.width.saturating_sub(1),
            height: area.height - 2,
        };
        chart(context, index).draw(look, below, buffer);
    }
}

/// The course of the primitive subtask that is selected most now.
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
    let shares = records.filter_map(|record| {
        let of = record.selection_probabilities.get(index)?.as_ref()?;
        of.get(name).copied()
    });
    let shares: Vec<_> = shares.collect();
    let columns = usize::from(line.width.saturating_sub(2));
    let text = sparkline(&shares, [0.0, 1.0], columns, context.look.signs);
    // Not in the colour of the bar above it: the two would be one.
    put(buffer, line, (1, 0), &text, context.look.style(Paint::Dim));
}

/// The paint of a primitive subtask.
fn paint(context: &ViewContext, name: &str) -> Paint {
    let catalogue = context.catalogue();
    let mut primitives = catalogue.primitives();
    let place = primitives.position(|primitive| primitive.name(catalogue) == name);
    Paint::series(place.unwrap_or(0))
}

/// Parts of a bar, as long as they are probable.
fn draw_bar(context: &ViewContext, of: &BTreeMap<String, f64>, line: Rect, buffer: &mut Buffer) {
    let look = &context.look;
    let mut parts: Vec<_> = of.iter().filter(|(_, share)| **share >= SMALL).collect();
    parts.sort_by(|a, b| b.1.total_cmp(a.1));
    let columns = f64::from(line.width.saturating_sub(2));
    let (mut sum, mut from) = (0.0, 1);
    for (index, (name, share)) in parts.iter().enumerate() {
        sum += **share;
        let to = 1 + (sum.min(1.0) * columns).round() as u16;
        let style = look
            .style(paint(context, name))
            .add_modifier(Modifier::REVERSED);
        let room = usize::from(to.saturating_sub(from));
        let separator = if index > 0 { "|" } else { "" };
        let room_for_label = room.saturating_sub(separator.len());
        let text = label(context, &one_line(name), **share, room_for_label);
        let text = format!("{separator}{text}");
        let text = fitted(&format!("{text:<room$}"), room, look.signs);
        from = put(buffer, line, (from, 0), &text, style);
    }
}

/// Least columns of a shortened name.
const SHORT: usize = 8;

/// Name and share, as much of it as there is room for: the share is read off the bar too.
fn label(context: &ViewContext, name: &str, share: f64, room: usize) -> String {
    if room < 3 {
        return String::new();
    }
    let percent = format!(" {}", percent(share));
    let rest = room.saturating_sub(width(&percent));
    let percent = match rest >= width(name).min(SHORT) {
        true => percent,
        false => String::new(),
    };
    let name = shortened(
        name,
        room.saturating_sub(width(&percent)),
        context.look.signs,
    );
    name + &percent
}

fn chart(context: &ViewContext, index: usize) -> Chart {
    let catalogue = context.catalogue();
    let (records, letters) = (context.history().generations(), catalogue.letters());
    let curves = catalogue
        .primitives()
        .enumerate()
        .map(|(place, primitive)| {
            let name = primitive.name(catalogue);
            let share = |record: &GenerationRecord| {
                let of = record.selection_probabilities.get(index)?.as_ref()?;
                Some([record.generation as f64, *of.get(name)?])
            };
            Curve {
                points: records.iter().map(|record| share(record)).collect(),
                paint: Paint::series(place),
                letter: letters.get(place).copied(),
            }
        });
    // A primitive that is never selected has no curve to look at.
    let curves = curves.filter(|curve| {
        let mut points = curve.points.iter().flatten();
        points.any(|point| point[1] >= SMALL)
    });
    over_generations(context, curves.collect(), [0.0, 1.0])
}
