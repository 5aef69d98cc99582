//! Curves over one quantity, sheets over two.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::values::largest;
use crate::dashboard::desk::Desk;
use crate::dashboard::look::{Canvas, Layer, Paint, fitted, put, width};
use crate::dashboard::views::lines::number;
use crate::lab::specimen::{Profile, Quantity};
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
        [low, high] if low < high => range,
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
    desk: &Desk,
    profile: &Profile,
    values: &[f64],
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &desk.look;
    let legend = legend(desk, profile, area, buffer);
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
    ends(desk, [left, right], chart, buffer);
}

/// Writes the ends of a scale below a chart.
fn ends(desk: &Desk, [left, right]: [f64; 2], chart: Rect, buffer: &mut Buffer) {
    let dim = desk.look.style(Paint::Dim);
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
fn legend(desk: &Desk, profile: &Profile, area: Rect, buffer: &mut Buffer) -> u16 {
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
        let style = desk.look.style(Paint::series(index));
        put(buffer, area, (column, top + row), text, style);
    }
    rows
}

/// Sheets over two quantities: one with the number of the largest, and one for each curve
/// in ten levels.
///
/// ```text
///  largest                     ApproachNest  0: -3.2 9: -0.4
///  222222111111112222222       001234567765432100
/// ```
pub(super) fn sheets(
    desk: &Desk,
    profile: &Profile,
    down: &Scale,
    area: Rect,
    buffer: &mut Buffer,
) {
    let size = (profile.across.len() as u16, down.len() as u16 + 2);
    let legend = legend(desk, profile, area, buffer) + 1;
    let room = Rect {
        height: area.height.saturating_sub(legend),
        ..area
    };
    let each = (size.0 + 3).max(1);
    let across = (room.width / each).max(1);
    let compares = matches!(
        profile.quantity,
        Quantity::Preference | Quantity::Probability
    );
    let first = compares.then_some(None);
    let all = first.into_iter().chain((0..profile.curves.len()).map(Some));
    for (index, which) in all.enumerate() {
        let index = index as u16;
        let (column, row) = (index % across * each, index / across * (size.1 + 1));
        let place = Rect {
            x: room.x + column,
            y: room.y + row,
            width: size.0 + 2,
            height: size.1,
        };
        let place = place.intersection(room);
        if place.height > 2 {
            sheet(desk, profile, down, which, place, buffer);
        }
    }
    let units = format!(
        "across: {} {} to {}; down: {} {} to {}",
        profile.across.name().replace('_', " "),
        profile.across.label(0),
        profile.across.label(profile.across.len().saturating_sub(1)),
        down.name().replace('_', " "),
        down.label(0),
        down.label(down.len().saturating_sub(1)),
    );
    let units = fitted(&units, usize::from(area.width), desk.look.signs);
    let row = area.height.saturating_sub(legend);
    put(buffer, area, (0, row), &units, desk.look.style(Paint::Dim));
}

/// One sheet: of a curve, or of which curve is largest.
fn sheet(
    desk: &Desk,
    profile: &Profile,
    down: &Scale,
    which: Option<usize>,
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &desk.look;
    let [low, high] = range(profile);
    let curve = which.and_then(|index| profile.curves.get(index));
    let title = match (which, curve) {
        (Some(index), Some(curve)) => format!("{} {}", sign(index), curve.label),
        _ => String::from("the largest"),
    };
    let title = fitted(&title, usize::from(area.width), look.signs);
    put(buffer, area, (0, 0), &title, look.style(Paint::Title));
    let columns = profile.across.len().max(1);
    for row in 0..down.len() {
        for column in 0..columns {
            let place = row * columns + column;
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
            let at = (column as u16, row as u16 + 1);
            put(
                buffer,
                area,
                at,
                text.encode_utf8(&mut [0; 4]),
                look.style(paint),
            );
        }
    }
    if which.is_some() {
        let text = format!("0: {}  9: {}", number(low), number(high));
        let row = down.len() as u16 + 1;
        put(buffer, area, (0, row), &text, look.style(Paint::Dim));
    }
}
