//! The fitness view: fitness and structural difference over generations.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};

use super::shared::{
    THROUGH_TIME, csv_line, draw_no_generation, over_generations, random_ranks, right_of,
};
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Chart, Curve, Paint, put, width};
use crate::evolution::GenerationRecord;

/// Fitness over generations (Thesis Figure 4.8), structural difference below (Figure 4.7).
///
/// ```text
///  ╭ Fitness  time steps per trial · best 8 of 16 ╮
///  │ 1006 ⠒⢄   │                                  │
///  │  390   ⠑⠒⠤┼⠤⠤                                │
///  │ best 406  median 518  worst 616              │   in the generation shown
///  │    0 ⢀⠤⠒⠒⠒┼⠉⠉                                │
///  │  -18 ⠊    │                                  │
///  │ structural difference to best -1.2           │
///  ╰──────────────────────────────────────────────╯
/// ```
pub(super) struct Fitness;

const CURVES: [(&str, Paint); 3] = [
    ("best", Paint::Best),
    ("median", Paint::Median),
    ("worst", Paint::Worst),
];

/// From this many rows on there are two charts.
const TWO_CHARTS: u16 = 11;

impl View for Fitness {
    fn name(&self) -> &'static str {
        "fitness"
    }

    fn title(&self) -> &'static str {
        "Fitness"
    }

    fn caption(&self, context: &ViewContext) -> String {
        let individuals = context.shown().map_or(0, |record| record.individuals.len());
        if individuals < 2 {
            return String::from("time steps per trial");
        }
        let separator = context.look.signs.separator;
        let which = random_ranks(context).map_or("best", |_| "random");
        let half = individuals / 2;
        format!("time steps per trial {separator} {which} {half} of {individuals}")
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let (Some(mut chart), Some(shown)) = (fitness_chart(context), context.shown()) else {
            return draw_no_generation(context, area, buffer);
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
        let [above, below] = [above, below].map(|area| right_of(area, 1));
        let mut difference_chart = difference_chart(context);
        if two {
            // The charts share one axis.
            chart.margin = difference_chart.left();
            difference_chart.margin = chart.left();
        }
        chart.draw(look, above, buffer);
        draw_legend(context, shown, legend, buffer);
        if two {
            difference_chart.draw(look, below, buffer);
            let mut text = format!("structural difference to best {:.1}", shown.mean_difference);
            if width(&text) >= area.width.into() {
                text = text.replace("structural ", "");
            }
            let style = look.style(Paint::Series1);
            put(buffer, difference, (1, 0), &text, style);
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
            let (difference, converged) = (&record.mean_difference, &record.converged);
            let generation = &record.generation;
            csv_line(
                &mut csv,
                &[generation, &best, &median, &worst, difference, converged],
            );
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "Mean time steps per scored trial of the best, the median and the worst individual of the\n\
         better half of the population (Thesis Figure 4.8); fewer are better. Fitness is noisy:\n\
         the same individual scores differently in every generation, and the best is also the\n\
         luckiest. The lower chart shows the mean structural difference of the better half to\n\
         the best (Figure 4.7). At 0 they all have one structure, and evolution ends."
    }
}

/// Returns the mean time steps per trial of the best, the median and the worst of the better
/// half; `None` where one of them is unknown.
fn better_half_steps(record: &GenerationRecord) -> Option<[f64; 3]> {
    let half = (record.individuals.len() / 2).max(1);
    let at = |rank: usize| {
        record
            .mean_trial_steps(rank)
            .filter(|steps| steps.is_finite())
    };
    // The median of an even number of values is the mean of the two in the middle.
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
    let Some(steps) = better_half_steps(shown) else {
        return;
    };
    let entries =
        |digits| [0, 1, 2].map(|index| legend_entry(context, index, steps[index], digits));
    let room = usize::from(line.width.saturating_sub(1));
    let mut legend = entries(usize::from(steps[2] < 100.0));
    if legend.iter().map(|entry| width(entry) + 2).sum::<usize>() > room + 2 {
        legend = entries(0);
    }
    let mut column = 1;
    for (entry, (_, paint)) in legend.iter().zip(CURVES) {
        if usize::from(column) + width(entry) > room + 1 {
            break;
        }
        column = put(buffer, line, (column, 0), entry, context.look.style(paint)) + 2;
    }
}

/// Returns name and value of a curve, with its sign where curves are drawn with ASCII signs.
fn legend_entry(context: &ViewContext, index: usize, steps: f64, digits: usize) -> String {
    let signs = context.look.signs;
    let name = if random_ranks(context).is_some() {
        ["first", "middle", "last"][index]
    } else {
        CURVES[index].0
    };
    let sign = if signs.dots {
        String::new()
    } else {
        format!("{} ", signs.series[(2 - index) % 3])
    };
    format!("{sign}{name} {steps:.digits$}")
}
