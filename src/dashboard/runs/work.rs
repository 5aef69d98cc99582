//! Work of this program on the runs of the table, and what becomes of it when a person
//! leaves.

use std::time::Duration;

use super::row::RunRow;
use crate::dashboard::chrome::overlay::{Line, plain};
use crate::dashboard::keys::{Action, Key, KeyMap, Scope};
use crate::dashboard::look::Paint;

/// Something to be done by whoever drives the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunsEffect {
    /// Open the run of this row, by its place in the rows that were told.
    Open(usize),
    /// Leave; work of this program on the runs is to be saved and stopped.
    Leave,
    /// Leave, and go on with the work on the runs.
    Detach,
    /// Put the program into the background of its shell.
    Suspend,
    /// Forget what is on the terminal and draw everything again.
    Redraw,
}

/// What is new of the runs.
#[derive(Clone, Debug, PartialEq)]
pub struct RunsNews {
    /// The runs as they are now, always in the same order.
    pub rows: Vec<RunRow>,
    /// Work of this program on them; `None` if it does none, or none any more.
    pub work: Option<Work>,
}

/// Work of this program on runs, which does not outlive it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    /// How long it will take, where that can be told.
    pub left: Option<Duration>,
}

impl Work {
    /// How long it will take, in words, to the nearest unit that matters.
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

/// What is asked of a person who leaves while there is work, and what can be answered.
pub(super) fn question(keys: &KeyMap) -> Vec<Line> {
    let answers = [
        (
            Action::Yes,
            "save and stop; the same command goes on with it",
        ),
        (Action::Detach, "leave, and go on with a progress bar"),
        (Action::No, "stay"),
    ];
    let line = |(action, text): (Action, &str)| {
        let keys: Vec<_> = keys.keys(action).iter().map(ToString::to_string).collect();
        (keys.join(" "), text.to_owned(), Paint::Text)
    };
    let asked = plain("Runs of the study are being done. Stop them?");
    [asked].into_iter().chain(answers.map(line)).collect()
}

/// What an answer leads to; any other key stays.
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
