//! Keys that steer evolution, where it can be steered.

use super::desk::{Activity, Desk, Mode};
use super::input::Effect;
use super::keys::Action;
use super::overlay::Question;

/// What became of an action.
pub(super) enum Steered {
    /// It does not steer evolution.
    Nothing,
    /// It is done when this is answered.
    Ask(Question),
    /// It is done, or it was said why it cannot be.
    Done(Option<Effect>),
}

/// Does what an action asks of the run.
pub(super) fn steer(desk: &mut Desk, action: Action) -> Steered {
    let activity = desk.activity();
    let over = matches!(activity, Activity::Finished | Activity::Stopped);
    let wanted = match action {
        Action::Quit if desk.mode == Mode::Live && !over => return Steered::Ask(Question::Quit),
        Action::Quit => return Steered::Done(Some(Effect::Quit)),
        Action::Pause if activity == Activity::Paused => Effect::Resume,
        Action::Pause => Effect::Pause,
        Action::StepGeneration => Effect::Step,
        Action::Checkpoint => Effect::Checkpoint,
        Action::Stop => Effect::Stop,
        _ => return Steered::Nothing,
    };
    let why_not = match (desk.mode, activity) {
        (Mode::Replay, _) => Some("a replay: there is no evolution to steer"),
        (Mode::Watch, _) => Some("another process's run: it can be watched, not steered"),
        (_, Activity::Finished) => Some("evolution is over"),
        (_, Activity::Stopped | Activity::Stopping) => Some("evolution was stopped"),
        _ => None,
    };
    if let Some(why_not) = why_not {
        desk.say(why_not);
        return Steered::Done(None);
    }
    match wanted {
        Effect::Stop => return Steered::Ask(Question::Stop),
        Effect::Step => desk.stepping = true,
        Effect::Resume | Effect::Pause => desk.stepping = false,
        _ => {}
    }
    Steered::Done(Some(wanted))
}
