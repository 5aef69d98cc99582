//! All individuals of a generation.

use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::View;
use crate::dashboard::desk::{Chosen, Desk};
use crate::dashboard::input::Effect;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, put};
use crate::evolution::{Origin, RankedRecord};

/// All individuals of a generation, best first.
#[derive(Default)]
pub(super) struct Population {
    by: Column,
    reversed: bool,
}

/// What the table is sorted by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Column {
    #[default]
    Rank,
    Id,
    Origin,
    Composites,
    Primitives,
    Difference,
}

impl Column {
    const ALL: [Self; 6] = [
        Self::Rank,
        Self::Id,
        Self::Origin,
        Self::Composites,
        Self::Primitives,
        Self::Difference,
    ];

    fn next(self) -> Self {
        let here = Self::ALL.iter().position(|&column| column == self);
        Self::ALL[(here.unwrap_or(0) + 1) % Self::ALL.len()]
    }

    fn key(self, individual: &RankedRecord) -> (i64, String) {
        let number = |n: usize| (i64::try_from(n).unwrap_or(i64::MAX), String::new());
        match self {
            Self::Rank => number(individual.rank),
            Self::Id => (
                i64::try_from(individual.id).unwrap_or(i64::MAX),
                String::new(),
            ),
            Self::Origin => (0, origin(&individual.origin)),
            Self::Composites => number(individual.composites),
            Self::Primitives => number(individual.primitives.len()),
            Self::Difference => (individual.difference_to_best, String::new()),
        }
    }
}

/// How an individual came to be, in a few words.
fn origin(origin: &Origin) -> String {
    match origin {
        Origin::HandCoded => String::from("hand-coded"),
        Origin::Random => String::from("random"),
        Origin::Reproduced => String::from("reproduced"),
        Origin::Crossover {
            receiver, donor, ..
        } => format!("{} x {}", receiver.id, donor.id),
        Origin::Copied { from } => format!("copy of {from}"),
    }
}

impl Population {
    fn sorted<'d>(&self, desk: &'d Desk) -> Vec<&'d RankedRecord> {
        let Some(record) = desk.shown() else {
            return Vec::new();
        };
        let mut individuals: Vec<_> = record.individuals.iter().collect();
        individuals.sort_by_cached_key(|individual| self.by.key(individual));
        if self.reversed {
            individuals.reverse();
        }
        individuals
    }

    /// Selects the individual some lines further down.
    fn select(&self, desk: &mut Desk, by: i64) {
        let sorted = self.sorted(desk);
        let selected = desk.selected().map(|individual| individual.id);
        let here = sorted
            .iter()
            .position(|individual| Some(individual.id) == selected);
        let last = sorted.len().saturating_sub(1);
        let next = here.map_or(0, |here| {
            (here as i64).saturating_add(by).clamp(0, last as i64)
        });
        let chosen = sorted.get(next as usize).map(|individual| individual.id);
        if let Some(id) = chosen {
            desk.chosen = Chosen::Id(id);
        }
    }
}

impl View for Population {
    fn caption(&self, desk: &Desk) -> String {
        desk.shown().map_or(String::new(), |record| {
            format!("generation {}", record.generation)
        })
    }

    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let look = &desk.look;
        let heads = "  rank    id  steps  com pri  diff  origin";
        put(buffer, area, (0, 0), heads, look.style(Paint::Dim));
        let sorted = self.sorted(desk);
        let selected = desk.selected().map(|individual| individual.id);
        let here = sorted
            .iter()
            .position(|individual| Some(individual.id) == selected)
            .unwrap_or(0);
        let rows = usize::from(area.height.saturating_sub(1)).max(1);
        let skipped = here
            .saturating_sub(rows / 2)
            .min(sorted.len().saturating_sub(rows));
        for (row, individual) in sorted.iter().skip(skipped).take(rows).enumerate() {
            let is_selected = Some(individual.id) == selected;
            let pointer = if is_selected { look.signs.pointer } else { " " };
            let steps = individual.fitness_steps as f64 / individual.trials.len().max(1) as f64;
            let text = format!(
                "{pointer} {:>4} {:>5} {steps:>6.0}  {:>3} {:>3} {:>5}  {}",
                individual.rank,
                individual.id,
                individual.composites,
                individual.primitives.len(),
                individual.difference_to_best,
                origin(&individual.origin)
            );
            let paint = if is_selected {
                Paint::Selected
            } else {
                Paint::Text
            };
            let text = fitted(&text, usize::from(area.width), look.signs);
            put(buffer, area, (0, row as u16 + 1), &text, look.style(paint));
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Down, Action::Up, Action::Sort, Action::Reverse]
    }

    fn act(&mut self, desk: &mut Desk, action: Action) -> Option<Vec<Effect>> {
        let page = i64::from(desk.size.1 / 2).max(1);
        match action {
            Action::Up => self.select(desk, -1),
            Action::Down => self.select(desk, 1),
            Action::PageUp => self.select(desk, -page),
            Action::PageDown => self.select(desk, page),
            Action::Top => self.select(desk, i64::MIN),
            Action::Bottom => self.select(desk, i64::MAX),
            Action::Sort => self.by = self.by.next(),
            Action::Reverse => self.reversed = !self.reversed,
            _ => return None,
        }
        Some(Vec::new())
    }

    fn csv(&self, desk: &Desk) -> Option<String> {
        let mut csv = String::from(
            "rank,id,fitness_steps,trials,composites,primitives,difference,origin,tree\n",
        );
        for individual in self.sorted(desk) {
            // Writing to a string cannot fail.
            let _ = writeln!(
                csv,
                "{},{},{},{},{},{},{},{},{}",
                individual.rank,
                individual.id,
                individual.fitness_steps,
                individual.trials.len(),
                individual.composites,
                individual.primitives.len(),
                individual.difference_to_best,
                origin(&individual.origin),
                individual.tree
            );
        }
        Some(csv)
    }

    fn lesson(&self) -> &'static str {
        "All individuals of the generation. steps: mean time steps of a scored trial, the\n\
         fitness; com, pri: composite and distinct primitive subtasks; diff: structural\n\
         difference to the best (Thesis 4.5.2), 0 for the same structure; origin: reproduced, or\n\
         made by crossover of the two individuals named."
    }
}
