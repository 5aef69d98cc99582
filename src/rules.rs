//! Rules that settings obey: what is broken, where, what was found there and what is
//! allowed.

use std::fmt::{self, Display};
use std::ops::RangeInclusive;

/// A rule that settings break.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Where, as a dotted path: `world.foraging.arena.walls_mm[3]`.
    pub place: String,
    /// The value found there.
    pub found: String,
    /// The values allowed there.
    pub allowed: String,
}

impl Problem {
    /// The problem of `found` at `place`, where `allowed` is allowed.
    pub fn new(place: impl Into<String>, found: impl Display, allowed: impl Display) -> Self {
        Self {
            place: place.into(),
            found: found.to_string(),
            allowed: allowed.to_string(),
        }
    }

    /// This problem, its place below `outer`.
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

/// Collects problems; knows the place it is at.
#[derive(Debug, Default)]
pub struct Check {
    place: String,
    problems: Vec<Problem>,
}

impl Check {
    /// The problems found.
    #[must_use]
    pub fn problems(self) -> Vec<Problem> {
        self.problems
    }

    /// Checks `rules` at `part` of the present place.
    pub fn within(&mut self, part: &str, rules: impl FnOnce(&mut Self)) {
        let inner = join(&self.place, part);
        let outer = std::mem::replace(&mut self.place, inner);
        rules(self);
        self.place = outer;
    }

    /// At `part` of the present place stands `found`, and `holds` says whether it may.
    pub fn rule(&mut self, holds: bool, part: &str, found: impl Display, allowed: impl Display) {
        if !holds {
            self.add(Problem::new(part, found, allowed));
        }
    }

    /// Adds a problem, whose place is below the present one.
    pub fn add(&mut self, problem: Problem) {
        self.problems.push(problem.within(&self.place));
    }

    /// `found` lies in `allowed`; a NaN lies nowhere.
    pub fn range<T: PartialOrd + Display>(
        &mut self,
        part: &str,
        found: T,
        allowed: RangeInclusive<T>,
    ) {
        let holds = allowed.contains(&found);
        let words = format!("{} to {}", allowed.start(), allowed.end());
        self.rule(holds, part, found, words);
    }

    /// A reward is finite, and small enough for sums of it to stay exact enough.
    pub fn reward(&mut self, part: &str, reward: f64) {
        self.range(part, reward, -1000.0..=1000.0);
    }
}

/// The dotted path of `part` below `place`.
fn join(place: &str, part: &str) -> String {
    if place.is_empty() || part.is_empty() || part.starts_with('[') {
        format!("{place}{part}")
    } else {
        format!("{place}.{part}")
    }
}
