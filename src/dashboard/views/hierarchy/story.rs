//! Below the tree: what the selected subtask is, and how the individual came to be and did.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::ViewContext;
use crate::dashboard::look::{Paint, one_line, put, wrapped};
use crate::dashboard::views::shared::origin;
use crate::evolution::{Origin, RankedRecord};
use crate::hierarchy::Tree;
use crate::worlds::{Kind, StateTypes, Subtask};

/// Draws it, as much as there is room for.
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

/// What the selected subtask is.
fn about(context: &ViewContext, tree: &Tree) -> Vec<(String, Paint)> {
    let catalogue = context.catalogue();
    let node = context.node_in(tree);
    if node >= tree.nodes().len() {
        return Vec::new();
    }
    let Subtask {
        name,
        purpose,
        active,
        kind,
        ..
    } = catalogue.subtask(tree.subtask(node));
    let types = |types: StateTypes| -> String {
        let words = types
            .iter()
            .map(|state_type| match state_type == catalogue.terminal() {
                true => String::from("done"),
                false => state_type.number().to_string(),
            });
        words.collect::<Vec<_>>().join(" ")
    };
    let active = types(*active);
    let how = match kind {
        Kind::Composite { goal, .. } => {
            format!(
                "composite, active in state type {active}; its goal: {}",
                types(*goal)
            )
        }
        Kind::Primitive { actions } => {
            let actions = actions.join(" ");
            format!("primitive, active in state type {active}; its actions: {actions}")
        }
    };
    vec![
        (format!("{name}: {purpose}"), Paint::Title),
        (how, Paint::Dim),
    ]
}

fn story(individual: &RankedRecord) -> Vec<(String, Paint)> {
    let steps: Vec<_> = individual
        .trials
        .iter()
        .map(|trial| match trial.delivered {
            true => trial.steps.to_string(),
            false => format!("{}!", trial.steps),
        })
        .collect();
    let mut story = vec![(format!("scored trials {}", steps.join(" ")), Paint::Text)];
    match &individual.origin {
        Origin::Crossover {
            receiver,
            donor,
            inherited,
            reset,
            ..
        } => {
            let made = format!(
                "made of {} by putting {}'s {} in the place of {}",
                receiver.id, donor.id, donor.subtask, receiver.subtask
            );
            let kept: Vec<_> = inherited
                .iter()
                .map(|kept| format!("{} from {}", kept.subtask, kept.from))
                .collect();
            story.push((made, Paint::Text));
            story.push((format!("inherited: {}", listed(&kept)), Paint::Text));
            story.push((format!("set back: {}", listed(reset)), Paint::Dim));
        }
        other => story.push((origin(other), Paint::Text)),
    }
    let mutations = individual.origin.mutations().iter();
    story.extend(mutations.map(|mutation| (format!("mutation: {mutation}"), Paint::Notice)));
    story
}

fn listed(names: &[String]) -> String {
    match names {
        [] => String::from("nothing"),
        names => names.join(", "),
    }
}
