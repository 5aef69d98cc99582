//! The figures of a study: means over all seeds, or a typical run where the thesis shows one.

use super::run::{RunSource, SourceError, sketches};
use super::{Chart, Figure, FigureNumber, Panel, Series};
use crate::report::facts::{Facts, GenerationFacts, StudyRuns};
use crate::report::provenance::Provenance;
use crate::report::statistics::iqm;
use crate::report::study::Study;

/// Caption of charts over all seeds.
const LINES: &str = "; each line is the interquartile mean over seeds";

/// Number of points of a line from the first generation to the last.
const POINTS: usize = 41;

/// Returns a figure of the finished runs of a study, with panels for each scenario.
///
/// Figures 4.7 and 4.8 show every arm that evolves, as interquartile means over seeds from the
/// first generation of each run to its last. Figure 4.5 shows the most frequent final structure of
/// the tested arm. The other figures show the typical run of the tested arm: the run whose winner
/// has the median trial length on fresh trials.
///
/// # Errors
/// When a run cannot be read.
pub fn study_figure(
    study: &Study,
    all: &[Facts],
    number: FigureNumber,
) -> Result<Figure, SourceError> {
    let view = View(StudyRuns { study, all });
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
            let made_from = format!("; typical runs: {}", runs.join(", "));
            (title, panels, made_from)
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

struct View<'v>(StudyRuns<'v>);

impl View<'_> {
    /// Returns the arms with crossover: their indices and names.
    fn evolving(&self) -> impl Iterator<Item = (usize, &str)> {
        let arms = self.0.study.plan.arms.iter().enumerate();
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
        let scenarios = self.0.study.plan.scenarios.iter().enumerate();
        let charts = scenarios.map(|(index, scenario)| {
            let mut chart = Chart {
                title: scenario.name.clone(),
                x: String::from("generations (%)"),
                y: y.to_owned(),
                y_range: None,
                series: Vec::new(),
            };
            for (arm, name) in self.evolving() {
                let runs = self.0.of(index, arm);
                if !runs.is_empty() {
                    add(&mut chart, &runs, name);
                }
            }
            Panel::Chart(chart)
        });
        charts.collect()
    }

    /// Returns the runs of a scenario in the tested arm, or in the first arm if none evolves.
    fn tested(&self, scenario: usize) -> Vec<&Facts> {
        self.0.of(scenario, self.0.tested_arm().unwrap_or(0))
    }

    fn frequent(&self) -> Result<Vec<Panel>, SourceError> {
        let mut panels = Vec::new();
        for (index, scenario) in self.0.study.plan.scenarios.iter().enumerate() {
            let runs = self.tested(index);
            let times = |facts: &Facts| {
                runs.iter()
                    .filter(|other| other.winner.structure == facts.winner.structure)
                    .count()
            };
            // Ties are broken by alphabetical order.
            let most = runs.iter().max_by(|a, b| {
                times(a)
                    .cmp(&times(b))
                    .then_with(|| b.winner.structure.cmp(&a.winner.structure))
            });
            let Some(most) = most else { continue };
            let caption = format!("{}: {} of {} runs", scenario.name, times(most), runs.len());
            let trees = vec![(caption, most.winner.structure.clone())];
            let sketches = sketches(scenario, trees)?.map_err(|message| SourceError::Misfit {
                folder: self.0.study.name(&most.run),
                message,
            })?;
            panels.extend(sketches.into_iter().map(Panel::Tree));
        }
        Ok(panels)
    }

    /// Returns the panels of the typical runs, and the names of these runs.
    fn typical_panels(
        &self,
        number: FigureNumber,
    ) -> Result<(Vec<Panel>, Vec<String>), SourceError> {
        let (mut panels, mut names) = (Vec::new(), Vec::new());
        for (index, scenario) in self.0.study.plan.scenarios.iter().enumerate() {
            let mut runs = self.tested(index);
            runs.sort_by(|a, b| {
                a.fresh
                    .steps
                    .total_cmp(&b.fresh.steps)
                    .then(a.run.cmp(&b.run))
            });
            let Some(median) = runs.get(runs.len().saturating_sub(1) / 2) else {
                continue;
            };
            let source = RunSource::read(&self.0.study.run_folder(&median.run))?;
            for mut panel in source.figure(number, "svg")?.panels {
                let title = match &mut panel {
                    Panel::Chart(chart) => &mut chart.title,
                    Panel::Tree(tree) => &mut tree.caption,
                };
                *title = format!("{}: {title}", scenario.name);
                panels.push(panel);
            }
            names.push(self.0.study.name(&median.run));
        }
        Ok((panels, names))
    }
}

/// Adds a line of interquartile means over runs, from their first generation to their last.
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
        band: Vec::new(),
        mark: chart.series.len(),
    });
}
