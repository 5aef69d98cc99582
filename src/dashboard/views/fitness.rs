//! Fitness and structural difference over generations.

use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};

use super::shared::{THROUGH_TIME, by_chance, nothing_yet, over_generations};
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Chart, Curve, Paint, put, width};
use crate::evolution::GenerationRecord;

/// Fitness over generations (Thesis Figure 4.8), structural difference below (4.7).
///
/// ```text
///  ╭ Fitness  time steps a trial, of the 8 best ╮
///  │ 1006 ⠒⢄   │                                │
///  │  390   ⠑⠒⠤┼⠤⠤                              │
///  │ best 406  median 518  worst 616            │   at the generation shown
///  │    0 ⢀⠤⠒⠒⠒┼⠉⠉                              │
///  │  -18 ⠊    │                                │
///  │ structural difference to the best -1.2     │
///  ╰────────────────────────────────────────────╯
/// ```
pub(super) struct Fitness;

const CURVES: [(&str, Paint); 3] = [
    ("best", Paint::Best),
    ("median", Paint::Median),
    ("worst", Paint::Worst),
];

/// Rows from which on there are two charts.
const TWO_CHARTS: u16 = 11;

impl View for Fitness {
    fn name(&self) -> &'static str {
        "fitness"
    }

    fn title(&self) -> &'static str {
        "Fitness"
    }

    fn caption(&self, context: &ViewContext) -> String {
        match context.shown().map(|record| better_half(record)) {
            None | Some(0) => String::from("time steps a trial"),
            Some(half) => {
                let separator = context.look.signs.separator;
                let ranked = by_chance(context).map_or("best", |_| "first by chance");
                format!("time steps a trial {separator} the {half} {ranked}")
            }
        }
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let (Some(mut chart), Some(shown)) = (fitness_chart(context), context.shown()) else {
            return nothing_yet(context, area, buffer);
        };
        let look = &context.look;
        let two = area.height >= TWO_CHARTS;
        let lower = if two { area.height / 3 } else { 0 };
        let rows = [
            Constraint::Fill(1),
            Constraint::Length(1.min(area.height / 3)),
            Constraint::Length(lower),
            Constraint::Length(u16::from(two)),
        ];
        let [above, legend, below, difference] = Layout::vertical(rows).areas(area);
        let [above, below] = [above, below].map(indented);
        let mut difference_chart = difference_chart(context);
        if two {
            // One axis for both.
            chart.margin = difference_chart.left();
            difference_chart.margin = chart.left();
        }
        chart.draw(look, above, buffer);
        draw_legend(context, shown, legend, buffer);
        if two {
            difference_chart.draw(look, below, buffer);
            let text = format!("difference to the best {:.1}", shown.mean_difference);
            put(
                buffer,
                difference,
                (1, 0),
                &text,
                look.style(Paint::Series1),
            );
        }
    }

    fn hints(&self) -> &'static [Action] {
        THROUGH_TIME
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let names = CURVES.map(|(name, _)| format!("{name}_steps")).join(",");
        let mut csv = format!("generation,{names},mean_difference,converged\n");
        for record in context.history().generations() {
            let Some([best, median, worst]) = better_half_steps(record) else {
                continue;
            };
            let (number, converged) = (record.generation, record.converged);
            let difference = record.mean_difference;
            // Writing to a string cannot fail.
            let _ = writeln!(
                csv,
                "{number},{best},{median},{worst},{difference},{converged}"
            );
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "Mean time steps of a scored trial of the best, the median and the worst of the better\n\
         half of the population (Thesis Figure 4.8); fewer is better. Fitness is noisy: the same\n\
         individual scores differently in every generation, and the best is the luckiest too.\n\
         Below, the mean structural difference of the better half to the best (Figure 4.7): 0\n\
         when all have one structure, which ends evolution."
    }
}

/// An area without its first column.
fn indented(area: Rect) -> Rect {
    Rect {
        x: area.x + 1.min(area.width),
        width: area.width.saturating_sub(1),
        ..area
    }
}

/// Individuals in the better half.
fn better_half(record: &GenerationRecord) -> usize {
    record.individuals.len() / 2
}

/// Mean time steps of a trial of the best, the median and the worst of the better half.
fn better_half_steps(record: &GenerationRecord) -> Option<[f64; 3]> {
    let half = better_half(record).max(1);
    let at = |rank: usize| {
        record
            .mean_trial_steps(rank)
            .filter(|steps| steps.is_finite())
    };
    // Of an even number, the median is between the two in the middle.
    let median = (at(half.div_ceil(2))? + at(half / 2 + 1)?) / 2.0;
    Some([at(1)?, median, at(half)?])
}

fn fitness_chart(context: &ViewContext) -> Option<Chart> {
    let records = context.history().generations();
    let steps: Vec<_> = records
        .iter()
        .map(|record| (record.generation as f64, better_half_steps(record)))
        .collect();
    let lowest = steps.iter().filter_map(|(_, steps)| Some((*steps)?[0]));
    let lowest = lowest.reduce(f64::min)?;
    let curves = CURVES.iter().enumerate().map(|(index, (_, paint))| Curve {
        points: steps
            .iter()
            .map(|(generation, steps)| Some([*generation, (*steps)?[index]]))
            .collect(),
        paint: *paint,
        letter: None,
    });
    let least = [lowest * 0.9, lowest];
    Some(over_generations(context, curves.collect(), least).rounded())
}

fn difference_chart(context: &ViewContext) -> Chart {
    let records = context.history().generations().iter();
    let points = records.map(|record| Some([record.generation as f64, record.mean_difference]));
    let curve = Curve {
        points: points.collect(),
        paint: Paint::Series1,
        letter: None,
    };
    over_generations(context, vec![curve], [-1.0, 0.0]).rounded()
}

fn draw_legend(context: &ViewContext, shown: &GenerationRecord, line: Rect, buffer: &mut Buffer) {
    let look = &context.look;
    let Some(steps) = better_half_steps(shown) else {
        return;
    };
    let room = usize::from(line.width.saturating_sub(1));
    // Where curves are drawn with signs, the legend says whose sign is which.
    let names = match by_chance(context) {
        Some(_) => ["first", "middle", "last"],
        None => CURVES.map(|(name, _)| name),
    };
    let entry = |index: usize, digits: usize| {
        let sign = match look.signs.dots {
            true => String::new(),
            false => format!("{} ", look.signs.series[(2 - index) % 3]),
        };
        format!("{sign}{} {:.digits$}", names[index], steps[index])
    };
    let entries = |digits: usize| [0, 1, 2].map(|index| entry(index, digits));
    let needed =
        |entries: &[String; 3]| entries.iter().map(|entry| width(entry) + 2).sum::<usize>();
    let mut entries = entries(usize::from(steps[2] < 100.0));
    if needed(&entries) > room + 2 {
        entries = [0, 1, 2].map(|index| entry(index, 0));
    }
    let mut column = 1;
    for (entry, (_, paint)) in entries.iter().zip(CURVES) {
        if usize::from(column) + width(entry) > room + 1 {
            break;
        }
        column = put(buffer, line, (column, 0), entry, look.style(paint)) + 2;
    }
}
