//! What several views say and draw alike.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::dashboard::context::{Activity, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Chart, Curve, Paint, axis_end, fitted, put};
use crate::evolution::Origin;
use crate::scenario::Selection;
use crate::worlds::scene::Snapshot;

/// What leads through time, for the hint bars of views that show all generations.
pub(super) const THROUGH_TIME: &[Action] = &[
    Action::Earlier,
    Action::Later,
    Action::First,
    Action::Follow,
    Action::Play,
];

/// Curves over the generations so far, the one shown marked. While there are more to come the
/// axis has room for them.
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

/// That ranks do not tell who is better, where they do not.
pub(super) fn by_chance(context: &ViewContext) -> Option<&'static str> {
    let selection = context.scenario().evolution.selection;
    (selection == Selection::Random).then_some("ranked by chance")
}

/// How fast the rollout goes, and whether it does.
pub(super) fn pace(context: &ViewContext) -> String {
    let speed = context.player.speed();
    match context.player.halted() {
        true => format!("halted, {speed}x"),
        false => format!("{speed}x"),
    }
}

/// Says why there is no individual to look at.
pub(super) fn nobody(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    let text = context
        .player
        .load_error()
        .unwrap_or("no individual has lived yet");
    let room = usize::from(area.width.saturating_sub(1));
    let text = fitted(text, room, context.look.signs);
    put(buffer, area, (1, 0), &text, context.look.style(Paint::Dim));
}

/// Says that there is nothing to see yet.
pub(super) fn nothing_yet(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    let room = usize::from(area.width.saturating_sub(1));
    let text = fitted("no generation has lived yet", room, context.look.signs);
    put(buffer, area, (1, 0), &text, context.look.style(Paint::Dim));
}

/// What is the case besides the agent's place, where the state type does not tell: in worlds
/// of cells.
pub(super) fn case<'d>(context: &'d ViewContext, snapshot: &Snapshot) -> Option<&'d str> {
    context.scenery().grid?;
    let is_done = snapshot.state_type == context.catalogue().terminal();
    let variants = context.experiment.variants();
    let case = variants.get(snapshot.variant).filter(|_| !is_done);
    case.filter(|_| variants.len() > 1).map(String::as_str)
}

/// How an individual came to be, in a word or two.
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
