//! The choice of hints: actions that would have an effect now.

use crate::dashboard::context::{Activity, Mode, ShownGeneration, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::view_id::ViewId;
use crate::dashboard::views::View;

/// Actions that move around the overview.
const AROUND: &[Action] = &[Action::NextPanel, Action::Open];

/// Actions named after those of the view.
const COMMON: &[Action] = &[
    Action::Pause,
    Action::StepGeneration,
    Action::Freeze,
    Action::Earlier,
    Action::Later,
    Action::Export,
];

/// Actions at the right end of every hint bar.
pub(in crate::dashboard) const ALWAYS: &[Action] = &[Action::Help, Action::Quit];
/// The same in a dashboard that was opened from a list of runs.
const ALWAYS_WITH_BACK: &[Action] = &[Action::Help, Action::Back];

/// Returns the actions at the right end of the hint bar.
pub(in crate::dashboard) fn always(context: &ViewContext) -> &'static [Action] {
    if context.has_back {
        ALWAYS_WITH_BACK
    } else {
        ALWAYS
    }
}

/// Returns the actions at the left end of the hint bar, most useful first; `active` is the view
/// that keys act on.
pub(in crate::dashboard) fn useful(
    context: &ViewContext,
    view: ViewId,
    active: &dyn View,
) -> Vec<Action> {
    let hints = active.hints();
    let order = match view {
        ViewId::Overview => [AROUND, COMMON, hints],
        _ => [hints, &[Action::Back], COMMON],
    };
    let mut actions = Vec::new();
    for &action in order.into_iter().flatten() {
        let known = always(context).contains(&action) || actions.contains(&action);
        if !known && can(context, action) && active.can(context, action) {
            actions.push(action);
        }
    }
    actions
}

/// Returns the hint of an action in the current state: a toggle names what it would switch to.
pub(in crate::dashboard) fn word(context: &ViewContext, action: Action) -> &'static str {
    match action {
        Action::Pause if context.activity() == Activity::Paused => "resume",
        Action::Freeze if context.frozen() => "unfreeze",
        Action::Play if context.playing => "stop playing",
        Action::Halt if context.player.halted() => "resume",
        _ => action.hint(),
    }
}

/// Returns whether `action` would have an effect now, whatever the view.
fn can(context: &ViewContext, action: Action) -> bool {
    let rollout = context.player.rollout();
    match action {
        Action::Pause | Action::StepGeneration | Action::Checkpoint | Action::Stop => {
            let over = [Activity::Stopping, Activity::Stopped, Activity::Finished];
            context.mode == Mode::Live && !over.contains(&context.activity())
        }
        Action::Freeze => context.mode != Mode::Replay,
        Action::Earlier | Action::MuchEarlier | Action::First => {
            let first = context.history().generations().first();
            let number = |record: &crate::evolution::GenerationRecord| record.generation;
            context.shown().map(|record| number(record)) != first.map(|record| number(record))
        }
        Action::Later | Action::MuchLater | Action::Follow => {
            context.time() != ShownGeneration::Latest
        }
        Action::Play => context.history().generations().len() > 1,
        Action::Best => {
            let best = context
                .shown()
                .and_then(|record| record.individuals.first());
            context.selected().map(|one| one.id) != best.map(|one| one.id)
        }
        Action::Mark | Action::Sort | Action::Reverse => context.selected().is_some(),
        Action::Halt | Action::StepRollout | Action::Restart | Action::NextTrial => {
            rollout.is_some()
        }
        Action::Faster => rollout.is_some() && context.player.can_change_speed(true),
        Action::Slower => rollout.is_some() && context.player.can_change_speed(false),
        _ => true,
    }
}
