//! The table of subtasks: the drawn tree with numbers beside it.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::{Paint, put, width};
use crate::dashboard::views::shared::{self, mark_selected};
use crate::evolution::RankedRecord;
use crate::hierarchy::{Tree, draw};

/// Columns of a temperature and of an invocation count.
const TEMPERATURE: u16 = 6;
const INVOKED: u16 = 8;

/// The lines of the tree, the numbers beside them, and where they stand.
pub(super) struct Table {
    lines: Vec<String>,
    /// First columns of state types, temperature and count; `None` where they do not fit.
    /// The state types, which never change, give way first.
    types: Option<u16>,
    temperature: Option<u16>,
    invoked: Option<u16>,
    temperatures: Vec<Option<f32>>,
    visits: Vec<u64>,
    path: Vec<usize>,
    selected: usize,
}

impl Table {
    /// Gathers what the table shows of an individual, for an area of some columns.
    pub(super) fn of(
        context: &ViewContext,
        individual: &RankedRecord,
        tree: &Tree,
        columns: u16,
    ) -> Self {
        let lines = draw(tree, context.catalogue(), context.look.signs.tree);
        let names = lines.iter().map(|line| width(line)).max().unwrap_or(0);
        let first = u16::try_from(names).unwrap_or(u16::MAX).saturating_add(4);
        let types = first.saturating_add(context.catalogue().state_types.len().max(5) as u16 + 1);
        let all = types.saturating_add(TEMPERATURE + INVOKED) <= columns;
        let after = if all { types } else { first };
        let fitting = |column: u16, width| {
            Some(column).filter(|column| column.saturating_add(width) <= columns)
        };
        let subject = context.player.subject();
        let is_of_rollout = subject.is_some_and(|subject| subject.id == individual.id);
        let rollout = context.player.rollout().filter(|_| is_of_rollout);
        let (temperatures, visits, path) = rollout
            .map(|rollout| {
                let status = rollout.status();
                (
                    rollout.temperatures(),
                    status.visits.clone(),
                    status.path.clone(),
                )
            })
            .unwrap_or_default();
        Self {
            lines,
            types: all.then_some(first),
            temperature: fitting(after, TEMPERATURE),
            invoked: fitting(after.saturating_add(TEMPERATURE), INVOKED),
            temperatures,
            visits,
            path,
            selected: context.node_in(tree),
        }
    }

    /// Returns temperature and number of invocations of a node, as texts; empty where unknown.
    pub(super) fn numbers(&self, node: usize) -> [String; 2] {
        let temperature = self.temperatures.get(node).copied().flatten();
        let temperature = temperature.map(|temperature| format!("{temperature:.3}"));
        let visits = self.visits.get(node).map(ToString::to_string);
        [temperature, visits].map(Option::unwrap_or_default)
    }

    /// Draws the heads of the columns.
    pub(super) fn draw_head(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let dim = context.look.style(Paint::Dim);
        put(buffer, area, (2, 0), "subtask", dim);
        if let Some(column) = self.types {
            put(buffer, area, (column, 0), "types", dim);
        }
        if let Some(column) = self.temperature {
            put(buffer, area, (column + 4, 0), "T", dim);
        }
        if let Some(column) = self.invoked {
            put(buffer, area, (column, 0), " invoked", dim);
        }
    }

    /// Draws the line of a node.
    pub(super) fn draw_node(
        &self,
        context: &ViewContext,
        tree: &Tree,
        node: usize,
        row: u16,
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let (look, catalogue) = (&context.look, context.catalogue());
        let subtask = catalogue.subtask(tree.subtask(node));
        let is_active = self.path.contains(&node);
        if node == self.selected {
            mark_selected(look, shared::row(area, row), buffer);
        }
        let mut put =
            |column, text: &str, paint| put(buffer, area, (column, row), text, look.style(paint));
        if is_active {
            put(1, look.signs.lit, Paint::Key);
        }
        let line = self.lines.get(node).map_or("", |line| line);
        let branches = width(line).saturating_sub(width(&subtask.name));
        let branches: String = line.chars().take(branches).collect();
        let column = put(2, &branches, Paint::Border);
        let paint = match (is_active, subtask.is_composite()) {
            (true, _) => Paint::Active,
            (false, true) => Paint::Title,
            (false, false) => Paint::Text,
        };
        put(column, &subtask.name, paint);
        if let Some(column) = self.types {
            let types = catalogue.types().map(|state_type| {
                if subtask.active.contains(state_type) {
                    state_type.number().to_string()
                } else {
                    String::from(" ")
                }
            });
            put(column, &types.collect::<String>(), Paint::Dim);
        }
        let [temperature, invoked] = self.numbers(node);
        if let Some(column) = self.temperature {
            put(column, &format!("{temperature:>5}"), Paint::Dim);
        }
        if let Some(column) = self.invoked {
            put(column, &format!("{invoked:>8}"), Paint::Text);
        }
    }
}
