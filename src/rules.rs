//! Checks of settings: which rule is broken, where, what was found there and what is allowed.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;

use crate::words::{quoted, shortened};

/// A broken rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Where it is broken, as a dotted path: `world.foraging.arena.walls_mm[3]`.
    pub place: String,
    /// The value found there.
    pub found: String,
    /// The values allowed there.
    pub allowed: String,
}

impl Problem {
    /// Creates the problem that `found` stands at `place`, where only `allowed` is allowed.
    pub fn new(place: impl Into<String>, found: impl Display, allowed: impl Display) -> Self {
        Self {
            place: place.into(),
            found: found.to_string(),
            allowed: allowed.to_string(),
        }
    }

    /// Returns this problem with its place moved below `outer`.
    #[must_use]
    pub fn within(mut self, outer: &str) -> Self {
        self.place = join(outer, &self.place);
        self
    }
}

impl Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            place,
            found,
            allowed,
        } = self;
        write!(f, "{place}: found {found}; allowed: {allowed}")
    }
}

/// Collects problems, and keeps track of the place that is being checked.
#[derive(Debug, Default)]
pub struct Check {
    place: String,
    problems: Vec<Problem>,
}

impl Check {
    /// Returns the problems found.
    #[must_use]
    pub fn problems(self) -> Vec<Problem> {
        self.problems
    }

    /// Runs `rules` at `part` of the current place.
    pub fn within(&mut self, part: &str, rules: impl FnOnce(&mut Self)) {
        let inner = join(&self.place, part);
        let outer = std::mem::replace(&mut self.place, inner);
        rules(self);
        self.place = outer;
    }

    /// Adds a problem unless `holds`: `found` stands at `part` of the current place.
    pub fn rule(&mut self, holds: bool, part: &str, found: impl Display, allowed: impl Display) {
        if !holds {
            self.add(Problem::new(part, found, allowed));
        }
    }

    /// Adds a problem whose place is relative to the current one.
    pub fn add(&mut self, problem: Problem) {
        self.problems.push(problem.within(&self.place));
    }

    /// Checks that `found` lies in `allowed`. A NaN never does.
    pub fn range<T: PartialOrd + Display>(
        &mut self,
        part: &str,
        found: T,
        allowed: RangeInclusive<T>,
    ) {
        let holds = allowed.contains(&found);
        let words = format!("{} to {}", allowed.start(), allowed.end());
        self.rule(holds, part, shortened(&found.to_string()), words);
    }

    /// Checks numbers, each given as its place, its value and its allowed range.
    pub fn ranges<const N: usize>(&mut self, numbers: [(&str, f64, RangeInclusive<f64>); N]) {
        for (part, found, allowed) in numbers {
            self.range(part, found, allowed);
        }
    }

    /// Checks that `name` can name a folder: see [`is_name`].
    pub fn name(&mut self, part: &str, name: &str) {
        self.rule(is_name(name), part, quoted(name), NAMES);
    }

    /// Checks that a reward is finite and so small that sums of rewards keep their precision.
    pub fn reward(&mut self, part: &str, reward: f64) {
        self.range(part, reward, -1000.0..=1000.0);
    }
}

/// The names that [`is_name`] accepts, for messages.
pub const NAMES: &str = "1 to 64 of a-z, 0-9, '-', '_' and '.', not starting with '.' or '-'";

/// Returns whether `name` can name a scenario, a plan or an arm, and so a folder.
#[must_use]
pub fn is_name(name: &str) -> bool {
    let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_.".contains(c);
    (1..=64).contains(&name.len()) && name.chars().all(letter) && !name.starts_with(['.', '-'])
}

/// Returns the dotted path of `part` below `place`.
fn join(place: &str, part: &str) -> String {
    if place.is_empty() || part.is_empty() || part.starts_with('[') {
        format!("{place}{part}")
    } else {
        format!("{place}.{part}")
    }
}
