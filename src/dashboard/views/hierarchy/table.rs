//! What is told of each subtask of a hierarchy.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::{Paint, put, width};
use crate::evolution::RankedRecord;
use crate::hierarchy::{Tree, draw};

/// Columns of a temperature and of a count.
const TEMPERATURE: u16 = 6;
const INVOKED: u16 = 8;

/// What is told of each node, and where.
pub(super) struct Table {
    lines: Vec<String>,
    /// Columns of state types, temperature and count; `None` where there is no room. What
    /// never changes gives way first.
    types: Option<u16>,
    temperature: Option<u16>,
    invoked: Option<u16>,
    temperatures: Vec<Option<f32>>,
    visits: Vec<u64>,
    path: Vec<usize>,
    selected: usize,
}

impl Table {
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
        let on_stage = context
            .player
            .subject()
            .is_some_and(|subject| subject.id == individual.id);
        let rollout = context.player.rollout().filter(|_| on_stage);
        Self {
            lines,
            types: all.then_some(first),
            temperature: Some(after).filter(|column| column.saturating_add(TEMPERATURE) <= columns),
            invoked: Some(after.saturating_add(TEMPERATURE))
                .filter(|column| column.saturating_add(INVOKED) <= columns),
            temperatures: rollout
                .map(|rollout| rollout.temperatures())
                .unwrap_or_default(),
            visits: rollout
                .map(|rollout| rollout.status().visits.clone())
                .unwrap_or_default(),
            path: rollout
                .map(|rollout| rollout.status().path.clone())
                .unwrap_or_default(),
            selected: context.node_in(tree),
        }
    }

    /// Temperature and number of invocations of a node, as far as they are known.
    pub(super) fn numbers(&self, node: usize) -> [String; 2] {
        let temperature = self.temperatures.get(node).copied().flatten();
        [
            temperature
                .map(|temperature| format!("{temperature:.3}"))
                .unwrap_or_default(),
            self.visits
                .get(node)
                .map(ToString::to_string)
                .unwrap_or_default(),
        ]
    }

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
        let lit = self.path.contains(&node);
        let dim = look.style(Paint::Dim);
        let line = self.lines.get(node).map_or("", |line| line);
        let branches = width(line).saturating_sub(width(&subtask.name));
        let branches: String = line.chars().take(branches).collect();
        let is_selected = node == self.selected;
        if is_selected {
            let line = Rect {
                y: area.y + row,
                height: u16::from(row < area.height),
                ..area
            };
            let style = look.style(Paint::Selected);
            buffer.set_style(line.intersection(buffer.area), style);
            put(buffer, line, (0, 0), look.signs.pointer, style);
        }
        if lit {
            let style = look.style(Paint::Key);
            put(buffer, area, (1, row), look.signs.lit, style);
        }
        let column = put(buffer, area, (2, row), &branches, look.style(Paint::Border));
        let paint = match (lit, subtask.is_composite()) {
            (true, _) => Paint::Active,
            (false, true) => Paint::Title,
            (false, false) => Paint::Text,
        };
        put(
            buffer,
            area,
            (column, row),
            &subtask.name,
            look.style(paint),
        );
        if let Some(column) = self.types {
            let types =
                catalogue
                    .types()
                    .map(|state_type| match subtask.active.contains(state_type) {
                        true => state_type.number().to_string(),
                        false => String::from(" "),
                    });
            let types: String = types.collect();
            put(buffer, area, (column, row), &types, dim);
        }
        let [temperature, invoked] = self.numbers(node);
        if let Some(column) = self.temperature {
            put(
                buffer,
                area,
                (column, row),
                &format!("{temperature:>5}"),
                dim,
            );
        }
        if let Some(column) = self.invoked {
            put(
                buffer,
                area,
                (column, row),
                &format!("{invoked:>8}"),
                look.style(Paint::Text),
            );
        }
    }
}
