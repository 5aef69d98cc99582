//! `maxq-lab learn`: one learner in a finite world, held against the exact values.

use std::fmt::Write;

use clap::ValueEnum;
use serde::Serialize;

use super::answer::{AnswerArgs, Means};
use super::args::ScenarioArgs;
use super::output::{CommandResult, Failure, counted};
use super::progress::repeats;
use crate::lab::{
    Algorithm, AnyExperiment, Course, GivenPolicy, LearnError, LearnProtocol, Learned, Mean,
    ValueGrid, departures, in_words, with_changes,
};

/// Let one learner learn a finite world, and compare it with the exact values.
///
/// Learners are TD(0), Q-learning, Q-learning with RBF features (thesis Algorithms 2.1 to
/// 2.3) and MAXQ-Q on a hierarchy. Exact values come from dynamic programming on the
/// world's model, which no learner sees. A policy counts as optimal when its exact expected
/// return, from a random start and without exploration, is within the tolerance of the best.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab learn cliff --algorithm q-learning
  maxq-lab learn cliff --algorithm td0 --policy random --steps 1000000 \\
           --set learning.learning_rate=0.01
  maxq-lab learn taxi-fickle --algorithm maxq-q --repeats 30")]
pub(super) struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,

    /// How to learn.
    #[arg(long, value_enum)]
    algorithm: Name,

    /// The hierarchy for maxq-q, as text [default: the world's hand-made one].
    #[arg(long, value_name = "T")]
    tree: Option<String>,

    /// The policy whose values td0 learns [default: optimal].
    #[arg(long, value_enum)]
    policy: Option<PolicyName>,

    /// Primitive steps of each repeat.
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    steps: u64,

    /// Primitive steps between two checks; they end with a trial.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    check_every: u64,

    /// A policy is optimal if its expected return is no further below the best than this.
    #[arg(
        long,
        value_name = "RETURN",
        default_value_t = 0.1,
        allow_negative_numbers = true
    )]
    tolerance: f64,

    /// Learners that begin from nothing.
    #[arg(long, value_name = "R", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    repeats: u64,

    /// What is the case in the states whose values are printed, such as 'from R to B';
    /// by default the first there is.
    #[arg(long, value_name = "CASE")]
    show: Option<String>,

    #[command(flatten)]
    answer: AnswerArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Name {
    /// TD(0) on a table.
    Td0,
    /// Q-learning on a table.
    QLearning,
    /// Q-learning with normalised Gaussian features.
    QLearningRbf,
    /// MAXQ-Q on a hierarchy.
    MaxqQ,
}

impl Name {
    /// As it is given.
    fn word(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum PolicyName {
    /// The optimal policy.
    Optimal,
    /// All actions alike.
    Random,
}

/// What was learned, and how.
#[derive(Serialize)]
pub(super) struct Report {
    scenario: String,
    algorithm: String,
    /// Settings in which the scenario departs from the embedded one of its name.
    changed: Option<String>,
    seed: u64,
    steps: u64,
    tolerance: f64,
    #[serde(flatten)]
    learned: Learned,
    /// Values of the first repeat at its end, and the exact ones.
    values: Vec<ValueGrid>,
    #[serde(skip)]
    shown: usize,
}

/// Carries out the command.
pub(super) fn main(args: Args) -> CommandResult {
    let scenario = args.scenario.load()?;
    for (option, is_there, algorithm) in [
        ("--tree", args.tree.is_some(), Name::MaxqQ),
        ("--policy", args.policy.is_some(), Name::Td0),
    ] {
        if is_there && args.algorithm != algorithm {
            let (found, allowed) = (args.algorithm.word(), algorithm.word());
            return Err(format!("{option}: found with {found}; allowed: with {allowed}").into());
        }
    }
    if !(0.0..=1000.0).contains(&args.tolerance) {
        let found = args.tolerance;
        return Err(format!("--tolerance: found {found}; allowed: 0 to 1000").into());
    }
    args.answer
        .answer(scenario, |means| args.compute(&means), describe)
}

impl Args {
    fn compute(&self, means: &Means<'_>) -> Result<Report, Failure> {
        let Means {
            experiment,
            workers,
            gate,
        } = *means;
        let name = &experiment.scenario().name;
        let in_world = |error: LearnError| format!("{name}: {error}");
        if !experiment.is_finite() {
            // Before a hierarchy is asked for that would not help.
            return Err(in_world(LearnError::NotFinite).into());
        }
        let algorithm = algorithm(self, experiment)?;
        let protocol = LearnProtocol {
            steps: self.steps,
            every: self.check_every,
            tolerance: self.tolerance,
            repeats: usize::try_from(self.repeats).unwrap_or(usize::MAX),
        };
        let shown = shown(self.show.as_deref(), experiment.variants())?;
        let bar = repeats(self.repeats);
        let show = |done| bar.set_position(done as u64);
        let learned = experiment
            .learn(&algorithm, &protocol, workers, gate, &show)
            .map_err(in_world)?;
        bar.finish_and_clear();
        Ok(Report {
            scenario: name.clone(),
            algorithm: self.algorithm.word(),
            changed: in_words(&departures(experiment.scenario())),
            seed: self.answer.seed,
            steps: self.steps,
            tolerance: self.tolerance,
            values: experiment.value_grids(&learned),
            learned,
            shown,
        })
    }
}

fn describe(report: &Report) -> String {
    let learned = &report.learned;
    let trials: u64 = learned.repeats.iter().map(|course| course.trials).sum();
    let mut text = format!(
        "{}, {}, seed {}: {} of {}, {}\n\
         expected return of the optimal policy   {:.4}\n",
        with_changes(&report.scenario, report.changed.as_deref()),
        report.algorithm,
        report.seed,
        counted(learned.repeats.len() as u64, "repeat"),
        counted(report.steps, "primitive step"),
        counted(trials, "trial"),
        learned.optimal_return
    );
    // Where the policy is given there is none that becomes optimal. Writing to a string
    // cannot fail.
    if !learned.policy_is_given {
        let ends = |course: &Course| {
            let last = course.checks.last();
            last.is_some_and(|check| check.greedy_return.is_some())
        };
        let at_the_end = learned.final_greedy_return.map_or_else(
            || format!("comes to an end {}", only(learned, ends)),
            |mean| interval(mean, 4),
        );
        let _ = write!(
            text,
            "of the greedy policy at the end         {}\n\
             primitive steps until it is optimal     {}\n\
             until it is and stays so                {}\n",
            at_the_end,
            reached(learned, learned.steps_until_optimal, |course| course
                .steps_until_optimal),
            reached(learned, learned.steps_until_always_optimal, |course| {
                course.steps_until_always_optimal
            }),
        );
    }
    let last = learned
        .repeats
        .first()
        .and_then(|course| course.checks.last());
    if let Some(check) = last {
        let _ = writeln!(
            text,
            "largest error of a value, repeat 1      {:.4}",
            check.largest_error
        );
    }
    if let Some(grid) = report.values.get(report.shown) {
        let _ = write!(text, "\nV {}, learned by repeat 1:\n", grid.case);
        text.push_str(&table(&grid.learned));
        let _ = write!(text, "\nexact:\n");
        text.push_str(&table(&grid.exact));
    }
    text
}

fn algorithm(args: &Args, experiment: &dyn AnyExperiment) -> Result<Algorithm, Failure> {
    Ok(match args.algorithm {
        Name::Td0 => Algorithm::Td0(match args.policy {
            Some(PolicyName::Random) => GivenPolicy::Random,
            Some(PolicyName::Optimal) | None => GivenPolicy::Optimal,
        }),
        Name::QLearning => Algorithm::QLearning,
        Name::QLearningRbf => Algorithm::QLearningRbf,
        Name::MaxqQ => {
            let text = args.tree.as_deref().or(experiment.hand_made());
            let text = text.ok_or("--tree: found none; allowed: a hierarchy")?;
            let tree = experiment.read_tree(text);
            Algorithm::MaxqQ(tree.map_err(|error| format!("--tree: {error}"))?)
        }
    })
}

fn shown(wanted: Option<&str>, variants: &[String]) -> Result<usize, Failure> {
    let Some(wanted) = wanted else { return Ok(0) };
    let place = variants.iter().position(|variant| variant == wanted);
    let allowed = || format!("--show: found {wanted:?}; allowed: {}", variants.join(", "));
    Ok(place.ok_or_else(allowed)?)
}

fn interval(mean: Mean, digits: usize) -> String {
    match mean.half_width {
        Some(half) => format!("{:.digits$} +- {half:.digits$} (95 %)", mean.mean),
        None => format!("{:.digits$}", mean.mean),
    }
}

fn reached(learned: &Learned, mean: Option<Mean>, of: fn(&Course) -> Option<u64>) -> String {
    mean.map_or_else(
        || only(learned, |course| of(course).is_some()),
        |mean| interval(mean, 0),
    )
}

/// In how many repeats something is the case that is not in all.
fn only(learned: &Learned, case: impl Fn(&Course) -> bool) -> String {
    let count = learned.repeats.iter().filter(|course| case(course)).count();
    let all = counted(learned.repeats.len() as u64, "repeat");
    format!("in {count} of {all} only")
}

fn table(rows: &[Vec<Option<f64>>]) -> String {
    let cell = |value: &Option<f64>| value.map_or_else(String::new, |value| format!("{value:.2}"));
    let line = |row: &Vec<Option<f64>>| {
        let cells: String = row
            .iter()
            .map(|value| format!("{:>8}", cell(value)))
            .collect();
        format!("{}\n", cells.trim_end())
    };
    rows.iter().map(line).collect()
}
