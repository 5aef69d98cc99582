//! Charts: curves over a common axis, and sparklines.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::Look;
use super::canvas::{Canvas, Layer};
use super::paint::Paint;
use super::signs::Signs;
use super::text::{put, width};

/// A curve: its points from left to right, and its paint.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The points; the curve is interrupted where one is missing.
    pub points: Vec<Option<[f64; 2]>>,
    /// The paint.
    pub paint: Paint,
    /// A letter at the end of the curve, which identifies it without colours.
    pub letter: Option<char>,
}

/// A chart: curves over a common axis.
///
/// ```text
/// 1006 ⠒⢄   │      the largest value
///      ⠈⠢⡀ ⢀┼⠔⠒    the cursor at a place of the axis
/// 390    ⠑⠒⠁│      the smallest value
///      1   12 30   the ends of the axis and the cursor
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// The curves; the first is drawn on top.
    pub curves: Vec<Curve>,
    /// The ends of the horizontal axis.
    pub across: [f64; 2],
    /// The smallest and the largest value shown.
    pub up: [f64; 2],
    /// A marked place on the horizontal axis.
    pub cursor: Option<f64>,
    /// Number of decimals in the labels of the values.
    pub digits: usize,
    /// Least columns before the curves, which align charts above each other.
    pub margin: u16,
}

impl Chart {
    /// Creates a chart that shows all points of the curves, and at least the values `least`.
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
            margin: 0,
        }
    }

    /// Rounds the range of values: round numbers read easily, and stay the same while values
    /// change a little.
    #[must_use]
    pub fn rounded(mut self) -> Self {
        let [low, high] = self.up;
        let step = round_up((high - low) / 20.0);
        if step.is_normal() {
            self.up = [(low / step).floor() * step, (high / step).ceil() * step];
            self.digits = digits(self.up);
        }
        self
    }

    /// Returns the labels of the largest and the smallest value.
    fn labels(&self) -> [String; 2] {
        let digits = self.digits;
        [self.up[1], self.up[0]].map(|value| format!("{value:.digits$}"))
    }

    /// Returns the number of columns before the curves.
    #[must_use]
    pub fn left(&self) -> u16 {
        let labels = self.labels();
        let widest = labels.iter().map(|label| width(label)).max().unwrap_or(0);
        self.margin
            .max(u16::try_from(widest + 1).unwrap_or(u16::MAX))
    }

    /// Draws the chart; the labels of the axis take the last row, those of the values the first
    /// columns.
    pub fn draw(&self, look: &Look, area: Rect, buffer: &mut Buffer) {
        let dim = look.style(Paint::Dim);
        let labels = self.labels();
        let left = self.left().min(area.width);
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

/// Rounds a positive value up to 1, 2 or 5 times a power of ten.
fn round_up(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|digit| digit * power);
    let fits = steps.into_iter().find(|step| *step >= value * (1.0 - 1e-9));
    fits.unwrap_or(10.0 * power)
}

/// Returns the number of decimals of two round numbers.
fn digits(numbers: [f64; 2]) -> usize {
    let is_whole = |number: f64| (number - number.round()).abs() < 1e-6;
    let shown = |digits: &i32| {
        numbers
            .iter()
            .all(|number| is_whole(number * 10_f64.powi(*digits)))
    };
    (0..6).find(shown).unwrap_or(6) as usize
}

/// Returns the end of an axis for a count that still grows: 10, 15, 20, 30, 40, 60 or 80 times
/// a power of ten that is at least `reached`, but at most `limit`.
///
/// The end stays the same for a while, so that a place on the axis keeps its meaning, and at
/// least two thirds of the axis are filled.
#[must_use]
pub fn axis_end(reached: u64, limit: u64) -> u64 {
    const STEPS: [u64; 7] = [10, 15, 20, 30, 40, 60, 80];
    let powers = (0..).map_while(|power| 10_u64.checked_pow(power));
    let mut ends = powers.flat_map(|power| STEPS.map(|step| step.saturating_mul(power)));
    let end = ends.find(|end| *end >= reached).unwrap_or(u64::MAX);
    end.min(limit.max(reached))
}

/// Returns a range that is finite and not empty.
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

/// Returns values as bars from left to right, in at most `columns` columns.
///
/// Values that share a column are averaged; fewer values take fewer columns. `low` and `high`
/// are the range of the bars.
#[must_use]
pub fn sparkline(values: &[f64], [low, high]: [f64; 2], columns: usize, signs: &Signs) -> String {
    let cells = values.len().min(columns);
    let bars = (0..cells).map(|cell| {
        let from = cell * values.len() / cells;
        let part = &values[from..(cell + 1) * values.len() / cells];
        let mean = part.iter().sum::<f64>() / part.len() as f64;
        let share = (mean - low) / (high - low);
        let levels = signs.bars.len() - 2;
        let level = if share.is_finite() {
            (share.clamp(0.0, 1.0) * levels as f64).round() as usize
        } else {
            0
        };
        // A value is never drawn as a blank.
        signs.bars[1 + level.min(levels)]
    });
    bars.collect()
}

#[cfg(test)]
mod tests {
    use super::super::signs::UNICODE;
    use super::*;

    #[test]
    fn an_axis_stays_for_a_while_and_is_mostly_filled() {
        let ends: Vec<_> = [1, 10, 11, 16, 60, 61, 81, 100, 101, 151]
            .map(|reached| axis_end(reached, 1000))
            .to_vec();
        assert_eq!(ends, [10, 10, 15, 20, 60, 80, 100, 100, 150, 200]);
        assert_eq!((axis_end(41, 50), axis_end(7, 6)), (50, 7));
        for reached in (11..5000).chain([u64::MAX / 3, u64::MAX]) {
            let end = axis_end(reached, u64::MAX);
            assert!(end >= reached && end / 3 * 2 <= reached, "{reached}: {end}");
        }
    }

    #[test]
    fn ends_of_values_are_round() {
        let labels = |up| {
            let chart = Chart::of(Vec::new(), up).rounded();
            chart.up.map(|value| format!("{value:.0$}", chart.digits))
        };
        assert_eq!(labels([392.0, 1006.0]), ["350", "1050"]);
        assert_eq!(labels([-18.0, 0.0]), ["-18", "0"]);
        assert_eq!(labels([11.23, 11.9]), ["11.2", "11.9"]);
        assert_eq!(labels([7.0, 7.0]), ["7", "8"]);
        assert_eq!(labels([-1e308, 1e308]).len(), 2);
    }

    #[test]
    fn the_range_is_from_the_lowest_bar_to_the_highest() {
        let line = |values: &[f64], columns| sparkline(values, [0.0, 7.0], columns, &UNICODE);
        assert_eq!(
            line(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], 20),
            "▁▂▃▄▅▆▇█"
        );
        assert_eq!(line(&[0.0, 0.0, 7.0, 7.0, 0.0, 0.0], 3), "▁█▁");
        assert_eq!(line(&[-9.0, 99.0, f64::NAN], 3), "▁█▁");
        assert_eq!(line(&[], 3), "");
        assert_eq!(line(&[1.0], 0), "");
        assert_eq!(sparkline(&[5.0, 5.0], [5.0, 5.0], 9, &UNICODE), "▁▁");
    }
}
