//! Curves over a common axis.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::Look;
use super::canvas::{Canvas, Layer};
use super::paint::Paint;
use super::text::{put, width};

/// A curve: its points from left to right, and its paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Places; where one is missing the curve is broken.
    pub points: Vec<Option<[f64; 2]>>,
    /// How it is painted.
    pub paint: Paint,
    /// A letter at its end, so that it is told from others without colours too.
    pub letter: Option<char>,
}

/// Curves over a common axis.
///
/// ```text
/// 1006 ⠒⢄   │      the largest value
///      ⠈⠢⡀ ⢀┼⠔⠒    the cursor at a place of the axis
/// 390    ⠑⠒⠁│      the smallest value
///      1   12 30   the ends of the axis and the cursor
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// The curves; the first is drawn over the others.
    pub curves: Vec<Curve>,
    /// Ends of the axis.
    pub across: [f64; 2],
    /// Smallest and largest value shown.
    pub up: [f64; 2],
    /// A place of the axis that is marked.
    pub cursor: Option<f64>,
    /// Digits after the point of the values' labels.
    pub digits: usize,
}

impl Chart {
    /// A chart that shows all points of some curves, and these values at least.
    #[must_use]
    pub fn of(curves: Vec<Curve>, least: [f64; 2]) -> Self {
        let points = || {
            curves
                .iter()
                .flat_map(|curve| curve.points.iter().flatten())
        };
        let range = |axis: usize, from: [f64; 2]| {
            points()
                .map(|point| point[axis])
                .fold(from, |[low, high], value| [low.min(value), high.max(value)])
        };
        let across = widened(range(0, [f64::INFINITY, f64::NEG_INFINITY]));
        let up = widened(range(1, least));
        Self {
            across,
            up,
            curves,
            cursor: None,
            digits: 0,
        }
    }

    /// Draws it; the labels of the axis take the last row, those of the values the
    /// first columns.
    pub fn draw(&self, look: &Look, area: Rect, buffer: &mut Buffer) {
        let dim = look.style(Paint::Dim);
        let digits = self.digits;
        let labels = [self.up[1], self.up[0]].map(|value| format!("{value:.digits$}"));
        let left = labels.iter().map(|label| width(label)).max().unwrap_or(0) + 1;
        let left = u16::try_from(left).unwrap_or(u16::MAX).min(area.width);
        let axis = u16::from(area.height > 2);
        let plot = Rect {
            x: area.x + left,
            width: area.width - left,
            height: area.height - axis,
            ..area
        };
        put(buffer, area, (0, 0), &labels[0], dim);
        if plot.height > 1 {
            put(buffer, area, (0, plot.height - 1), &labels[1], dim);
        }
        let extent = [self.across[1] - self.across[0], self.up[1] - self.up[0]];
        let mut canvas = Canvas::new(look, plot, [self.across[0], self.up[0]], extent);
        self.draw_cursor(look, &canvas, plot, buffer);
        for (order, curve) in self.curves.iter().enumerate().rev() {
            let layer = Layer::Curve(u8::try_from(self.curves.len() - order).unwrap_or(u8::MAX));
            draw_curve(&mut canvas, curve, layer);
        }
        canvas.finish(buffer);
        for curve in self.curves.iter().rev() {
            let end = curve.points.iter().flatten().last();
            let cell = end.and_then(|end| canvas.cell(*end));
            if let (Some(letter), Some(cell)) = (curve.letter, cell) {
                put(
                    buffer,
                    plot,
                    cell,
                    &letter.to_string(),
                    look.style(curve.paint),
                );
            }
        }
        if axis == 1 {
            self.draw_axis(look, &canvas, plot, buffer);
        }
    }

    fn draw_cursor(&self, look: &Look, canvas: &Canvas<'_>, plot: Rect, buffer: &mut Buffer) {
        let column = self.cursor.and_then(|at| canvas.cell([at, self.up[0]]));
        if let Some((column, _)) = column {
            for row in 0..plot.height {
                let style = look.style(Paint::Dim);
                put(buffer, plot, (column, row), look.signs.cursor, style);
            }
        }
    }

    fn draw_axis(&self, look: &Look, canvas: &Canvas<'_>, plot: Rect, buffer: &mut Buffer) {
        let dim = look.style(Paint::Dim);
        let line = Rect {
            y: plot.bottom(),
            height: 1,
            ..plot
        };
        let [first, last] = self.across.map(|at| format!("{at:.0}"));
        put(buffer, line, (0, 0), &first, dim);
        let columns = |text: &str| u16::try_from(width(text)).unwrap_or(u16::MAX);
        let right = line.width.saturating_sub(columns(&last));
        if right > columns(&first) {
            put(buffer, line, (right, 0), &last, dim);
        }
        let cursor = self.cursor.and_then(|at| canvas.cell([at, self.up[0]]));
        if let (Some((column, _)), Some(at)) = (cursor, self.cursor) {
            let text = format!("{at:.0}");
            let from = column.saturating_sub(columns(&text) / 2);
            if from > columns(&first) && from + columns(&text) < right {
                put(buffer, line, (from, 0), &text, look.style(Paint::Title));
            }
        }
    }
}

/// A range that is one.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    match (low.is_finite() && high.is_finite(), high > low) {
        (true, true) => [low, high],
        (true, false) => [low, low + 1.0],
        (false, _) => [0.0, 1.0],
    }
}

fn draw_curve(canvas: &mut Canvas<'_>, curve: &Curve, layer: Layer) {
    for point in curve.points.iter().flatten() {
        canvas.point(*point, layer, curve.paint);
    }
    for (from, to) in curve.points.iter().zip(curve.points.iter().skip(1)) {
        if let (Some(from), Some(to)) = (from, to) {
            canvas.line(*from, *to, layer, curve.paint);
        }
    }
}
