//! Draws figures as text for a terminal.

use std::fmt::Write;

use super::{Chart, Figure, Panel, tick};
use crate::hierarchy::Glyphs;
use crate::report::table::short;

/// Lines of a chart.
const HEIGHT: usize = 16;
/// Columns for the numbers at the vertical axis.
const MARGIN: usize = 9;
/// Smallest width of a chart in columns.
const MIN_COLUMNS: usize = 30;
/// Characters that points are drawn with, by the index of the series.
const CHARACTERS: &[u8] = b"123456789abcdefghijklmnopqrstuvwxyz";

/// Draws the figure, one panel below the other.
pub(super) fn draw(figure: &Figure, columns: usize) -> String {
    let mut text = figure.full_title() + "\n";
    for panel in &figure.panels {
        text.push('\n');
        match panel {
            Panel::Chart(chart) => text += &draw_chart(chart, columns),
            Panel::Tree(sketch) => {
                let [unicode, ascii] = &sketch.lines;
                let lines = match Glyphs::of_locale() {
                    Glyphs::Unicode => unicode,
                    Glyphs::Ascii => ascii,
                };
                // Writing to a string cannot fail.
                let _ = writeln!(text, "{}\n{}", sketch.caption, lines.join("\n"));
            }
        }
    }
    text + "\n" + &figure.provenance + "\n"
}

fn draw_chart(chart: &Chart, columns: usize) -> String {
    let Some([(left, right), (bottom, top)]) = chart.ranges() else {
        return format!("{}\n(no data)\n", chart.title);
    };
    let width = columns.max(MIN_COLUMNS) - MARGIN - 2;
    let mut grid = vec![vec![b' '; width]; HEIGHT];
    let place = |value: f64, low: f64, high: f64, cells: usize| {
        (((value - low) / (high - low) * (cells - 1) as f64).round() as usize).min(cells - 1)
    };
    // The first series is drawn last, so that it lies on top.
    for series in chart.series.iter().rev() {
        let character = CHARACTERS[series.mark % CHARACTERS.len()];
        let points = series.points.iter();
        for &(x, y) in points.filter(|(x, y)| x.is_finite() && y.is_finite()) {
            let row = HEIGHT - 1 - place(y, bottom, top, HEIGHT);
            grid[row][place(x, left, right, width)] = character;
        }
    }
    let mut text = format!("{}\n{}\n", chart.title, chart.y);
    for (index, row) in grid.iter().enumerate() {
        let share = 1.0 - index as f64 / (HEIGHT - 1) as f64;
        let label = match index % 5 {
            0 => short(bottom + share * (top - bottom)),
            _ => String::new(),
        };
        let _ = writeln!(
            text,
            "{label:>MARGIN$} |{}",
            String::from_utf8_lossy(row).trim_end()
        );
    }
    let _ = writeln!(text, "{:>MARGIN$} +{}", "", "-".repeat(width));
    let (left, right) = (tick(left), tick(right));
    let gap = width.saturating_sub(left.len() + right.len());
    let _ = writeln!(text, "{:>MARGIN$}  {left}{:gap$}{right}", "", "");
    let _ = writeln!(text, "{:>MARGIN$}  {}", "", chart.x);
    for series in &chart.series {
        let _ = writeln!(
            text,
            "{:>MARGIN$}  {} {}",
            "",
            char::from(CHARACTERS[series.mark % CHARACTERS.len()]),
            series.name
        );
    }
    text
}
