//! Charts of learned values: curves over one input, sheets of digits over two.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::lines::{TINY, number};
use crate::dashboard::look::{Canvas, Layer, Look, Paint, put, shortened, width, wrapped};
use crate::lab::inspection::{Profile, Quantity};
use crate::worlds::scene::Scale;

/// Columns for the numbers beside a chart.
const MARGIN: u16 = 9;

/// Returns the smallest and the largest value of a profile.
fn range(profile: &Profile) -> [f32; 2] {
    let values = profile.curves.iter().flat_map(|curve| &curve.values);
    let range = values.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], &value| {
        [low.min(value), high.max(value)]
    });
    match range {
        // Smaller differences are noise, not a curve.
        [low, high] if high - low >= TINY => range,
        [low, _] if low.is_finite() => [low - 0.5, low + 0.5],
        _ => [0.0, 1.0],
    }
}

/// Returns the number of a curve as a character: curves must be told apart without colours.
fn sign(index: usize) -> char {
    char::from_digit(index as u32 + 1, 36).unwrap_or('?')
}

/// Draws curves over an input, each with its number on it.
///
/// ```text
///   -0.100 │  ⣀⡠1⠤⠒⠉⠉
///          │⠒⠉     2⠒⠤⣀
///   -0.900 │           ⠉
///          -60        60
///  1 (450,450)  2 (150,450)
/// ```
pub(super) fn curves(
    context: &ViewContext,
    profile: &Profile,
    values: &[f64],
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &context.look;
    let legend = legend(context, profile, area, buffer);
    let chart = Rect {
        x: area.x + MARGIN.min(area.width),
        width: area.width.saturating_sub(MARGIN),
        height: area.height.saturating_sub(legend + 1),
        ..area
    };
    let (Some(&left), Some(&right)) = (values.first(), values.last()) else {
        return;
    };
    if chart.is_empty() || left >= right {
        return;
    }
    let [low, high] = range(profile);
    let origin = [left, f64::from(low)];
    let extent = [right - left, f64::from(high - low)];
    let mut canvas = Canvas::new(look, chart, origin, extent);
    for (index, curve) in profile.curves.iter().enumerate() {
        let points = values.iter().zip(&curve.values);
        let points: Vec<_> = points.map(|(&x, &y)| [x, f64::from(y)]).collect();
        for pair in points.windows(2) {
            let layer = Layer::Curve(index as u8);
            canvas.line(pair[0], pair[1], layer, Paint::series(index));
        }
    }
    canvas.finish(buffer);
    number_curves(look, profile, values, (&canvas, chart), buffer);
    let mut label = |at, text: &str| put(buffer, area, at, text, look.style(Paint::Dim));
    label((0, 0), &format!("{:>8}", number(high)));
    label((0, chart.height - 1), &format!("{:>8}", number(low)));
    label((MARGIN, chart.height), &left.to_string());
    let right = right.to_string();
    let at = MARGIN + chart.width.saturating_sub(width(&right) as u16);
    label((at, chart.height), &right);
}

/// Writes the numbers of the curves onto them.
fn number_curves(
    look: &Look,
    profile: &Profile,
    values: &[f64],
    (canvas, chart): (&Canvas<'_>, Rect),
    buffer: &mut Buffer,
) {
    let count = profile.curves.len().max(1);
    for (index, curve) in profile.curves.iter().enumerate() {
        // Staggered, so that the numbers of close curves do not overlap.
        let places = (index..values.len()).step_by(2 * count);
        for place in places.skip(usize::from(values.len() > 4 * count)) {
            let at = [values[place], f64::from(curve.values[place])];
            if let Some(cell) = canvas.cell(at) {
                let style = look.style(Paint::series(index));
                put(buffer, chart, cell, &sign(index).to_string(), style);
            }
        }
    }
}

/// Writes the labels of the curves at the bottom of the area; returns the rows used.
fn legend(context: &ViewContext, profile: &Profile, area: Rect, buffer: &mut Buffer) -> u16 {
    let entries = profile.curves.iter().enumerate();
    let entries: Vec<_> = entries
        .map(|(index, curve)| (index, format!("{} {}   ", sign(index), curve.label)))
        .collect();
    let mut places = Vec::new();
    let (mut column, mut row) = (0, 0);
    for (index, text) in &entries {
        let needed = width(text) as u16;
        if column > 0 && column + needed > area.width {
            column = 0;
            row += 1;
        }
        places.push((column, row, *index, text));
        column += needed;
    }
    let rows = row + 1;
    let top = area.height.saturating_sub(rows);
    for (column, row, index, text) in places {
        let style = context.look.style(Paint::series(index));
        put(buffer, area, (column, top + row), text, style);
    }
    rows
}

/// Draws sheets over two inputs: one with the number of the largest curve, and one for each
/// curve in ten levels.
///
/// ```text
///  the largest                 1 ApproachNest
///  222222111111112222222       001234567765432100
///  0: -3.2  9: -0.4
///  across angle deg -60 to 60, down distance mm 437 to 3500
/// ```
pub(super) fn sheets(
    context: &ViewContext,
    profile: &Profile,
    down: &Scale,
    area: Rect,
    buffer: &mut Buffer,
) {
    let legend = sheet_legend(profile, down, area.width.into());
    let room = Rect {
        height: area.height.saturating_sub(legend.len() as u16),
        ..area
    };
    let compares = matches!(
        profile.quantity,
        Quantity::Preference | Quantity::Probability
    );
    let first = compares.then_some(None);
    let all = first.into_iter().chain((0..profile.curves.len()).map(Some));
    let all: Vec<_> = all.collect();
    let (grain, across) = Grain::fitting(profile, down, all.len(), room);
    for (index, which) in all.into_iter().enumerate() {
        let (width, height) = (grain.width(profile), grain.height(down));
        let (column, row) = (index % across, index / across);
        let place = Rect {
            x: room.x.saturating_add((column * (width + GAP)) as u16),
            y: room.y.saturating_add((row * (height + 2)) as u16),
            width: (width + GAP - 1) as u16,
            height: (height + 1) as u16,
        };
        let place = place.intersection(room);
        sheet(&context.look, profile, (which, grain), place, buffer);
    }
    for (row, text) in (room.height..).zip(&legend) {
        let dim = context.look.style(Paint::Dim);
        put(buffer, area, (0, row), text, dim);
    }
}

/// Returns the legend of sheets: the range of the digits, and the inputs across and down.
fn sheet_legend(profile: &Profile, down: &Scale, columns: usize) -> Vec<String> {
    let [low, high] = range(profile);
    let ends = |scale: &Scale| {
        let last = scale.len().saturating_sub(1);
        let name = scale.name().replace('_', " ");
        format!("{name} {} to {}", scale.label(0), scale.label(last))
    };
    let digits = format!("0: {}  9: {}", number(low), number(high));
    let across = format!("across {}, down {}", ends(&profile.across), ends(down));
    let mut lines = vec![digits];
    lines.extend(wrapped(&across, columns, ""));
    lines
}

/// Columns between sheets.
const GAP: usize = 3;
/// Fewest columns of a sheet: room for its title.
const TITLE: usize = 15;

/// How finely a sheet is drawn.
#[derive(Clone, Copy)]
struct Grain {
    /// Columns per value.
    repeat: usize,
    /// Values per drawn value, along rows and along columns.
    stride: [usize; 2],
}

impl Grain {
    /// Returns the finest grain at which all sheets fit, and the number of sheets side by side.
    fn fitting(profile: &Profile, down: &Scale, sheets: usize, room: Rect) -> (Self, usize) {
        const GRAINS: [(usize, [usize; 2]); 6] = [
            (4, [1, 1]),
            (2, [1, 1]),
            (1, [1, 1]),
            (1, [2, 1]),
            (1, [2, 2]),
            (1, [4, 4]),
        ];
        let grains = GRAINS.map(|(repeat, stride)| {
            let grain = Self { repeat, stride };
            let across = (usize::from(room.width) + GAP) / (grain.width(profile) + GAP);
            let rows = (usize::from(room.height) + 1) / (grain.height(down) + 2);
            (grain, across.max(1), across * rows >= sheets)
        });
        let fitting = grains.iter().find(|(.., fits)| *fits);
        let &(grain, across, _) = fitting.unwrap_or(&grains[GRAINS.len() - 1]);
        (grain, across)
    }

    fn width(self, profile: &Profile) -> usize {
        (profile.across.len().div_ceil(self.stride[0]) * self.repeat).max(TITLE)
    }

    fn height(self, down: &Scale) -> usize {
        down.len().div_ceil(self.stride[1])
    }
}

/// Draws one sheet: of one curve, or of the number of the largest curve.
fn sheet(
    look: &Look,
    profile: &Profile,
    (which, grain): (Option<usize>, Grain),
    area: Rect,
    buffer: &mut Buffer,
) {
    let [low, high] = range(profile);
    let curve = which.and_then(|index| profile.curves.get(index));
    let title = match (which, curve) {
        (Some(index), Some(curve)) => {
            let room = usize::from(area.width.saturating_sub(2));
            let label = shortened(&curve.label, room, look.signs);
            format!("{} {label}", sign(index))
        }
        _ => String::from("the largest"),
    };
    put(buffer, area, (0, 0), &title, look.style(Paint::Title));
    let columns = profile.across.len().max(1);
    let values = profile.curves.first().map_or(0, |curve| curve.values.len());
    let rows = (0..values / columns).step_by(grain.stride[1]);
    for (row, from_row) in rows.enumerate() {
        let mut column = 0;
        for from_column in (0..columns).step_by(grain.stride[0]) {
            let place = from_row * columns + from_column;
            let (text, paint) = match curve {
                Some(curve) => {
                    let value = curve.values.get(place).copied().unwrap_or(low);
                    let level = ((value - low) / (high - low) * 10.0).clamp(0.0, 9.0) as u32;
                    let digit = char::from_digit(level, 10).unwrap_or(' ');
                    (digit, Paint::series(which.unwrap_or(0)))
                }
                None => {
                    let best = largest(profile, place).unwrap_or(0);
                    (sign(best), Paint::series(best))
                }
            };
            let text = text.to_string().repeat(grain.repeat);
            let at = (column, row as u16 + 1);
            column = put(buffer, area, at, &text, look.style(paint));
        }
    }
}

/// Returns the curve with the largest value at a place; the first of equals.
pub(super) fn largest(profile: &Profile, place: usize) -> Option<usize> {
    let values = profile.curves.iter().map(|curve| curve.values.get(place));
    let best = values
        .enumerate()
        .filter_map(|(index, value)| Some((index, *value?)));
    best.reduce(|best, next| if next.1 > best.1 { next } else { best })
        .map(|(index, _)| index)
}
