//! The claims of the thesis, and how the runs of a study decide on them.

use std::collections::BTreeMap;

use serde::Serialize;

use super::facts::{Facts, GenerationFacts};
use super::statistics::{Count, fisher};

/// Significance level: a smaller p-value counts as evidence.
pub const SIGNIFICANCE: f64 = 0.05;

/// A claim of the thesis.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// Its short name.
    pub id: &'static str,
    /// Section of the thesis that makes it.
    pub source: &'static str,
    /// The claim, in the form in which it is tested.
    pub statement: &'static str,
    /// The scenarios that it is about.
    pub scope: Scope,
    /// Returns whether the runs of one seed agree with it; `None` if they cannot decide.
    pub shows: fn(&Evidence<'_>) -> Option<bool>,
}

/// The scenarios that a claim is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Each scenario of the study, judged separately.
    Each,
    /// These scenarios, judged together.
    Named(&'static [&'static str]),
}

/// The runs of one seed and arm.
#[derive(Clone, Debug)]
pub struct Evidence<'e> {
    /// The runs, by scenario.
    pub runs: BTreeMap<&'e str, &'e Facts>,
    /// The runs of the same seed with the hand-designed hierarchy, by scenario.
    pub designed: BTreeMap<&'e str, &'e Facts>,
    /// The scenario for which a claim about each scenario is judged.
    pub here: &'e str,
}

impl Evidence<'_> {
    /// Returns the run of a scenario.
    #[must_use]
    pub fn at(&self, scenario: &str) -> Option<&Facts> {
        self.runs.get(scenario).copied()
    }

    /// Returns the run of the scenario for which the claim is judged.
    #[must_use]
    pub fn run(&self) -> Option<&Facts> {
        self.at(self.here)
    }
}

/// The decision on a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Most seeds show it, and more than under the control.
    Holds,
    /// Most seeds do not show it, or fewer than under the control.
    DoesNotHold,
    /// Most seeds show it, but so do most under the control.
    ByDriftAlone,
    /// There are too few seeds to decide.
    Undecided,
}

impl Verdict {
    /// Returns the verdict in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::DoesNotHold => "does not hold",
            Self::ByDriftAlone => "explained by drift alone",
            Self::Undecided => "undecided at this n",
        }
    }
}

/// Judges a claim by the seeds that show it in the tested arm and in the control arm.
///
/// *Most* seeds show it if the exact 95 % interval of their proportion lies above one half.
/// *More* or *fewer* seeds than under the control show it if the proportions differ by Fisher's
/// exact test at the level `SIGNIFICANCE`.
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

/// The claims of Thesis 4.3 and 4.5, as questions that the runs of one seed answer.
pub const CLAIMS: &[Claim] = &[
    Claim {
        id: "few-composites",
        source: "4.3",
        statement: "the winner is simple: it has at most 4 of the 7 composite subtasks, including the root",
        scope: Scope::Named(&["environment-1"]),
        shows: |e| Some(e.at("environment-1")?.winner.composites.len() <= 4),
    },
    Claim {
        id: "one-primitive",
        source: "4.3",
        statement: "the winner has one selectable primitive subtask in every state type",
        scope: Scope::Named(&["environment-1"]),
        shows: |e| Some(e.at("environment-1")?.winner.is_minimal()),
    },
    Claim {
        id: "deliver-above-capture",
        source: "4.3",
        statement: "the winner's deliver side has more composite and selectable primitive subtasks \
                    than its capture side",
        scope: Scope::Named(&["environment-2"]),
        shows: |e| {
            let [capture, deliver] = e.at("environment-2")?.winner.sides()?;
            Some(deliver > capture)
        },
    },
    Claim {
        id: "capture-simple",
        source: "4.5.1",
        statement: "the winner's capture side is simple: it has one selectable primitive subtask in state \
                    types 1 and 2",
        scope: Scope::Named(&["environment-2"]),
        shows: |e| {
            let selectable = &e.at("environment-2")?.winner.selectable;
            Some(selectable.iter().take(2).all(|names| names.len() == 1))
        },
    },
    Claim {
        id: "deliver-complete",
        source: "4.5.1",
        statement: "the winner's deliver side has all 3 composite and at least 4 primitive subtasks",
        scope: Scope::Named(&["environment-2"]),
        shows: |e| e.at("environment-2")?.winner.deliver_is_complete(),
    },
    Claim {
        id: "nearly-all-subtasks",
        source: "4.3",
        statement: "the winner has nearly all subtasks: at least 10 of the 12",
        scope: Scope::Named(&["environment-3"]),
        shows: |e| {
            let winner = &e.at("environment-3")?.winner;
            Some(winner.composites.len() + winner.primitives.len() >= 10)
        },
    },
    Claim {
        id: "primitives-grow",
        source: "4.5.1",
        statement: "the winner has more selectable primitive subtasks, summed over state types, in \
                    environment 3 than in environment 1",
        scope: Scope::Named(&["environment-1", "environment-3"]),
        shows: |e| {
            let of = |name| Some(e.at(name)?.winner.selectable_in_all());
            Some(of("environment-3")? > of("environment-1")?)
        },
    },
    Claim {
        id: "composites-grow",
        source: "4.5.1",
        statement: "the winner has more composite subtasks in environment 3 than in environment 1",
        scope: Scope::Named(&["environment-1", "environment-3"]),
        shows: |e| {
            let of = |name| Some(e.at(name)?.winner.composites.len());
            Some(of("environment-3")? > of("environment-1")?)
        },
    },
    Claim {
        id: "good-hierarchy",
        source: "4.3",
        statement: "on fresh trials, the winner is at least as fast as the complete hand-designed hierarchy",
        scope: Scope::Each,
        shows: |e| Some(e.run()?.fresh.steps <= e.designed.get(e.here)?.fresh.steps),
    },
    Claim {
        id: "structures-converge",
        source: "4.5.2",
        statement: "the mean structural difference to the best hierarchy is, over the second half of the \
                    generations, less than half of its initial size, and it ends at zero",
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
        statement: "the best fitness of the last tenth of the generations is within 20 % of the best \
                    fitness of the first tenth",
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
        statement: "the middle individual by fitness improves by at least 25 % from the first to the \
                    last tenth of the generations",
        scope: Scope::Each,
        shows: |e| {
            let run = e.run()?;
            let of = |m: &GenerationFacts| m.middle_steps;
            Some(run.over(0.9, 1.0, of) <= 0.75 * run.over(0.0, 0.1, of))
        },
    },
    Claim {
        id: "two-cases",
        source: "4.5.4",
        statement: "the winner has at most two selectable primitive subtasks in every state type",
        scope: Scope::Each,
        shows: |e| {
            let selectable = &e.run()?.winner.selectable;
            Some(selectable.iter().all(|names| names.len() <= 2))
        },
    },
    Claim {
        id: "policies-settle",
        source: "4.5.4",
        statement: "in the last quarter of the generations, selection probabilities change less than half \
                    as much from generation to generation as in the first quarter",
        scope: Scope::Each,
        shows: |e| {
            let run = e.run()?;
            let of = |m: &GenerationFacts| m.policy_change;
            let moves = run.course.len() >= 8;
            moves.then(|| run.over(0.75, 1.0, of) < 0.5 * run.over(0.0, 0.25, of))
        },
    },
    Claim {
        id: "policies-improve-later",
        source: "TEC 2007",
        statement: "when the best hierarchy goes on learning after evolution, its trials of the last \
                    tenth are shorter than those of the first tenth",
        scope: Scope::Each,
        shows: |e| {
            let later = e.run()?.later?;
            Some(later.last < later.first)
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
    fn a_claim_is_judged_by_its_proportion_and_by_the_control() {
        assert_eq!(judge(of(28), of(9)), Verdict::Holds);
        assert_eq!(judge(of(28), of(27)), Verdict::ByDriftAlone);
        assert_eq!(judge(of(3), of(2)), Verdict::DoesNotHold);
        // About half of the seeds, and no clear difference to the control.
        assert_eq!(judge(of(16), of(11)), Verdict::Undecided);
        // Frequent, but significantly more frequent by drift.
        assert_eq!(judge(of(20), of(29)), Verdict::DoesNotHold);
        // Two seeds are too few.
        let few = Count { shown: 2, n: 2 };
        assert_eq!(judge(few, Count { shown: 0, n: 2 }), Verdict::Undecided);
        assert_eq!(judge(of(30), Count { shown: 0, n: 0 }), Verdict::Undecided);
    }
}
