//! Curves over one quantity, sheets over two.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::lines::{TINY, number};
use crate::dashboard::look::{Canvas, Layer, Paint, put, shortened, width, wrapped};
use crate::lab::inspection::{Profile, Quantity};
use crate::worlds::scene::Scale;

/// Columns of the numbers beside a chart.
const MARGIN: u16 = 9;

/// The smallest and the largest value of a profile.
fn range(profile: &Profile) -> [f32; 2] {
    let values = profile.curves.iter().flat_map(|curve| &curve.values);
    let range = values.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], &value| {
        [low.min(value), high.max(value)]
    });
    match range {
        // What differs by less is noise, not a curve.
        [low, high] if high - low >= TINY => range,
        [low, _] if low.is_finite() => [low - 0.5, low + 0.5],
        _ => [0.0, 1.0],
    }
}

/// The sign of a curve: its number, so that curves are told apart without colour.
fn sign(index: usize) -> char {
    char::from_digit(index as u32 + 1, 36).unwrap_or('?')
}

/// Curves over a quantity, each with its number on it.
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
            canvas.line(
                pair[0],
                pair[1],
                Layer::Curve(index as u8),
                Paint::series(index),
            );
        }
    }
    canvas.finish(buffer);
    let count = profile.curves.len().max(1);
    for (index, curve) in profile.curves.iter().enumerate() {
        // Staggered, so that labels of curves close to each other do not meet.
        let places = (index..values.len()).step_by(2 * count);
        for place in places.skip(usize::from(values.len() > 4 * count)) {
            let at = [values[place], f64::from(curve.values[place])];
            if let Some(cell) = canvas.cell(at) {
                let style = look.style(Paint::series(index));
                put(buffer, chart, cell, &sign(index).to_string(), style);
            }
        }
    }
    let dim = look.style(Paint::Dim);
    put(buffer, area, (0, 0), &format!("{:>8}", number(high)), dim);
    let last = chart.height.saturating_sub(1);
    put(buffer, area, (0, last), &format!("{:>8}", number(low)), dim);
    ends(context, [left, right], chart, buffer);
}

/// Writes the ends of a scale below a chart.
fn ends(context: &ViewContext, [left, right]: [f64; 2], chart: Rect, buffer: &mut Buffer) {
    let dim = context.look.style(Paint::Dim);
    let line = Rect {
        y: chart.bottom(),
        height: 1,
        ..chart
    };
    put(buffer, line, (0, 0), &left.to_string(), dim);
    let right = right.to_string();
    let at = chart.width.saturating_sub(width(&right) as u16);
    put(buffer, line, (at, 0), &right, dim);
}

/// Writes which curve is which at the bottom of the area; returns the lines it took.
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

/// Sheets over two quantities: one with the number of the largest, and one for each curve
/// in ten levels.
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
        sheet(
            context,
            profile,
            which,
            grain,
            place.intersection(room),
            buffer,
        );
    }
    for (row, text) in (0..).zip(&legend) {
        let dim = context.look.style(Paint::Dim);
        put(
            buffer,
            area,
            (0, room.height.saturating_add(row)),
            text,
            dim,
        );
    }
}

/// What the digits of sheets mean, and what is across and down.
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
/// Least columns of a sheet: room for its title.
const TITLE: usize = 15;

/// How finely a sheet is drawn.
#[derive(Clone, Copy)]
struct Grain {
    /// Cells of the terminal for a value.
    repeat: usize,
    /// Every so many values of a row, and of a column, one is drawn.
    stride: [usize; 2],
}

impl Grain {
    /// The finest grain with which all sheets find room, and how many then stand side by
    /// side.
    fn fitting(profile: &Profile, down: &Scale, sheets: usize, room: Rect) -> (Self, usize) {
        const GRAINS: [(usize, [usize; 2]); 6] = [
            (4, [1, 1]),
            (2, [1, 1]),
            (1, [1, 1]),
            (1, [2, 1]),
            (1, [2, 2]),
            (1, [4, 4]),
        ];
        let mut last = (
            Self {
                repeat: 1,
                stride: [1, 1],
            },
            1,
        );
        for (repeat, stride) in GRAINS {
            let grain = Self { repeat, stride };
            let across = (usize::from(room.width) + GAP) / (grain.width(profile) + GAP);
            let rows = (usize::from(room.height) + 1) / (grain.height(down) + 2);
            last = (grain, across.max(1));
            if across * rows >= sheets {
                break;
            }
        }
        last
    }

    fn width(self, profile: &Profile) -> usize {
        (profile.across.len().div_ceil(self.stride[0]) * self.repeat).max(TITLE)
    }

    fn height(self, down: &Scale) -> usize {
        down.len().div_ceil(self.stride[1])
    }
}

/// One sheet: of a curve, or of which curve is largest.
fn sheet(
    context: &ViewContext,
    profile: &Profile,
    which: Option<usize>,
    grain: Grain,
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &context.look;
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

/// The curve that is highest at a place, the first of equals.
pub(super) fn largest(profile: &Profile, place: usize) -> Option<usize> {
    let values = profile.curves.iter().map(|curve| curve.values.get(place));
    let best = values
        .enumerate()
        .filter_map(|(index, value)| Some((index, *value?)));
    best.reduce(|best, next| if next.1 > best.1 { next } else { best })
        .map(|(index, _)| index)
}
