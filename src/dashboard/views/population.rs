//! The population view: all individuals of a generation.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::shared::{
    below, csv_line, draw_no_generation, mark_selected, origin, random_ranks, row,
};
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::{Chosen, ViewContext};
use crate::dashboard::context::{Clicked, line_at};
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, one_line, put, width, wrapped};
use crate::dashboard::view_id::ViewId;
use crate::evolution::RankedRecord;

/// All individuals of a generation as a table, best first.
///
/// ```text
///  ╭ Population  generation 26 · 14 individuals ──────────────────────╮
///  │▲rank    id  steps failed comp prim  diff origin      hierarchy   │
///  │▸   1   362  128.6           4    3  same reproduced  (Root (Fi…  │   the selected one
///  │    2   340  141.2      1    4    4    -2 27 x 30     (Root (Fi…  │
///  │                                                                  │
///  │ 362: (Root (FindBattery Wander) ApproachBattery ...)             │   its whole hierarchy
///  ╰──────────────────────────────────────────────────────────────────╯
/// ```
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

/// A column with its head and its width.
type Spec = (Column, &'static str, u16);

/// The columns from left to right.
const COLUMNS: [Spec; 9] = [
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

/// The columns that give way where there is little room, the first first.
const GIVEN_UP: [Column; 5] = [
    Column::Tree,
    Column::Failed,
    Column::Composites,
    Column::Primitives,
    Column::Id,
];

/// Returns the columns that fit.
fn columns(width: u16) -> Vec<Spec> {
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
    /// Returns the column to sort by after this one.
    fn next(self) -> Self {
        let sortable = &COLUMNS[..COLUMNS.len() - 1];
        let here = sortable.iter().position(|(column, ..)| *column == self);
        let next = here.map_or(0, |here| (here + 1) % sortable.len());
        sortable[next].0
    }

    /// Returns the sort key of an individual.
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

    /// Returns the text of an individual's cell.
    fn text(self, individual: &RankedRecord) -> String {
        match self {
            Self::Rank => individual.rank.to_string(),
            Self::Id => individual.id.to_string(),
            Self::Steps => format!("{:.1}", individual.mean_steps()),
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

    /// Aligns a text in the column: numbers end at its right edge.
    fn aligned(self, text: String, columns: u16) -> String {
        match self {
            Self::Origin | Self::Tree => text,
            _ => format!("{text:>columns$}", columns = usize::from(columns)),
        }
    }
}

/// Counts the scored trials that were truncated at the step limit.
fn failed(individual: &RankedRecord) -> usize {
    individual.scored() - individual.delivered()
}

fn draw_individual(
    context: &ViewContext,
    columns: &[Spec],
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
    if is_selected {
        mark_selected(look, line, buffer);
    }
    let mut at = 1;
    for &(column, _, width) in columns {
        let room = match column {
            Column::Tree => line.width.saturating_sub(at),
            _ => width,
        };
        let text = fitted(&column.text(individual), room.into(), look.signs);
        let text = column.aligned(text, width);
        put(buffer, line, (at, 0), &text, look.style(paint));
        at += width + 1;
    }
}

/// Writes the whole hierarchy of the selected individual, if it fits.
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

    /// Returns the individuals that fit below the head, the selected one among them.
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

    /// Draws the heads of the columns, with a sign at the one that the table is sorted by.
    fn draw_head(&self, context: &ViewContext, columns: &[Spec], area: Rect, buffer: &mut Buffer) {
        let look = &context.look;
        let mut at: u16 = 1;
        for &(column, head, columns) in columns {
            let (head, paint) = if column == self.by {
                let sign = look.signs.order[usize::from(self.reversed)];
                (format!("{sign}{head}"), Paint::Title)
            } else {
                (head.to_owned(), Paint::Dim)
            };
            let text = column.aligned(head, columns);
            // The sign before a head as wide as its column takes the gap between columns.
            let over = match column {
                Column::Origin | Column::Tree => 0,
                _ => (width(&text) as u16).saturating_sub(columns),
            };
            put(
                buffer,
                area,
                (at.saturating_sub(over), 0),
                &text,
                look.style(paint),
            );
            at += columns + 1;
        }
    }

    /// Moves the selection by some lines.
    fn select(&self, context: &mut ViewContext, by: i64) {
        let sorted = self.sorted(context);
        let selected = context.selected().map(|individual| individual.id);
        let is_selected = |individual: &&RankedRecord| Some(individual.id) == selected;
        let last = sorted.len().saturating_sub(1);
        let next = sorted.iter().position(is_selected).map_or(0, |here| {
            (here as i64).saturating_add(by).clamp(0, last as i64)
        });
        if let Some(individual) = sorted.get(next as usize) {
            context.chosen = Chosen::Id(individual.id);
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
            match random_ranks(context) {
                // Where there is little room, only the first part is shown.
                Some(ranked) => format!("{ranked} {separator} generation {generation}"),
                None => format!("generation {generation} {separator} {count} individuals"),
            }
        })
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let Some(shown) = context.shown() else {
            return draw_no_generation(context, area, buffer);
        };
        let columns = columns(area.width);
        self.draw_head(context, &columns, area, buffer);
        let selected = context.selected().map(|individual| individual.id);
        for (index, individual) in (1..).zip(self.visible(context, area)) {
            let (line, is_selected) = (row(area, index), Some(individual.id) == selected);
            draw_individual(context, &columns, individual, is_selected, line, buffer);
        }
        let rows = u16::try_from(shown.individuals.len() + 2).unwrap_or(u16::MAX);
        draw_whole(context, below(area, rows), buffer);
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
            csv_line(
                &mut csv,
                &[
                    &individual.rank,
                    &individual.id,
                    &individual.fitness_steps,
                    &individual.scored(),
                    &individual.composites,
                    &individual.primitives.len(),
                    &individual.difference_to_best,
                    &origin(&individual.origin),
                    &one_line(&individual.tree),
                ],
            );
        }
        Some(csv)
    }

    fn help_text(&self) -> &'static str {
        "All individuals of the generation, best first. steps: the fitness, mean time steps per\n\
         scored trial. failed: scored trials that were truncated at the step limit. comp, prim:\n\
         the number of composite and of distinct primitive subtasks. diff: structural difference\n\
         to the best (Thesis 4.5.2). origin: a reproduced individual survived with what it has\n\
         learned; 165 x 172 is individual 165 with a subtree of 172."
    }
}
