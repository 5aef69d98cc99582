//! Which actions a hint bar names: those that can do something as things are.

use super::desk::{Activity, Desk, Mode, Time};
use super::keys::Action;
use super::view_id::ViewId;
use super::views::View;

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
pub(super) const ALWAYS: &[Action] = &[Action::Help, Action::Quit];
/// The same where there is somewhere to go back to.
const ALWAYS_WITHIN: &[Action] = &[Action::Help, Action::Back];

/// Actions that every hint bar of the dashboard ends with.
pub(super) fn always(desk: &Desk) -> &'static [Action] {
    match desk.within {
        true => ALWAYS_WITHIN,
        false => ALWAYS,
    }
}

/// Actions that are named before those, most useful first; `active` is the view that keys act
/// on.
pub(super) fn useful(desk: &Desk, view: ViewId, active: &dyn View) -> Vec<Action> {
    let hints = active.hints();
    let order = match view {
        ViewId::Overview => [AROUND, COMMON, hints],
        _ => [hints, &[Action::Back], COMMON],
    };
    let mut actions = Vec::new();
    for &action in order.into_iter().flatten() {
        let known = always(desk).contains(&action) || actions.contains(&action);
        if !known && can(desk, action) && active.can(desk, action) {
            actions.push(action);
        }
    }
    actions
}

/// What an action does as things are, in a word or two: what is held goes on.
pub(super) fn word(desk: &Desk, action: Action) -> &'static str {
    match action {
        Action::Pause if desk.activity() == Activity::Paused => "resume",
        Action::Freeze if desk.frozen() => "unfreeze",
        Action::Play if desk.playing => "hold",
        Action::Halt if desk.stage.halted() => "go on",
        _ => action.hint(),
    }
}

/// Whether an action can do something, whatever the view.
fn can(desk: &Desk, action: Action) -> bool {
    let rollout = desk.stage.rollout();
    match action {
        Action::Pause | Action::StepGeneration | Action::Checkpoint | Action::Stop => {
            let over = [Activity::Stopping, Activity::Stopped, Activity::Finished];
            desk.mode == Mode::Live && !over.contains(&desk.activity())
        }
        Action::Freeze => desk.mode != Mode::Replay,
        Action::Earlier | Action::MuchEarlier | Action::First => {
            let first = desk.model().generations().first();
            let number = |record: &crate::evolution::GenerationRecord| record.generation;
            desk.shown().map(|record| number(record)) != first.map(|record| number(record))
        }
        Action::Later | Action::MuchLater | Action::Follow => desk.time() != Time::Latest,
        Action::Play => desk.model().generations().len() > 1,
        Action::Best => {
            let best = desk.shown().and_then(|record| record.individuals.first());
            desk.selected().map(|one| one.id) != best.map(|one| one.id)
        }
        Action::Mark | Action::Sort | Action::Reverse => desk.selected().is_some(),
        Action::Halt | Action::StepRollout | Action::Restart | Action::NextTrial => {
            rollout.is_some()
        }
        Action::Faster => rollout.is_some() && desk.stage.can_change_speed(true),
        Action::Slower => rollout.is_some() && desk.stage.can_change_speed(false),
        _ => true,
    }
}
