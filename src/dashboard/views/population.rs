//! All individuals of a generation.

use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::shared::{by_chance, nothing_yet, origin};
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::{Chosen, ViewContext};
use crate::dashboard::context::{Clicked, line_at};
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, one_line, put, wrapped};
use crate::dashboard::view_id::ViewId;
use crate::evolution::RankedRecord;

/// All individuals of a generation, best first.
#[derive(Default)]
pub(super) struct Population {
    by: Column,
    reversed: bool,
}

/// A column of the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Column {
    #[default]
    Rank,
    Id,
    Steps,
    Failed,
    Composites,
    Primitives,
    Difference,
    Origin,
    Tree,
}

/// Columns with their heads and widths, in their order. The most important ones are kept
/// where there is little room.
const COLUMNS: [(Column, &str, u16); 9] = [
    (Column::Rank, "rank", 4),
    (Column::Id, "id", 5),
    (Column::Steps, "steps", 6),
    (Column::Failed, "failed", 6),
    (Column::Composites, "comp", 4),
    (Column::Primitives, "prim", 4),
    (Column::Difference, "diff", 5),
    (Column::Origin, "origin", 11),
    (Column::Tree, "hierarchy", 20),
];

/// In which order columns are given up.
const GIVEN_UP: [Column; 5] = [
    Column::Tree,
    Column::Failed,
    Column::Composites,
    Column::Primitives,
    Column::Id,
];

/// The columns that there is room for.
fn columns(width: u16) -> Vec<(Column, &'static str, u16)> {
    let mut columns = COLUMNS.to_vec();
    for given_up in GIVEN_UP {
        let needed: u16 = columns.iter().map(|(_, _, width)| width + 1).sum();
        if needed < width {
            break;
        }
        columns.retain(|(column, ..)| *column != given_up);
    }
    columns
}

impl Column {
    /// The columns that the table can be sorted by, in the order of the key.
    fn next(self) -> Self {
        let sortable = &COLUMNS[..COLUMNS.len() - 1];
        let here = sortable.iter().position(|(column, ..)| *column == self);
        let next = here.map_or(0, |here| (here + 1) % sortable.len());
        sortable[next].0
    }

    /// What individuals are ordered by.
    fn key(self, individual: &RankedRecord) -> (i64, String) {
        let large = |n: u64| i64::try_from(n).unwrap_or(i64::MAX);
        let number = match self {
            Self::Rank | Self::Steps => individual.rank as i64,
            Self::Id => large(individual.id),
            Self::Failed => failed(individual) as i64,
            Self::Composites => individual.composites as i64,
            Self::Primitives => individual.primitives.len() as i64,
            Self::Difference => individual.difference_to_best,
            Self::Origin | Self::Tree => 0,
        };
        let text = match self {
            Self::Origin => origin(&individual.origin),
            Self::Tree => individual.tree.clone(),
            _ => String::new(),
        };
        (number, text)
    }

    /// What stands in the table.
    fn text(self, individual: &RankedRecord) -> String {
        match self {
            Self::Rank => individual.rank.to_string(),
            Self::Id => individual.id.to_string(),
            Self::Steps => format!("{:.1}", mean_steps(individual)),
            Self::Failed => match failed(individual) {
                0 => String::new(),
                failed => failed.to_string(),
            },
            Self::Composites => individual.composites.to_string(),
            Self::Primitives => individual.primitives.len().to_string(),
            Self::Difference => match individual.difference_to_best {
                0 => String::from("same"),
                difference => difference.to_string(),
            },
            Self::Origin => origin(&individual.origin),
            Self::Tree => one_line(&individual.tree),
        }
    }

    fn is_number(self) -> bool {
        !matches!(self, Self::Origin | Self::Tree)
    }
}

/// Mean time steps of a scored trial.
fn mean_steps(individual: &RankedRecord) -> f64 {
    individual.fitness_steps as f64 / individual.trials.len().max(1) as f64
}

/// Scored trials that ended at the limit.
fn failed(individual: &RankedRecord) -> usize {
    let trials = individual.trials.iter();
    trials.filter(|trial| !trial.delivered).count()
}

fn draw_individual(
    context: &ViewContext,
    columns: &[(Column, &str, u16)],
    individual: &RankedRecord,
    is_selected: bool,
    line: Rect,
    buffer: &mut Buffer,
) {
    let look = &context.look;
    let paint = match (is_selected, individual.rank) {
        (true, _) => Paint::Selected,
        (false, 1) => Paint::Best,
        _ => Paint::Text,
    };
    let style = look.style(paint);
    if is_selected {
        buffer.set_style(line.intersection(buffer.area), style);
        put(buffer, line, (0, 0), look.signs.pointer, style);
    }
    let mut at = 1;
    for (column, _, width) in columns {
        let text = column.text(individual);
        let room = match column {
            Column::Tree => line.width.saturating_sub(at),
            _ => *width,
        };
        let text = fitted(&text, usize::from(room), look.signs);
        let room = usize::from(*width);
        let text = match column.is_number() {
            true => format!("{text:>room$}"),
            false => text,
        };
        put(buffer, line, (at, 0), &text, style);
        at += width + 1;
    }
}

/// Writes the whole hierarchy of the selected individual, as much of it as there is room for.
fn draw_whole(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    let Some(individual) = context.selected() else {
        return;
    };
    let look = &context.look;
    let columns = usize::from(area.width.saturating_sub(2));
    let text = format!("{}: {}", individual.id, one_line(&individual.tree));
    let lines = wrapped(&text, columns, "  ");
    let is_whole = lines.len() <= usize::from(area.height);
    for (row, line) in (0..area.height).zip(lines.iter().filter(|_| is_whole)) {
        put(buffer, area, (1, row), line, look.style(Paint::Dim));
    }
}

impl Population {
    fn sorted<'d>(&self, context: &'d ViewContext) -> Vec<&'d RankedRecord> {
        let Some(record) = context.shown() else {
            return Vec::new();
        };
        let mut individuals: Vec<_> = record.individuals.iter().collect();
        individuals.sort_by_cached_key(|individual| self.by.key(individual));
        if self.reversed {
            individuals.reverse();
        }
        individuals
    }

    /// The individuals that there is room for below the head, the selected one among them.
    fn visible<'d>(&self, context: &'d ViewContext, area: Rect) -> Vec<&'d RankedRecord> {
        let sorted = self.sorted(context);
        let selected = context.selected().map(|individual| individual.id);
        let is_selected = |individual: &&RankedRecord| Some(individual.id) == selected;
        let here = sorted.iter().position(is_selected).unwrap_or(0);
        let rows = usize::from(area.height.saturating_sub(1));
        let skipped = here.saturating_sub(rows / 2);
        let skipped = skipped.min(sorted.len().saturating_sub(rows));
        sorted.into_iter().skip(skipped).take(rows).collect()
    }

    /// The heads of the columns; the one that the table is sorted by says so.
    fn draw_head(
        &self,
        context: &ViewContext,
        columns: &[(Column, &str, u16)],
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let look = &context.look;
        let mut at: u16 = 1;
        for (column, head, width) in columns {
            let sorted = *column == self.by;
            let sign = look.signs.order[usize::from(self.reversed)];
            let head = match sorted {
                true => format!("{sign}{head}"),
                false => (*head).to_owned(),
            };
            let room = usize::from(*width);
            let text = match column.is_number() {
                true => format!("{head:>room$}"),
                false => head,
            };
            let paint = if sorted { Paint::Title } else { Paint::Dim };
            // A sign before the longest head takes the gap between columns.
            let over = u16::try_from(text.chars().count().saturating_sub(room)).unwrap_or(0);
            let over = if column.is_number() { over } else { 0 };
            put(
                buffer,
                area,
                (at.saturating_sub(over), 0),
                &text,
                look.style(paint),
            );
            at += width + 1;
        }
    }

    /// Selects the individual some lines further down.
    fn select(&self, context: &mut ViewContext, by: i64) {
        let sorted = self.sorted(context);
        let selected = context.selected().map(|individual| individual.id);
        let here = sorted
            .iter()
            .position(|individual| Some(individual.id) == selected);
        let last = sorted.len().saturating_sub(1);
        let next = here.map_or(0, |here| {
            (here as i64).saturating_add(by).clamp(0, last as i64)
        });
        let chosen = sorted.get(next as usize).map(|individual| individual.id);
        if let Some(id) = chosen {
            context.chosen = Chosen::Id(id);
        }
    }
}

impl View for Population {
    fn name(&self) -> &'static str {
        "population"
    }

    fn title(&self) -> &'static str {
        "Population"
    }

    fn opens(&self) -> Option<ViewId> {
        Some(ViewId::Inspector)
    }

    fn caption(&self, context: &ViewContext) -> String {
        context.shown().map_or(String::new(), |record| {
            let count = record.individuals.len();
            let separator = context.look.signs.separator;
            let generation = record.generation;
            match by_chance(context) {
                // What matters most first, where there is little room.
                Some(ranked) => format!("{ranked} {separator} generation {generation}"),
                None => format!("generation {generation} {separator} {count} individuals"),
            }
        })
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        if context.shown().is_none() {
            return nothing_yet(context, area, buffer);
        }
        let columns = columns(area.width);
        self.draw_head(context, &columns, area, buffer);
        let selected = context.selected().map(|individual| individual.id);
        for (row, individual) in self.visible(context, area).into_iter().enumerate() {
            let line = Rect {
                y: area.y + 1 + row as u16,
                height: 1,
                ..area
            };
            draw_individual(
                context,
                &columns,
                individual,
                Some(individual.id) == selected,
                line,
                buffer,
            );
        }
        let used = area.height.min(
            context
                .shown()
                .map_or(0, |shown| shown.individuals.len() as u16)
                + 2,
        );
        let rest = Rect {
            y: area.y + used,
            height: area.height - used,
            ..area
        };
        draw_whole(context, rest, buffer);
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Down, Action::Open, Action::Sort, Action::Reverse]
    }

    fn can(&self, context: &ViewContext, action: Action) -> bool {
        let individuals = context.shown().map_or(0, |record| record.individuals.len());
        match action {
            Action::Down => individuals > 1,
            Action::Open => individuals > 0,
            _ => true,
        }
    }

    fn act(&mut self, context: &mut ViewContext, action: Action) -> Option<Vec<Effect>> {
        let page = i64::from(context.size.1 / 2).max(1);
        match action {
            Action::Up => self.select(context, -1),
            Action::Down => self.select(context, 1),
            Action::PageUp => self.select(context, -page),
            Action::PageDown => self.select(context, page),
            Action::Top => self.select(context, i64::MIN),
            Action::Bottom => self.select(context, i64::MAX),
            Action::Sort => self.by = self.by.next(),
            Action::Reverse => self.reversed = !self.reversed,
            _ => return None,
        }
        Some(Vec::new())
    }

    fn click(&mut self, context: &mut ViewContext, area: Rect, at: Position) -> Clicked {
        let line = line_at(at, area, 1);
        let visible = self.visible(context, area);
        let clicked = line.and_then(|line| visible.get(line)).map(|one| one.id);
        let Some(selected) = context.selected().map(|individual| individual.id) else {
            return Clicked::Nothing;
        };
        Clicked::on(clicked, selected, |id| context.chosen = Chosen::Id(id))
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let mut csv = String::from(
            "rank,id,fitness_steps,trials,composites,primitives,difference,origin,tree\n",
        );
        for individual in self.sorted(context) {
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
                one_line(&individual.tree)
            );
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "All individuals of the generation, best first. steps: mean time steps of a scored trial,\n\
         the fitness; failed: trials that ended at the limit; comp, prim: composite and distinct\n\
         primitive subtasks; diff: structural difference to the best (Thesis 4.5.2). origin: a\n\
         reproduced individual lives on with what it has learned; 165 x 172 is individual 165\n\
         with a subtree of 172."
    }
}
