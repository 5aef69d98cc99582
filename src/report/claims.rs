//! Claims, and how they are judged: always against what comes out by drift.

use std::collections::BTreeMap;

use serde::Serialize;

use super::facts::Facts;
use super::statistics::{Count, fisher};

/// Below this a p-value counts as evidence.
pub const SIGNIFICANCE: f64 = 0.05;

/// Something that the thesis says comes out.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// A short name.
    pub id: &'static str,
    /// Where it is claimed.
    pub source: &'static str,
    /// What is claimed, as it is tested.
    pub statement: &'static str,
    /// What it is about.
    pub scope: Scope,
    /// Whether the runs of one seed show it; none where they cannot tell.
    pub shows: fn(&Evidence<'_>) -> Option<bool>,
}

/// What a claim is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Every scenario of its own.
    Each,
    /// These scenarios, together.
    Named(&'static [&'static str]),
}

/// The runs of one seed and arm.
#[derive(Clone, Debug)]
pub struct Evidence<'e> {
    /// By scenario.
    pub runs: BTreeMap<&'e str, &'e Facts>,
    /// The runs with the hand-designed hierarchy, by scenario.
    pub designed: BTreeMap<&'e str, &'e Facts>,
    /// The scenario that a claim on each is judged for.
    pub here: &'e str,
}

impl Evidence<'_> {
    /// The run of a scenario.
    #[must_use]
    pub fn at(&self, scenario: &str) -> Option<&Facts> {
        self.runs.get(scenario).copied()
    }

    /// The run of the scenario that the claim is judged for.
    #[must_use]
    pub fn run(&self) -> Option<&Facts> {
        self.at(self.here)
    }
}

/// What becomes of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Most runs show it, and more than the control's.
    Holds,
    /// Most runs do not show it, or fewer than the control's do.
    DoesNotHold,
    /// Most runs show it, and so do most of the control's.
    ByDriftAlone,
    /// These runs are too few to tell.
    Undecided,
}

impl Verdict {
    /// For people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::DoesNotHold => "does not hold",
            Self::ByDriftAlone => "comes out by drift alone",
            Self::Undecided => "undecided at this n",
        }
    }
}

/// Judges a claim. *Most* means that the 95 % interval of the share lies above one half;
/// more and fewer are by Fisher's exact test.
#[must_use]
pub fn judge(tested: Count, control: Count) -> Verdict {
    if tested.n == 0 || control.n == 0 {
        return Verdict::Undecided;
    }
    let most = |count: Count| count.interval().low > 0.5;
    let differs = fisher(tested, control) < SIGNIFICANCE;
    let more = tested.share() > control.share();
    if tested.interval().high < 0.5 || (differs && !more) {
        return Verdict::DoesNotHold;
    }
    match (most(tested), differs) {
        (true, true) => Verdict::Holds,
        (true, false) if most(control) => Verdict::ByDriftAlone,
        _ => Verdict::Undecided,
    }
}

/// The claims of Thesis 4.3 and 4.5, as questions that the runs of a seed answer.
pub const CLAIMS: &[Claim] = &[
    Claim {
        id: "few-composites",
        source: "4.3",
        statement: "a simple structure: at most 4 of the 7 composite subtasks, the root counted",
        scope: Scope::Named(&["environment-1"]),
        shows: |e| Some(e.at("environment-1")?.winner.composites.len() <= 4),
    },
    Claim {
        id: "one-primitive",
        source: "4.3",
        statement: "one primitive subtask for each state type",
        scope: Scope::Named(&["environment-1"]),
        shows: |e| Some(e.at("environment-1")?.winner.is_minimal()),
    },
    Claim {
        id: "deliver-above-capture",
        source: "4.3",
        statement: "the deliver side has more composite and selectable primitive subtasks than the \
                    capture side",
        scope: Scope::Named(&["environment-2"]),
        shows: |e| {
            let [capture, deliver] = e.at("environment-2")?.winner.sides()?;
            Some(deliver > capture)
        },
    },
    Claim {
        id: "capture-simple",
        source: "4.5.1",
        statement: "the capture side is simple: one primitive subtask in state types 1 and 2",
        scope: Scope::Named(&["environment-2"]),
        shows: |e| {
            let selectable = &e.at("environment-2")?.winner.selectable;
            Some(selectable.iter().take(2).all(|names| names.len() == 1))
        },
    },
    Claim {
        id: "deliver-complete",
        source: "4.5.1",
        statement: "the deliver side has all 3 composite and at least 4 primitive subtasks",
        scope: Scope::Named(&["environment-2"]),
        shows: |e| e.at("environment-2")?.winner.deliver_is_complete(),
    },
    Claim {
        id: "nearly-all-subtasks",
        source: "4.3",
        statement: "nearly all subtasks: at least 10 of the 12",
        scope: Scope::Named(&["environment-3"]),
        shows: |e| {
            let winner = &e.at("environment-3")?.winner;
            Some(winner.composites.len() + winner.primitives.len() >= 10)
        },
    },
    Claim {
        id: "primitives-grow",
        source: "4.5.1",
        statement: "more selectable primitive subtasks, over all state types, in environment 3 than in \
                    environment 1",
        scope: Scope::Named(&["environment-1", "environment-3"]),
        shows: |e| {
            let of = |name| Some(e.at(name)?.winner.selectable_in_all());
            Some(of("environment-3")? > of("environment-1")?)
        },
    },
    Claim {
        id: "composites-grow",
        source: "4.5.1",
        statement: "more composite subtasks in environment 3 than in environment 1",
        scope: Scope::Named(&["environment-1", "environment-3"]),
        shows: |e| {
            let of = |name| Some(e.at(name)?.winner.composites.len());
            Some(of("environment-3")? > of("environment-1")?)
        },
    },
    Claim {
        id: "good-hierarchy",
        source: "4.3",
        statement: "on fresh trials the winner is no slower than the complete hand-designed hierarchy",
        scope: Scope::Each,
        shows: |e| Some(e.run()?.fresh.steps <= e.designed.get(e.here)?.fresh.steps),
    },
    Claim {
        id: "structures-converge",
        source: "4.5.2",
        statement: "the structural difference to the best falls to less than half in the second half of \
                    the generations, and ends at zero",
        scope: Scope::Each,
        shows: |e| {
            let run = e.run()?;
            let first = run.at(0.0, |m| m.difference)?;
            let late = run.over(0.5, 1.0, |m| m.difference);
            Some(first < 0.0 && late > first / 2.0 && run.at(1.0, |m| m.difference)? == 0.0)
        },
    },
    Claim {
        id: "best-stays",
        source: "4.5.3",
        statement: "the best fitness of the last tenth of the generations is within 20 % of that of the \
                    first tenth",
        scope: Scope::Each,
        shows: |e| {
            let run = e.run()?;
            let [first, last] = [
                run.over(0.0, 0.1, |m| m.best_steps),
                run.over(0.9, 1.0, |m| m.best_steps),
            ];
            Some((last - first).abs() <= 0.2 * first)
        },
    },
    Claim {
        id: "middle-improves",
        source: "4.5.3",
        statement: "the middle of the population by fitness improves by a quarter or more from the first \
                    to the last tenth of the generations",
        scope: Scope::Each,
        shows: |e| {
            let run = e.run()?;
            let of = |m: &super::facts::Moment| m.middle_steps;
            Some(run.over(0.9, 1.0, of) <= 0.75 * run.over(0.0, 0.1, of))
        },
    },
    Claim {
        id: "two-cases",
        source: "4.5.4",
        statement: "no state type has more than two selectable primitive subtasks",
        scope: Scope::Each,
        shows: |e| {
            Some(
                e.run()?
                    .winner
                    .selectable
                    .iter()
                    .all(|names| names.len() <= 2),
            )
        },
    },
    Claim {
        id: "policies-settle",
        source: "4.5.4",
        statement: "selection probabilities change from generation to generation less than half as much in \
                    the last quarter as in the first",
        scope: Scope::Each,
        shows: |e| {
            let run = e.run()?;
            let of = |m: &super::facts::Moment| m.policy_change;
            let moves = run.course.len() >= 8;
            moves.then(|| run.over(0.75, 1.0, of) < 0.5 * run.over(0.0, 0.25, of))
        },
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    fn of(shown: u64) -> Count {
        Count { shown, n: 30 }
    }

    #[test]
    fn a_claim_is_judged_by_its_own_share_and_by_the_controls() {
        assert_eq!(judge(of(28), of(9)), Verdict::Holds);
        assert_eq!(judge(of(28), of(27)), Verdict::ByDriftAlone);
        assert_eq!(judge(of(3), of(2)), Verdict::DoesNotHold);
        // As often as by chance, so often that it is not rare: nothing is known.
        assert_eq!(judge(of(16), of(11)), Verdict::Undecided);
        // Frequent, but by drift it is more frequent still.
        assert_eq!(judge(of(20), of(29)), Verdict::DoesNotHold);
        // Two of two say nothing.
        let few = Count { shown: 2, n: 2 };
        assert_eq!(judge(few, Count { shown: 0, n: 2 }), Verdict::Undecided);
        assert_eq!(judge(of(30), Count { shown: 0, n: 0 }), Verdict::Undecided);
    }
}
