//! The figures of a study: courses over all seeds, and a typical run where the thesis
//! shows one.

use super::run::{RunSource, SourceError, sketches};
use super::{Chart, Figure, FigureNumber, Panel, Series};
use crate::report::arm::Base;
use crate::report::facts::{Facts, GenerationFacts};
use crate::report::provenance::Provenance;
use crate::report::statistics::iqm;
use crate::report::study::Study;

/// What the lines of a chart over all seeds are.
const LINES: &str = "; lines are interquartile means over seeds";

/// Points of a course from the first generation to the last.
const POINTS: usize = 41;

/// A figure of a study from the runs that are done, scenario by scenario.
///
/// Figures 4.7 and 4.8 show every arm that evolves: interquartile means over seeds, the
/// runs laid over one another from their first to their last generation. Figure 4.5 shows
/// the most frequent final structure. The others show a typical run of the arm that
/// claims are tested on: that whose winner is the median on fresh trials.
///
/// # Errors
/// When a run cannot be read.
pub fn study_figure(
    study: &Study,
    all: &[Facts],
    number: FigureNumber,
) -> Result<Figure, SourceError> {
    let view = View { study, all };
    let (title, panels, made_from) = match number {
        FigureNumber::F4_7 => (
            "Structural difference to the best",
            view.differences(),
            String::from(LINES),
        ),
        FigureNumber::F4_8 => (
            "Performance of the best and of the middle",
            view.performance(),
            String::from(LINES),
        ),
        FigureNumber::F4_5 => (
            "Most frequent final structures",
            view.frequent()?,
            String::new(),
        ),
        FigureNumber::F4_3 | FigureNumber::F4_9 | FigureNumber::F4_10 => {
            let (panels, runs) = view.typical_panels(number)?;
            let title = match number {
                FigureNumber::F4_3 => "Action values of the primitive subtasks",
                FigureNumber::F4_9 => "The best hierarchy of selected generations",
                _ => "Selection probabilities of the primitive subtasks",
            };
            (
                title,
                panels,
                format!("; typical runs: {}", runs.join(", ")),
            )
        }
    };
    let provenance = Provenance::of(study, all);
    Ok(Figure {
        number: number.name(),
        title: format!("{title}, study {}", study.plan.name),
        provenance: format!("{}{made_from}", provenance.line()),
        panels,
    })
}

struct View<'v> {
    study: &'v Study,
    all: &'v [Facts],
}

impl View<'_> {
    fn runs(&self, scenario: usize, arm: usize) -> Vec<&Facts> {
        let of = |facts: &&Facts| (facts.run.scenario, facts.run.arm) == (scenario, arm);
        self.all.iter().filter(of).collect()
    }

    /// Arms whose structures change from generation to generation by crossover.
    fn evolving(&self) -> impl Iterator<Item = (usize, &str)> {
        let arms = self.study.plan.arms.iter().enumerate();
        arms.filter(|(_, arm)| !arm.base.is_matched())
            .map(|(index, arm)| (index, arm.name.as_str()))
    }

    fn differences(&self) -> Vec<Panel> {
        self.charts("structural difference (points)", |chart, runs, arm| {
            add_course(chart, runs, arm.to_owned(), |m| m.difference);
        })
    }

    fn performance(&self) -> Vec<Panel> {
        self.charts("mean trial length (time steps)", |chart, runs, arm| {
            add_course(chart, runs, format!("{arm}, best"), |m| m.best_steps);
            add_course(chart, runs, format!("{arm}, middle"), |m| m.middle_steps);
        })
    }

    fn charts(&self, y: &str, add: impl Fn(&mut Chart, &[&Facts], &str)) -> Vec<Panel> {
        let scenarios = self.study.plan.scenarios.iter().enumerate();
        let charts = scenarios.map(|(scenario, model)| {
            let mut chart = Chart {
                title: model.name.clone(),
                x: String::from("generations (%)"),
                y: y.to_owned(),
                y_range: None,
                series: Vec::new(),
            };
            for (arm, name) in self.evolving() {
                let runs = self.runs(scenario, arm);
                if !runs.is_empty() {
                    add(&mut chart, &runs, name);
                }
            }
            Panel::Chart(chart)
        });
        charts.collect()
    }

    fn tested(&self) -> usize {
        let arms = &self.study.plan.arms;
        arms.iter()
            .position(|arm| arm.base == Base::Evolved)
            .unwrap_or(0)
    }

    fn frequent(&self) -> Result<Vec<Panel>, SourceError> {
        let mut panels = Vec::new();
        for (index, scenario) in self.study.plan.scenarios.iter().enumerate() {
            let runs = self.runs(index, self.tested());
            let times = |facts: &Facts| {
                runs.iter()
                    .filter(|other| other.winner.structure == facts.winner.structure)
                    .count()
            };
            // Of equally frequent ones the first in the alphabet.
            let most = runs.iter().max_by(|a, b| {
                times(a)
                    .cmp(&times(b))
                    .then_with(|| b.winner.structure.cmp(&a.winner.structure))
            });
            let Some(most) = most else { continue };
            let caption = format!("{}: {} of {} runs", scenario.name, times(most), runs.len());
            let trees = vec![(caption, most.winner.structure.clone())];
            let sketches = sketches(scenario, trees)?.map_err(|message| SourceError::Misfit {
                folder: self.study.name(&most.run),
                message,
            })?;
            panels.extend(sketches.into_iter().map(Panel::Tree));
        }
        Ok(panels)
    }

    /// The panels of typical runs, and their names.
    fn typical_panels(
        &self,
        number: FigureNumber,
    ) -> Result<(Vec<Panel>, Vec<String>), SourceError> {
        let (mut panels, mut names) = (Vec::new(), Vec::new());
        for (index, scenario) in self.study.plan.scenarios.iter().enumerate() {
            let mut runs = self.runs(index, self.tested());
            runs.sort_by(|a, b| {
                a.fresh
                    .steps
                    .total_cmp(&b.fresh.steps)
                    .then(a.run.cmp(&b.run))
            });
            let Some(median) = runs.get(runs.len().saturating_sub(1) / 2) else {
                continue;
            };
            let source = RunSource::read(&self.study.run_folder(&median.run))?;
            for mut panel in source.figure(number, "svg")?.panels {
                match &mut panel {
                    Panel::Chart(chart) => {
                        chart.title = format!("{}: {}", scenario.name, chart.title)
                    }
                    Panel::Tree(tree) => {
                        tree.caption = format!("{}: {}", scenario.name, tree.caption)
                    }
                }
                panels.push(panel);
            }
            names.push(self.study.name(&median.run));
        }
        Ok((panels, names))
    }
}

/// Adds the course of interquartile means over runs, from the first generation to the last.
fn add_course(chart: &mut Chart, runs: &[&Facts], name: String, of: fn(&GenerationFacts) -> f64) {
    let points = (0..POINTS).map(|point| {
        let share = point as f64 / (POINTS - 1) as f64;
        let values: Vec<_> = runs
            .iter()
            .filter_map(|facts| facts.at(share, of))
            .collect();
        (100.0 * share, iqm(&values))
    });
    chart.series.push(Series {
        name,
        points: points.collect(),
        mark: chart.series.len(),
    });
}
