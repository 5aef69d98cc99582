//! `maxq-lab learn`: compares one learner with the exact values of a finite world.

use clap::ValueEnum;
use serde::Serialize;

use super::answer::{AnswerArgs, Resources};
use super::args::ScenarioArgs;
use super::output::{CommandResult, Failure, counted};
use super::progress::repeats;
use crate::lab::{
    Algorithm, AnyExperiment, Course, GivenPolicy, LearnError, LearnProtocol, Learned, Mean,
    ValueGrid, overrides, summarise, with_changes,
};

/// Train one learner in a finite world and compare it with the exact values.
///
/// The learners are TD(0), Q-learning, Q-learning with RBF features (thesis Algorithms 2.1 to
/// 2.3) and MAXQ-Q with a hierarchy. The exact values come from dynamic programming on the model
/// of the world, which no learner sees. A policy counts as optimal if its exact expected return,
/// from a random start and without exploration, is within the tolerance of the optimum.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab learn cliff --algorithm q-learning
  maxq-lab learn cliff --algorithm td0 --policy random --steps 1000000 \\
           --set learning.discount=0.9 --set learning.learning_rate=0.01
  maxq-lab learn taxi-fickle --algorithm maxq-q --repeats 30")]
pub(super) struct Args {
    #[command(flatten)]
    scenario: ScenarioArgs,

    /// Learning algorithm.
    #[arg(long, value_enum)]
    algorithm: AlgorithmName,

    /// Hierarchy for maxq-q, as text [default: the hand-made hierarchy of the world].
    #[arg(long, value_name = "T")]
    tree: Option<String>,

    /// Policy that td0 evaluates [default: optimal].
    #[arg(long, value_enum)]
    policy: Option<PolicyName>,

    /// Number of primitive steps in each repeat.
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    steps: u64,

    /// Number of primitive steps between two comparisons with the exact values; a comparison waits
    /// for the end of the trial.
    #[arg(long, alias = "check-every", value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    evaluate_every: u64,

    /// A policy counts as optimal if its expected return is at most this far below the optimum.
    #[arg(
        long,
        value_name = "RETURN",
        default_value_t = 0.1,
        allow_negative_numbers = true
    )]
    tolerance: f64,

    /// Number of repeats, each with a new learner.
    #[arg(long, value_name = "R", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    repeats: u64,

    /// Print the state values of this variant of the task, such as 'from R to B' [default: the
    /// first variant].
    #[arg(long, value_name = "VARIANT")]
    show: Option<String>,

    #[command(flatten)]
    answer: AnswerArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum AlgorithmName {
    /// TD(0) with a table.
    Td0,
    /// Q-learning with a table.
    QLearning,
    /// Q-learning with normalised Gaussian features.
    QLearningRbf,
    /// MAXQ-Q with a hierarchy.
    MaxqQ,
}

impl AlgorithmName {
    /// The name on the command line.
    fn word(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum PolicyName {
    /// The optimal policy.
    Optimal,
    /// All actions with equal probability.
    Random,
}

/// The result of a learner.
#[derive(Serialize)]
pub(super) struct Report {
    scenario: String,
    algorithm: String,
    /// Settings that differ from the built-in scenario of this name.
    changed: Option<String>,
    seed: u64,
    steps: u64,
    tolerance: f64,
    #[serde(flatten)]
    learned: Learned,
    /// Final values of the first repeat, and the exact values.
    values: Vec<ValueGrid>,
    #[serde(skip)]
    shown: usize,
}

/// Runs `maxq-lab learn`.
pub(super) fn main(args: Args) -> CommandResult {
    let scenario = args.scenario.load()?;
    for (option, is_given, algorithm) in [
        ("--tree", args.tree.is_some(), AlgorithmName::MaxqQ),
        ("--policy", args.policy.is_some(), AlgorithmName::Td0),
    ] {
        if is_given && args.algorithm != algorithm {
            let (found, allowed) = (args.algorithm.word(), algorithm.word());
            return Err(format!("{option}: found with {found}; allowed: with {allowed}").into());
        }
    }
    if !(0.0..=1000.0).contains(&args.tolerance) {
        let found = args.tolerance;
        return Err(format!("--tolerance: found {found}; allowed: 0 to 1000").into());
    }
    args.answer
        .answer(scenario, |resources| args.compute(&resources), describe)
}

impl Args {
    fn compute(&self, resources: &Resources<'_>) -> Result<Report, Failure> {
        let Resources {
            experiment,
            workers,
            gate,
        } = *resources;
        let name = &experiment.scenario().name;
        let in_world = |error: LearnError| format!("{name}: {error}");
        if !experiment.is_finite() {
            // Checked first: a missing hierarchy is not the reason.
            return Err(in_world(LearnError::NotFinite).into());
        }
        let algorithm = algorithm(self, experiment)?;
        let protocol = LearnProtocol {
            steps: self.steps,
            every: self.evaluate_every,
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
            changed: summarise(&overrides(experiment.scenario())),
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
         expected return, optimal policy        {:.4}\n",
        with_changes(&report.scenario, report.changed.as_deref()),
        report.algorithm,
        report.seed,
        counted(learned.repeats.len() as u64, "repeat"),
        counted(report.steps, "primitive step"),
        counted(trials, "trial"),
        learned.optimal_return
    );
    let mut line = |label: &str, value: String| text += &format!("{label:39}{value}\n");
    // A given policy does not become optimal.
    if !learned.policy_is_given {
        let ends = |course: &Course| {
            let last = course.checks.last();
            last.is_some_and(|check| check.greedy_return.is_some())
        };
        let last = learned.final_greedy_return.map_or_else(
            || format!("ends its trials {}", only(learned, ends)),
            |mean| interval(mean, 4),
        );
        let first = |course: &Course| course.steps_until_optimal;
        let first = reached(learned, learned.steps_until_optimal, first);
        let always = |course: &Course| course.steps_until_always_optimal;
        let always = reached(learned, learned.steps_until_always_optimal, always);
        line("expected return, final greedy policy", last);
        line("primitive steps until first optimal", first);
        line("primitive steps until always optimal", always);
    }
    let course = learned.repeats.first();
    if let Some(check) = course.and_then(|course| course.checks.last()) {
        let error = format!("{:.4}", check.largest_error);
        line("largest error of a value in repeat 1", error);
    }
    if let Some(grid) = report.values.get(report.shown) {
        let (case, learned, exact) = (&grid.case, table(&grid.learned), table(&grid.exact));
        text += &format!("\nState values {case}, learned in repeat 1:\n{learned}\nExact:\n{exact}");
    }
    text
}

fn algorithm(args: &Args, experiment: &dyn AnyExperiment) -> Result<Algorithm, Failure> {
    Ok(match args.algorithm {
        AlgorithmName::Td0 => Algorithm::Td0(match args.policy {
            Some(PolicyName::Random) => GivenPolicy::Random,
            Some(PolicyName::Optimal) | None => GivenPolicy::Optimal,
        }),
        AlgorithmName::QLearning => Algorithm::QLearning,
        AlgorithmName::QLearningRbf => Algorithm::QLearningRbf,
        AlgorithmName::MaxqQ => {
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

/// Says in how few of the repeats `holds` is true.
fn only(learned: &Learned, holds: impl Fn(&Course) -> bool) -> String {
    let count = learned
        .repeats
        .iter()
        .filter(|course| holds(course))
        .count();
    let all = counted(learned.repeats.len() as u64, "repeat");
    format!("in only {count} of {all}")
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
