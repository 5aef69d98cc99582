//! Helpers that several views share.

use std::fmt::{Display, Write};

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use crate::dashboard::context::{Activity, Clicked, ViewContext, line_at};
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::Pen;
use crate::dashboard::look::{Chart, Curve, Look, Paint, axis_end, fitted, put};
use crate::evolution::Origin;
use crate::hierarchy::TreeLine;
use crate::scenario::Selection;
use crate::worlds::scene::Snapshot;

/// Hints of the views that show all generations: the keys that travel through time.
pub(super) const THROUGH_TIME: &[Action] = &[
    Action::Earlier,
    Action::Later,
    Action::First,
    Action::Follow,
    Action::Play,
];

/// Returns a chart over the generations so far, with a cursor at the generation shown.
///
/// While evolution is not over, the axis leaves room for the generations to come.
pub(super) fn over_generations(
    context: &ViewContext,
    curves: Vec<Curve>,
    least: [f64; 2],
) -> Chart {
    let mut chart = Chart::of(curves, least);
    let shown = context.shown().map(|record| record.generation);
    chart.cursor = shown.map(|number| number as f64);
    let is_over = matches!(context.activity(), Activity::Finished | Activity::Stopped);
    let latest = context.history().latest().map(|record| record.generation);
    if let (false, Some(latest)) = (is_over, latest) {
        let limit = context.scenario().evolution.generation_limit;
        chart.across[1] = axis_end(latest, limit) as f64;
    }
    chart
}

/// Returns a note for runs that select at random: their ranks do not tell who is better.
pub(super) fn random_ranks(context: &ViewContext) -> Option<&'static str> {
    let selection = context.scenario().evolution.selection;
    (selection == Selection::Random).then_some("ranked at random")
}

/// Names individual and generation of the rollout, for a caption.
pub(super) fn subject(context: &ViewContext) -> String {
    let subject = context.player.subject();
    subject.map_or(String::new(), |subject| subject.to_string())
}

/// Returns the speed of the rollout, and whether it is halted.
pub(super) fn pace(context: &ViewContext) -> String {
    let speed = context.player.speed();
    if context.player.halted() {
        format!("halted, {speed}x")
    } else {
        format!("{speed}x")
    }
}

/// Returns the reason why there is no individual to show.
pub(super) fn no_individual(context: &ViewContext) -> &str {
    match context.player.load_error() {
        Some(error) => error,
        None if context.shown().is_none() => "no individual evaluated yet",
        None => "loading the individual",
    }
}

/// Explains why there is no individual to show.
pub(super) fn draw_no_individual(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    draw_note(context, no_individual(context), area, buffer);
}

/// Explains that there is no generation to show.
pub(super) fn draw_no_generation(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    draw_note(context, "no generation evaluated yet", area, buffer);
}

/// Writes a note in place of a view's content.
pub(super) fn draw_note(context: &ViewContext, note: &str, area: Rect, buffer: &mut Buffer) {
    let room = usize::from(area.width.saturating_sub(1));
    let note = fitted(note, room, context.look.signs);
    put(buffer, area, (1, 0), &note, context.look.style(Paint::Dim));
}

/// Returns the part of an area below its first rows.
pub(super) fn below(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect {
        y: area.y + rows,
        height: area.height - rows,
        ..area
    }
}

/// Returns the part of an area right of its first columns.
pub(super) fn right_of(area: Rect, columns: u16) -> Rect {
    let columns = columns.min(area.width);
    Rect {
        x: area.x + columns,
        width: area.width - columns,
        ..area
    }
}

/// Marks a row as the selected one.
pub(super) fn mark_selected(look: &Look, line: Rect, buffer: &mut Buffer) {
    let style = look.style(Paint::Selected);
    buffer.set_style(line.intersection(buffer.area), style);
    put(buffer, line, (0, 0), look.signs.pointer, style);
}

/// Returns one row of an area; an empty area where it has no such row.
pub(super) fn row(area: Rect, row: u16) -> Rect {
    let below = below(area, row);
    Rect {
        height: below.height.min(1),
        ..below
    }
}

/// Returns a line of text in one paint.
pub(super) fn line(look: &Look, text: impl Into<String>, paint: Paint) -> Line<'static> {
    Pen::new(look).text(text, paint).line()
}

/// Returns the keys of an action as the hint bar writes them.
pub(super) fn keys(context: &ViewContext, action: Action) -> String {
    let hint = context.keys.hint(action, context.look.signs);
    hint.map_or(String::new(), |(keys, _)| keys)
}

/// Columns before a tree: the pointer, and a sign for active subtasks.
pub(super) const BEFORE_TREE: u16 = 2;

/// Returns the line of a drawn tree that holds a node.
pub(super) fn line_of(lines: &[TreeLine], node: usize) -> usize {
    lines.iter().position(|line| line.has(node)).unwrap_or(0)
}

/// Selects the node at a position of a tree whose lines are drawn into `place`, without the
/// first `skipped` ones.
pub(super) fn click_node(
    context: &mut ViewContext,
    lines: &[TreeLine],
    (place, skipped): (Rect, usize),
    at: Position,
) -> Clicked {
    let line = line_at(at, place, 0).and_then(|line| lines.get(line + skipped));
    let column = at.x.saturating_sub(place.x + BEFORE_TREE);
    let node = line.and_then(|line| line.at(column.into()));
    let nodes = lines.iter().map(|line| line.nodes.len()).sum::<usize>();
    let selected = context.node.min(nodes.saturating_sub(1));
    Clicked::on(node, selected, |node| context.node = node)
}

/// Appends a line to a CSV table. Fields with commas are quoted.
pub(super) fn csv_line(csv: &mut String, fields: &[&dyn Display]) {
    for (index, field) in fields.iter().enumerate() {
        let separator = if index > 0 { "," } else { "" };
        let field = field.to_string();
        let quote = if field.contains(',') { "\"" } else { "" };
        // Writing to a string cannot fail.
        let _ = write!(csv, "{separator}{quote}{field}{quote}");
    }
    csv.push('\n');
}

/// Returns the name of the state's variant, for example `from R to G`.
///
/// Only worlds of cells with several variants name it, and only until the task is done.
pub(super) fn variant_name<'d>(context: &'d ViewContext, snapshot: &Snapshot) -> Option<&'d str> {
    context.scenery().grid?;
    let is_done = snapshot.state_type == context.catalogue().terminal();
    let variants = context.experiment.variants();
    let variant = variants.get(snapshot.variant).filter(|_| !is_done);
    variant.filter(|_| variants.len() > 1).map(String::as_str)
}

/// Tells in a few words how an individual was made.
pub(super) fn origin(origin: &Origin) -> String {
    match origin {
        Origin::HandCoded => String::from("hand-coded"),
        Origin::Random => String::from("random"),
        Origin::Reproduced => String::from("reproduced"),
        Origin::Crossover {
            receiver, donor, ..
        } => format!("{} x {}", receiver.id, donor.id),
        Origin::Copied { from, .. } => format!("copy of {from}"),
    }
}

/// Tells in full how an individual was made: the crossover with what was inherited and reset,
/// and the mutations. `plain` is the paint of an origin without crossover.
pub(super) fn origin_lines(of: &Origin, plain: Paint) -> Vec<(String, Paint)> {
    let mut lines = if let Origin::Crossover {
        receiver,
        donor,
        inherited,
        reset,
        ..
    } = of
    {
        let inherited = inherited.iter();
        let inherited = inherited.map(|part| format!("{} from {}", part.subtask, part.from));
        let made = format!(
            "{} with its {} replaced by {} of {}",
            receiver.id, receiver.subtask, donor.subtask, donor.id
        );
        let inherited = format!("inherited {}", listed(&inherited.collect::<Vec<_>>()));
        vec![
            (made, Paint::Text),
            (inherited, Paint::Text),
            (was_reset(reset), Paint::Dim),
        ]
    } else {
        vec![(origin(of), plain)]
    };
    let mutations = of.mutations().iter();
    lines.extend(mutations.map(|mutation| (format!("mutation: {mutation}"), Paint::Notice)));
    lines
}

/// Tells what crossover reset. With `reset: child` it is no whole subtask.
fn was_reset(subtasks: &[String]) -> String {
    if subtasks.is_empty() {
        return String::from("reset what the parent of the new subtask knew of it");
    }
    format!("reset {}", listed(subtasks))
}

fn listed(names: &[String]) -> String {
    if names.is_empty() {
        String::from("nothing")
    } else {
        names.join(", ")
    }
}
