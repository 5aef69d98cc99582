//! The figures of the thesis, made from runs or studies and drawn as SVG or as text.

mod layout;
mod primitives;
mod run;
mod study;
mod svg;
mod text;

use serde::Serialize;

use super::table::Table;

pub use layout::{Sketch, SketchNode};
pub use run::{RunSource, SourceError};
pub use study::study_figure;

/// The figures of the thesis that can be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FigureNumber {
    /// Action values of the primitive subtasks against the angle to their target.
    F4_3,
    /// The hierarchies obtained.
    F4_5,
    /// Structural difference to the best hierarchy in each generation.
    F4_7,
    /// Fitness of the better half of the population in each generation.
    F4_8,
    /// The best hierarchy of selected generations.
    F4_9,
    /// Selection probabilities in each generation.
    F4_10,
}

impl FigureNumber {
    /// All figures.
    pub const ALL: [Self; 6] = [
        Self::F4_3,
        Self::F4_5,
        Self::F4_7,
        Self::F4_8,
        Self::F4_9,
        Self::F4_10,
    ];

    /// Returns its number in the thesis.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F4_3 => "4.3",
            Self::F4_5 => "4.5",
            Self::F4_7 => "4.7",
            Self::F4_8 => "4.8",
            Self::F4_9 => "4.9",
            Self::F4_10 => "4.10",
        }
    }
}

impl std::str::FromStr for FigureNumber {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|number| number.name() == text);
        let allowed = Self::ALL.map(Self::name).join(", ");
        found.ok_or_else(|| format!("found {text:?}; allowed: {allowed}"))
    }
}

/// The content of a figure, independent of how it is drawn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Its number in the thesis; empty for a figure that is not there.
    pub number: &'static str,
    /// Its title.
    pub title: String,
    /// The runs, seeds, versions and commands that it was made from.
    pub provenance: String,
    /// Its panels.
    pub panels: Vec<Panel>,
}

/// A panel of a figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Panel {
    /// A line chart.
    Chart(Chart),
    /// A hierarchy.
    Tree(Sketch),
}

/// A line chart.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chart {
    /// Its title.
    pub title: String,
    /// Label of the horizontal axis, with its unit.
    pub x: String,
    /// Label of the vertical axis, with its unit.
    pub y: String,
    /// Range of the vertical axis, for charts that are compared with each other; `None` for the
    /// range of the points.
    #[serde(skip)]
    pub y_range: Option<[f64; 2]>,
    /// The lines.
    pub series: Vec<Series>,
}

/// A line of a chart.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// The band around it: x, lower and upper end.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub band: Vec<(f64, f64, f64)>,
    /// Index of its colour and of its character in text. A quantity has the same index in all
    /// charts of a figure.
    #[serde(skip)]
    pub mark: usize,
}

/// Formats a number at an axis without trailing zeros.
fn tick(value: f64) -> String {
    let text = format!("{value:.4}");
    match text.trim_end_matches('0').trim_end_matches('.') {
        "-0" => String::from("0"),
        text => text.to_owned(),
    }
}

/// A figure cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("figure {number}: {message}")]
pub struct FigureError {
    /// Its number in the thesis.
    pub number: &'static str,
    /// The cause.
    pub message: String,
}

impl Figure {
    /// Returns its title with its number.
    fn full_title(&self) -> String {
        match self.number {
            "" => self.title.clone(),
            number => format!("Figure {number}: {}", self.title),
        }
    }

    /// Draws the figure as SVG.
    ///
    /// # Errors
    /// When it has no panels.
    pub fn svg(&self) -> Result<String, FigureError> {
        svg::draw(self).map_err(|message| FigureError {
            number: self.number,
            message,
        })
    }

    /// Draws the figure as text for a terminal with this many columns.
    #[must_use]
    pub fn text(&self, columns: usize) -> String {
        text::draw(self, columns)
    }

    /// Returns the content of the figure as a tidy table, with one row for each point or
    /// hierarchy.
    #[must_use]
    pub fn table(&self) -> Table {
        let mut table = Table::new(&["figure", "panel", "series", "x_is", "x", "y_is", "y"]);
        table.provenance.clone_from(&self.provenance);
        for panel in &self.panels {
            match panel {
                Panel::Chart(chart) => {
                    for series in &chart.series {
                        for (x, y) in &series.points {
                            table.rows.push(vec![
                                self.number.to_owned(),
                                chart.title.clone(),
                                series.name.clone(),
                                chart.x.clone(),
                                x.to_string(),
                                chart.y.clone(),
                                y.to_string(),
                            ]);
                        }
                    }
                }
                Panel::Tree(sketch) => table.rows.push(vec![
                    self.number.to_owned(),
                    sketch.caption.clone(),
                    sketch.text.clone(),
                    String::new(),
                    String::new(),
                    String::new(),
                    String::new(),
                ]),
            }
        }
        table
    }
}

impl Chart {
    /// Returns the ranges of both axes; `None` if there is no finite point.
    fn ranges(&self) -> Option<[(f64, f64); 2]> {
        let points = || {
            let ends = |&(x, low, high): &(f64, f64, f64)| [(x, low), (x, high)];
            let of = move |series: &'_ Series| {
                let bands = series.band.iter().flat_map(ends);
                series
                    .points
                    .iter()
                    .copied()
                    .chain(bands)
                    .collect::<Vec<_>>()
            };
            self.series.iter().flat_map(of)
        };
        let finite = || points().filter(|(x, y)| x.is_finite() && y.is_finite());
        let range = |of: fn((f64, f64)) -> f64| {
            let values = || finite().map(of);
            let (low, high) = (
                values().fold(f64::INFINITY, f64::min),
                values().fold(f64::NEG_INFINITY, f64::max),
            );
            match high - low {
                width if width > 0.0 => (low, high),
                _ => (low - 0.5, high + 0.5),
            }
        };
        finite().next()?;
        let vertical = self.y_range.map(|[low, high]| (low, high));
        Some([
            range(|point| point.0),
            vertical.unwrap_or_else(|| range(|point| point.1)),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::tick;

    #[test]
    fn ticks_have_the_digits_that_they_need() {
        let numbers = [5.0, 100.0, -0.0, 0.1 + 0.2, -12.5, -1e-9];
        assert_eq!(numbers.map(tick), ["5", "100", "0", "0.3", "-12.5", "0"]);
    }
}
