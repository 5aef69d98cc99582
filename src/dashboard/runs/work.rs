//! The work of this program on the runs of the table, and the question about it when the user
//! quits.

use std::time::Duration;

use super::row::RunRow;
use crate::dashboard::chrome::overlay::{Line, plain};
use crate::dashboard::keys::{Action, Key, KeyMap, Scope};
use crate::dashboard::look::Paint;

/// An effect that the driver of the table must run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunsEffect {
    /// Open the run of this row: an index into the rows of [`RunsNews`].
    Open(usize),
    /// Quit; save and stop the work of this program on the runs.
    Leave,
    /// Quit the table, and continue the work on the runs.
    Detach,
    /// Suspend the program.
    Suspend,
    /// Redraw the whole screen, whatever the terminal shows.
    Redraw,
}

/// News of the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct RunsNews {
    /// The runs, always in the same order.
    pub rows: Vec<RunRow>,
    /// The work of this program on the runs, if there is any.
    pub work: Option<Work>,
}

/// The work of this program on runs, which ends with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// The time left, if it is known.
    pub left: Option<Duration>,
}

impl Work {
    /// Returns the time left in words, to the nearest unit that matters.
    pub(super) fn words(self) -> Option<String> {
        let seconds = self.left?.as_secs();
        let (hours, minutes) = (seconds / 3600, seconds / 60);
        Some(match (hours, minutes) {
            (0, 0) => format!("about {seconds} s left"),
            (0, _) => format!("about {minutes} min left"),
            _ => format!("about {hours} h {:02} min left", minutes % 60),
        })
    }
}

/// Returns the lines of the question to a user who quits while there is work.
pub(super) fn question(keys: &KeyMap) -> Vec<Line> {
    let answers = [
        (
            Action::Yes,
            "save and stop; the same command resumes the study",
        ),
        (
            Action::Detach,
            "leave the table; the runs continue with a progress bar",
        ),
        (Action::No, "stay"),
    ];
    let line = |(action, text): (Action, &str)| {
        let keys: Vec<_> = keys.keys(action).iter().map(ToString::to_string).collect();
        (keys.join(" "), text.to_owned(), Paint::Text)
    };
    let asked = plain("Runs of the study are in progress. Stop them?");
    [asked].into_iter().chain(answers.map(line)).collect()
}

/// Returns the effect of an answer; any other key closes the question.
pub(super) fn answer(keys: &KeyMap, key: Key) -> Option<RunsEffect> {
    match keys.in_scope(key, Scope::Question) {
        Some(Action::Yes) => Some(RunsEffect::Leave),
        Some(Action::Detach) => Some(RunsEffect::Detach),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_in_the_units_that_matter() {
        let words = |seconds| {
            let left = Some(Duration::from_secs(seconds));
            Work { left }.words().unwrap()
        };
        assert_eq!(words(59), "about 59 s left");
        assert_eq!(words(60), "about 1 min left");
        assert_eq!(words(3 * 3600 + 61), "about 3 h 01 min left");
        assert_eq!(Work { left: None }.words(), None);
    }
}
