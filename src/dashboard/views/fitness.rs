//! Fitness and structural difference over generations.

use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::View;
use crate::dashboard::desk::Desk;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Canvas, Layer, Paint, put, width};
use crate::evolution::GenerationRecord;

/// Fitness over generations (Thesis Figure 4.8), structural difference below (4.7).
pub(super) struct Fitness;

/// Ranks whose fitness is drawn: the best, the middle and the worst of the better half.
fn ranks(record: &GenerationRecord) -> [usize; 3] {
    let half = (record.individuals.len() / 2).max(1);
    [1, half.div_ceil(2), half]
}

const PAINTS: [Paint; 3] = [Paint::Best, Paint::Median, Paint::Worst];
const NAMES: [&str; 3] = ["best", "median", "worst"];

impl View for Fitness {
    fn caption(&self, desk: &Desk) -> String {
        let half = desk
            .shown()
            .map_or(0, |record| record.individuals.len() / 2);
        match half {
            0 => String::from("time steps a trial"),
            half => format!("time steps a trial, of the {half} best"),
        }
    }

    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let records = desk.model().generations();
        let curves: Vec<[f64; 4]> = records.iter().filter_map(|record| point(record)).collect();
        let Some(highest) = curves.iter().map(|p| p[3]).reduce(f64::max) else {
            put(
                buffer,
                area,
                (1, 0),
                "no generation has lived yet",
                desk.look.style(Paint::Dim),
            );
            return;
        };
        let (first, last) = (
            curves[0][0],
            curves[curves.len() - 1][0].max(curves[0][0] + 1.0),
        );
        let top = highest.max(1.0) * 1.02;
        let labels = [format!("{top:.0}"), String::from("0")];
        let left = labels.iter().map(|label| width(label)).max().unwrap_or(0) as u16 + 1;
        let plot = Rect {
            x: area.x + left.min(area.width),
            width: area.width.saturating_sub(left),
            height: area.height.saturating_sub(1),
            ..area
        };
        let dim = desk.look.style(Paint::Dim);
        put(buffer, area, (0, 0), &labels[0], dim);
        put(
            buffer,
            area,
            (0, plot.height.saturating_sub(1)),
            &labels[1],
            dim,
        );
        let mut canvas = Canvas::new(&desk.look, plot, [first, 0.0], [last - first, top]);
        for curve in (0..3).rev() {
            for pair in curves.windows(2) {
                let at = |p: &[f64; 4]| [p[0], p[curve + 1]];
                canvas.line(
                    at(&pair[0]),
                    at(&pair[1]),
                    Layer::Curve(2 - curve as u8),
                    PAINTS[curve],
                );
            }
            canvas.point(
                [curves[0][0], curves[0][curve + 1]],
                Layer::Curve(2 - curve as u8),
                PAINTS[curve],
            );
        }
        canvas.finish(buffer);
        if let Some(shown) = desk.shown().and_then(|record| point(record)) {
            let mut column = 0;
            for (index, name) in NAMES.iter().enumerate() {
                let text = format!("{name} {:.0}", shown[index + 1]);
                let row = area.height.saturating_sub(1);
                column = put(
                    buffer,
                    area,
                    (column, row),
                    &text,
                    desk.look.style(PAINTS[index]),
                ) + 2;
            }
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Earlier, Action::Later, Action::Play]
    }

    fn csv(&self, desk: &Desk) -> Option<String> {
        let mut csv = String::from(
            "generation,best_steps,median_steps,worst_steps,mean_difference,converged\n",
        );
        for record in desk.model().generations() {
            let Some([generation, best, median, worst]) = point(record) else {
                continue;
            };
            let (difference, converged) = (record.mean_difference, record.converged);
            // Writing to a string cannot fail.
            let _ = writeln!(
                csv,
                "{generation},{best},{median},{worst},{difference},{converged}"
            );
        }
        Some(csv)
    }

    fn lesson(&self) -> &'static str {
        "Mean time steps of a scored trial of the best, the median and the worst of the better\n\
         half of the population (Thesis Figure 4.8). Fewer is better. Fitness is noisy: the same\n\
         individual scores differently in every generation."
    }
}

/// Generation and mean time steps of a trial at each of the ranks.
fn point(record: &GenerationRecord) -> Option<[f64; 4]> {
    let [best, median, worst] = ranks(record).map(|rank| record.mean_trial_steps(rank));
    let point = [record.generation as f64, best?, median?, worst?];
    point.iter().all(|value| value.is_finite()).then_some(point)
}
