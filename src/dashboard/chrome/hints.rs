//! Which actions a hint bar names: those that can do something as things are.

use crate::dashboard::context::{Activity, Mode, ShownGeneration, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::view_id::ViewId;
use crate::dashboard::views::View;

/// Actions that lead around the overview.
const AROUND: &[Action] = &[Action::NextPanel, Action::Open];

/// Actions that a hint bar names after those of the view.
const COMMON: &[Action] = &[
    Action::Pause,
    Action::StepGeneration,
    Action::Freeze,
    Action::Earlier,
    Action::Later,
    Action::Export,
];

/// Actions that every hint bar ends with.
pub(in crate::dashboard) const ALWAYS: &[Action] = &[Action::Help, Action::Quit];
/// The same where there is somewhere to go back to.
const ALWAYS_WITHIN: &[Action] = &[Action::Help, Action::Back];

/// Actions that every hint bar of the dashboard ends with.
pub(in crate::dashboard) fn always(context: &ViewContext) -> &'static [Action] {
    match context.within {
        true => ALWAYS_WITHIN,
        false => ALWAYS,
    }
}

/// Actions that are named before those, most useful first; `active` is the view that keys act
/// on.
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

/// What an action does as things are, in a word or two: what is held goes on.
pub(in crate::dashboard) fn word(context: &ViewContext, action: Action) -> &'static str {
    match action {
        Action::Pause if context.activity() == Activity::Paused => "resume",
        Action::Freeze if context.frozen() => "unfreeze",
        Action::Play if context.playing => "hold",
        Action::Halt if context.player.halted() => "go on",
        _ => action.hint(),
    }
}

/// Whether an action can do something, whatever the view.
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
