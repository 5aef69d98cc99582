//! The text below the tree: the selected subtask, and how the individual was made and scored.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::{Paint, one_line, put, wrapped};
use crate::dashboard::views::shared::origin_lines;
use crate::evolution::RankedRecord;
use crate::hierarchy::Tree;
use crate::worlds::{Kind, StateTypes};

/// Draws as much of the text as fits.
pub(super) fn draw(
    context: &ViewContext,
    tree: &Tree,
    individual: &RankedRecord,
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &context.look;
    let room = usize::from(area.width.saturating_sub(3));
    let texts = about(context, tree).into_iter().chain(story(individual));
    let lines = texts.flat_map(|(text, paint)| {
        let lines = wrapped(&one_line(&text), room, "  ");
        lines.into_iter().map(move |line| (line, paint))
    });
    for (row, (text, paint)) in (0..area.height).zip(lines) {
        put(buffer, area, (2, row), &text, look.style(paint));
    }
}

/// Describes purpose and kind of the selected subtask.
fn about(context: &ViewContext, tree: &Tree) -> Vec<(String, Paint)> {
    let catalogue = context.catalogue();
    let node = context.node_in(tree);
    if node >= tree.nodes().len() {
        return Vec::new();
    }
    let subtask = catalogue.subtask(tree.subtask(node));
    let numbers = |types: StateTypes| {
        let numbers = types.iter().map(|state_type| {
            if state_type == catalogue.terminal() {
                String::from("done")
            } else {
                state_type.number().to_string()
            }
        });
        numbers.collect::<Vec<_>>().join(" ")
    };
    let (kind, what) = match &subtask.kind {
        Kind::Composite { goal, .. } => ("composite", format!("goal: {}", numbers(*goal))),
        Kind::Primitive { actions, .. } => ("primitive", format!("actions: {}", actions.join(" "))),
    };
    let active = numbers(subtask.active);
    vec![
        (
            format!("{}: {}", subtask.name, subtask.purpose),
            Paint::Title,
        ),
        (
            format!("{kind}, active in state types {active}; {what}"),
            Paint::Dim,
        ),
    ]
}

/// Tells how the individual scored, and how it was made.
fn story(individual: &RankedRecord) -> Vec<(String, Paint)> {
    let trials = individual.trials.iter().map(|trial| {
        let mark = if trial.delivered { "" } else { "!" };
        format!("{}{mark}", trial.steps)
    });
    let unlisted = individual
        .unlisted
        .map(|unlisted| format!("and {} more", unlisted.trials));
    let trials = trials.chain(unlisted).collect::<Vec<_>>().join(" ");
    let scored = (
        format!("time steps of scored trials: {trials}"),
        Paint::Text,
    );
    let origin = origin_lines(&individual.origin, Paint::Text);
    [scored].into_iter().chain(origin).collect()
}
