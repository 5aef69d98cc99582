//! How the winners of each scenario of a study do in the others.

use serde::Serialize;

use super::numbers::Numbers;
use super::results::{PlannedRun, StudyRunError};
use super::study::{RunId, Study};
use super::table::{Table, short};
use crate::evolution::Workers;
use crate::files::FileError;
use crate::lab::{Mean, Outcome, Protocol, SUMMARY, experiment, mean};
use crate::learning::{Gate, Stopped};
use crate::scenario::Scenario;

/// The structures of the winners of one scenario, learned from nothing in another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Transfer {
    /// The scenario in which they evolved.
    pub from: String,
    /// The scenario in which they are evaluated.
    pub to: String,
    /// Mean time steps of a scored trial, by winner.
    pub steps: Vec<f64>,
    /// Mean over the winners with its 95 % interval; `None` without winners.
    pub mean: Option<Mean>,
}

/// The numbers of a transfer.
#[derive(Clone, Debug)]
pub struct TransferPlan {
    /// Index of the arm whose winners are evaluated, with its settings.
    pub arm: usize,
    /// The seeds of the runs; `None` for all that are done.
    pub seeds: Option<Numbers>,
    /// Unscored trials of each evaluation.
    pub warmup: usize,
    /// Scored trials of each evaluation.
    pub trials: usize,
}

/// A winner, and the scenario in which it evolved.
struct Evolved {
    run: RunId,
    tree: String,
}

/// Evaluates the winners of an arm in every scenario of a study. Each evaluation has one new
/// hierarchy, its own trials and a newly trained set of primitive subtasks; those of one seed are
/// the same for all structures. Calls `progress` with the number of evaluations done and of all.
///
/// # Errors
/// When a run cannot be read, a structure does not exist in a scenario, or the gate is stopped.
pub fn transfer(
    study: &Study,
    plan: &TransferPlan,
    workers: &Workers,
    gate: &Gate,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<Transfer>, StudyRunError> {
    let winners = winners(study, plan)?;
    let scenarios = study.plan.scenarios.len();
    let all = winners.len() * scenarios;
    let mut transfers = Vec::new();
    for from in 0..scenarios {
        let own = winners.iter().filter(|winner| winner.run.scenario == from);
        let own: Vec<_> = own.collect();
        for to in 0..scenarios {
            let arm = &study.plan.arms[plan.arm];
            let scenario = arm.apply(&study.plan.scenarios[to])?;
            let done = transfers
                .iter()
                .map(|t: &Transfer| t.steps.len())
                .sum::<usize>();
            let steps = workers.map((0..own.len()).collect(), |winner| {
                evaluate(study, plan, &scenario, own[winner], gate)
            })?;
            progress(done + steps.len(), all);
            transfers.push(Transfer {
                from: study.plan.scenarios[from].name.clone(),
                to: scenario.name,
                mean: mean(&steps),
                steps,
            });
        }
    }
    Ok(transfers)
}

/// Returns the winners of the runs that are done.
fn winners(study: &Study, plan: &TransferPlan) -> Result<Vec<Evolved>, StudyRunError> {
    let seeds = plan.seeds.as_ref();
    let wanted = |run: &RunId| {
        run.arm == plan.arm && seeds.is_none_or(|seeds| seeds.iter().any(|seed| seed == run.seed))
    };
    let mut winners = Vec::new();
    for run in study.runs().into_iter().filter(wanted) {
        let outcome = PlannedRun::of(study, &run)?.outcome()?;
        let best = outcome.and_then(|outcome: Outcome| outcome.best);
        winners.extend(best.map(|best| Evolved {
            run,
            tree: best.tree,
        }));
    }
    Ok(winners)
}

fn evaluate(
    study: &Study,
    plan: &TransferPlan,
    scenario: &Scenario,
    winner: &Evolved,
    gate: &Gate,
) -> Result<f64, StudyRunError> {
    let seed = super::results::evaluation_seed(&winner.run);
    let experiment = experiment(scenario.clone(), seed)?;
    let tree = experiment.read_tree(&winner.tree).map_err(|error| {
        let file = study.run_folder(&winner.run).join(SUMMARY);
        FileError::new(file, format!("best.tree in {}: {error}", scenario.name))
    })?;
    let protocol = Protocol {
        warmup: plan.warmup,
        trials: plan.trials,
        repeats: 1,
        primitive_sets: 1,
    };
    let workers = Workers::new(1).map_err(|error| StudyRunError::Threads(error.to_string()))?;
    let scored = experiment.evaluate(&tree, &protocol, &workers, gate, &|_| {});
    Ok(scored.map_err(|Stopped| Stopped)?.evaluation.mean)
}

/// Returns transfers as a table: a row for the winners of each scenario, a column for each
/// scenario that they are evaluated in. The least of a column is marked.
#[must_use]
pub fn transfer_table(transfers: &[Transfer]) -> Table {
    let mut scenarios: Vec<&str> = Vec::new();
    for transfer in transfers {
        if !scenarios.contains(&transfer.from.as_str()) {
            scenarios.push(&transfer.from);
        }
    }
    let header: Vec<&str> = std::iter::once("winners of")
        .chain(scenarios.iter().copied())
        .collect();
    let mut table = Table::new(&header);
    let at = |from: &str, to: &str| {
        let found = transfers.iter().find(|t| t.from == from && t.to == to);
        found.and_then(|transfer| transfer.mean)
    };
    for from in &scenarios {
        let cells = scenarios.iter().map(|to| {
            let Some(mean) = at(from, to) else {
                return String::from("-");
            };
            let others = scenarios.iter().filter_map(|other| at(other, to));
            let least = others.map(|other| other.mean).fold(f64::INFINITY, f64::min);
            let interval = mean
                .half_width
                .map_or_else(String::new, |half| format!(" +- {}", short(half)));
            let mark = if mean.mean <= least { "**" } else { "" };
            format!("{mark}{}{interval}{mark}", short(mean.mean))
        });
        table
            .rows
            .push(std::iter::once((*from).to_owned()).chain(cells).collect());
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_of_each_column_is_marked() {
        let of = |from: &str, to: &str, steps: &[f64]| Transfer {
            from: from.to_owned(),
            to: to.to_owned(),
            steps: steps.to_vec(),
            mean: mean(steps),
        };
        let table = transfer_table(&[
            of("a", "a", &[50.0]),
            of("a", "b", &[900.0]),
            of("b", "a", &[60.0]),
            of("b", "b", &[]),
        ]);
        assert_eq!(table.header, ["winners of", "a", "b"]);
        assert_eq!(table.rows[0], ["a", "**50.0**", "**900**"]);
        assert_eq!(table.rows[1], ["b", "60.0", "-"]);
    }
}
