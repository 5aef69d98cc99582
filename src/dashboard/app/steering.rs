//! Actions that steer the run.

use crate::dashboard::chrome::overlay::Question;
use crate::dashboard::context::{Activity, Effect, Mode, ViewContext};
use crate::dashboard::keys::Action;

/// The outcome of an action.
pub(super) enum Steered {
    /// The action does not steer the run.
    Nothing,
    /// The action waits for the answer to this question.
    Ask(Question),
    /// The action was handled: run this effect, if any; otherwise a message says why not.
    Done(Option<Effect>),
}

/// Handles an action that steers the run.
pub(super) fn steer(context: &mut ViewContext, action: Action) -> Steered {
    let activity = context.activity();
    let over = matches!(activity, Activity::Finished | Activity::Stopped);
    let wanted = match action {
        Action::Quit if context.mode == Mode::Live && !over => return Steered::Ask(Question::Quit),
        Action::Quit => return Steered::Done(Some(Effect::Quit)),
        Action::Pause if activity == Activity::Paused => Effect::Resume,
        Action::Pause => Effect::Pause,
        Action::StepGeneration => Effect::Step,
        Action::Checkpoint => Effect::Checkpoint,
        Action::Stop => Effect::Stop,
        _ => return Steered::Nothing,
    };
    let why_not = match (context.mode, activity) {
        (Mode::Replay, _) => Some("this is a replay: there is no evolution to steer"),
        (Mode::Watch, _) => {
            Some("another process computes this run: it can be watched, not steered")
        }
        (_, Activity::Finished) => Some("evolution has finished"),
        (_, Activity::Stopped | Activity::Stopping) => Some("evolution has been stopped"),
        _ => None,
    };
    if let Some(why_not) = why_not {
        context.show_message(why_not);
        return Steered::Done(None);
    }
    match wanted {
        Effect::Stop => return Steered::Ask(Question::Stop),
        Effect::Step => context.stepping = true,
        Effect::Resume | Effect::Pause => context.stepping = false,
        _ => {}
    }
    Steered::Done(Some(wanted))
}
