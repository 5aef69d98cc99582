//! The table of subtasks: the drawn tree with numbers beside it.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::{Paint, put};
use crate::dashboard::views::shared::{BEFORE_TREE, mark_selected};
use crate::evolution::RankedRecord;
use crate::hierarchy::{Tree, TreeLine, folded_lines, lines};

/// The head of the tree.
const HEAD: &str = "subtask";
/// Columns of a temperature and of an invocation count.
const TEMPERATURE: u16 = 6;
const INVOKED: u16 = 8;
/// From this many rows on, there is also room for what stands below the tree.
const TALL: u16 = 16;
/// Rows that are kept for it, and for the head.
const BELOW: u16 = 5;

/// The lines of the tree, the numbers beside them, and where they stand.
pub(super) struct Table {
    pub(super) lines: Vec<TreeLine>,
    /// First columns of state types, temperature and count; `None` where they do not fit.
    /// The state types, which never change, give way first.
    types: Option<u16>,
    temperature: Option<u16>,
    invoked: Option<u16>,
    temperatures: Vec<Option<f32>>,
    visits: Vec<u64>,
    path: Vec<usize>,
    pub(super) selected: usize,
}

impl Table {
    /// Gathers what the table shows of an individual in an area.
    pub(super) fn of(
        context: &ViewContext,
        individual: &RankedRecord,
        tree: &Tree,
        area: Rect,
    ) -> Self {
        let columns = area.width;
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
        let lines = tree_lines(context, tree, &visits, area);
        let alone = lines.iter().filter(|line| line.nodes.len() == 1);
        let names = alone.map(TreeLine::width).fold(HEAD.len(), usize::max);
        let first = u16::try_from(names).unwrap_or(u16::MAX).saturating_add(4);
        let types = first.saturating_add(context.catalogue().state_types.len().max(5) as u16 + 1);
        let all = types.saturating_add(TEMPERATURE + INVOKED) <= columns;
        let after = if all { types } else { first };
        let fitting = |column: u16, width| {
            Some(column).filter(|column| column.saturating_add(width) <= columns)
        };
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
        put(buffer, area, (2, 0), HEAD, dim);
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

    /// Draws a line of the tree.
    pub(super) fn draw_line(
        &self,
        context: &ViewContext,
        tree: &Tree,
        line: &TreeLine,
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let (look, catalogue) = (&context.look, context.catalogue());
        let is_folded = line.nodes.len() > 1;
        let is_selected = line.has(self.selected);
        if is_selected && is_folded {
            let pointer = look.signs.pointer;
            put(buffer, area, (0, 0), pointer, look.style(Paint::Selected));
        } else if is_selected {
            mark_selected(look, area, buffer);
        }
        let mut put =
            |column, text: &str, paint| put(buffer, area, (column, 0), text, look.style(paint));
        if self.path.iter().any(|&node| line.has(node)) {
            put(1, look.signs.lit, Paint::Key);
        }
        put(BEFORE_TREE, &line.branches, Paint::Border);
        for text in &line.nodes {
            let subtask = catalogue.subtask(tree.subtask(text.node));
            let paint = match (self.path.contains(&text.node), subtask.is_composite()) {
                _ if is_folded && text.node == self.selected => Paint::Selected,
                (true, _) => Paint::Active,
                (false, true) => Paint::Title,
                (false, false) => Paint::Text,
            };
            let column = u16::try_from(text.column).unwrap_or(u16::MAX);
            put(column.saturating_add(BEFORE_TREE), &text.text, paint);
        }
        let [node] = line.nodes.as_slice() else {
            return;
        };
        if let Some(column) = self.types {
            let active = catalogue.subtask(tree.subtask(node.node)).active;
            let types = catalogue.types().map(|state_type| {
                if active.contains(state_type) {
                    state_type.number().to_string()
                } else {
                    String::from(" ")
                }
            });
            put(column, &types.collect::<String>(), Paint::Dim);
        }
        let [temperature, invoked] = self.numbers(node.node);
        if let Some(column) = self.temperature {
            put(column, &format!("{temperature:>5}"), Paint::Dim);
        }
        if let Some(column) = self.invoked {
            put(column, &format!("{invoked:>8}"), Paint::Text);
        }
    }
}

/// Returns the lines of the tree, folded if they would not fit into an area with all else.
fn tree_lines(context: &ViewContext, tree: &Tree, visits: &[u64], area: Rect) -> Vec<TreeLine> {
    let (catalogue, signs) = (context.catalogue(), context.look.signs);
    let head = if area.height >= TALL { BELOW } else { 1 };
    if tree.nodes().len() <= usize::from(area.height.saturating_sub(head)) {
        return lines(tree, catalogue, signs.tree);
    }
    let columns = usize::from(area.width.saturating_sub(BEFORE_TREE + 1));
    let name = |node| tree.subtask(node).name(catalogue);
    let counted = |node| match visits.get(node) {
        Some(count) if *count > 0 => format!("{} {count}{}", name(node), signs.times),
        _ => name(node).to_owned(),
    };
    let mut folded = folded_lines(tree, catalogue, signs.tree, columns, counted);
    for line in &mut folded {
        // Its count stands in the column.
        if let [alone] = line.nodes.as_mut_slice() {
            alone.text = name(alone.node).to_owned();
        }
    }
    folded
}
