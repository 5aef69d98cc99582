//! What comes out: the tables of the README.
//!
//! `cargo bench --bench outcomes -- structures` learns with seven fixed hierarchies in
//! every environment; `-- evolution` evolves 20 seeds in every environment, and 20 seeds
//! with chance in the place of fitness, the control that tells selection from drift.
//! Beside each figure stands, in brackets, what a separate implementation of the same
//! method got.

use std::collections::BTreeMap;

use maxq_lab::evolution::{Evolution, Experiment, GenerationRecord, RankedRecord, Workers};
use maxq_lab::hierarchy::{Tree, canonical, parse};
use maxq_lab::lab::{Protocol, WorldTask, evaluate, with_world};
use maxq_lab::learning::Gate;
use maxq_lab::scenario::{Scenario, Selection};
use maxq_lab::worlds::{Catalogue, SubtaskId, World};

type Error = Box<dyn std::error::Error + Send + Sync>;

const ENVIRONMENTS: [&str; 3] = ["environment-1", "environment-2", "environment-3"];
const SEEDS: usize = 20;

fn main() -> Result<(), Error> {
    let wanted = |part: &str| {
        let named: Vec<_> = std::env::args()
            .skip(1)
            .filter(|a| !a.starts_with('-'))
            .collect();
        named.is_empty() || named.iter().any(|name| name == part)
    };
    if wanted("structures") {
        structures()?;
    }
    if wanted("evolution") {
        evolution()?;
    }
    Ok(())
}

/// A hierarchy, and mean and standard error of a trial's length in each environment
/// with the percentage of trials that failed, as the separate implementation got them.
type Structure = (&'static str, [(f64, f64, f64); 3]);

const STRUCTURES: [Structure; 7] = [
    (
        "(Root (FindBattery Wander) ApproachBattery (FindNest Wander) ApproachNest)",
        [
            (364.0, 14.0, 0.2),
            (1215.0, 33.0, 52.3),
            (1442.0, 34.0, 68.0),
        ],
    ),
    (
        "(Root (FindBattery Avoid) ApproachBattery (FindNest Avoid) ApproachNest)",
        [
            (178.0, 5.0, 0.0),
            (1528.0, 34.0, 68.4),
            (1255.0, 36.0, 55.3),
        ],
    ),
    (
        "(Root Wander ApproachBattery ApproachNest)",
        [(410.0, 18.0, 1.2), (571.0, 23.0, 2.5), (652.0, 26.0, 7.2)],
    ),
    (
        "(Root Avoid Wander ApproachBattery ApproachNest)",
        [(291.0, 10.0, 0.0), (629.0, 15.0, 2.1), (490.0, 17.0, 1.4)],
    ),
    (
        "(Root (FindBattery Wander) ApproachBattery (FindNest Wander) \
         (VisibleNest Avoid Wander ApproachNest))",
        [(415.0, 19.0, 0.8), (554.0, 21.0, 2.1), (1115.0, 33.0, 43.2)],
    ),
    (
        "(Root (FindBattery Wander) (VisibleBattery Avoid Wander ApproachBattery) \
         (FindNest Wander) (VisibleNest Avoid Wander ApproachNest))",
        [(480.0, 24.0, 1.2), (533.0, 18.0, 1.8), (571.0, 20.0, 2.1)],
    ),
    (
        "(Root (Capture (FindBattery Avoid Wander) (VisibleBattery Avoid Wander ApproachBattery \
         Turn)) (Deliver (FindNest Avoid Wander) (VisibleNest Avoid Wander ApproachNest Turn)))",
        [(278.0, 9.0, 0.0), (773.0, 22.0, 6.6), (733.0, 24.0, 8.2)],
    ),
];

fn structures() -> Result<(), Error> {
    println!(
        "mean trial length +- standard error (share that failed); 64 repeats, 16 trainings of the primitives"
    );
    for (tree, expected) in STRUCTURES {
        println!("{tree}");
        for (name, (mean, error, failed)) in ENVIRONMENTS.iter().zip(expected) {
            let found = with_world(Scenario::load(name)?, Evaluate(tree))??;
            let [found_mean, found_error, found_failed] = found;
            let distance = (found_mean - mean) / found_error.hypot(error);
            println!(
                "  {name}  {found_mean:5.0} +- {found_error:3.0} ({found_failed:4.1} %)  \
                 [{mean:.0} +- {error:.0}, {failed:.1} %]  {distance:+.1} standard errors"
            );
        }
    }
    Ok(())
}

struct Evaluate(&'static str);

impl WorldTask for Evaluate {
    type Output = Result<[f64; 3], Error>;

    fn carry_out<W: World + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        let protocol = Protocol {
            warmup: 8,
            trials: 8,
            repeats: 64,
            banks: 16,
            seed: 1,
        };
        let tree = parse(self.0, experiment.catalogue())?;
        let (workers, gate) = (Workers::new(0)?, Gate::default());
        let evaluation = evaluate(&experiment, &tree, &protocol, &workers, &gate, |_| {})?;
        let error = evaluation.standard_error.unwrap_or(f64::NAN);
        Ok([
            evaluation.mean,
            error,
            100.0 * (1.0 - evaluation.delivered_share),
        ])
    }
}

/// What is compared of one evolution.
struct Outcome {
    first: GenerationRecord,
    last: GenerationRecord,
    /// Structural difference at 0, 10, 25, 50, 75 and 100 % of the generations.
    differences: [f64; 6],
    structure: String,
    /// Composites and selectable primitives on the capture and on the deliver side.
    sides: [usize; 2],
}

fn evolution() -> Result<(), Error> {
    let workers = Workers::new(0)?;
    let mut structures = Vec::new();
    for (label, selection) in [
        ("fitness", Selection::Fitness),
        ("random", Selection::Random),
    ] {
        for name in ENVIRONMENTS {
            let mut scenario = Scenario::load(name)?;
            scenario.evolution.selection = selection;
            let outcomes = workers.map((0..SEEDS).collect(), |index| {
                with_world(scenario.clone(), Evolve(index as u64 + 1))?
            })?;
            println!("{name}, selection: {label}, {SEEDS} seeds");
            report(&outcomes);
            structures.push((name, label, most_frequent(&outcomes)));
        }
    }
    println!("most frequent final structures, children sorted, repeated primitives left out");
    for (name, label, frequent) in structures {
        println!("{name}, selection: {label}");
        for (structure, count) in frequent {
            println!("  {count:2} x {structure}");
        }
    }
    Ok(())
}

struct Evolve(u64);

impl WorldTask for Evolve {
    type Output = Result<Outcome, Error>;

    fn carry_out<W: World + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        let (workers, gate) = (Workers::new(1)?, Gate::default());
        let mut evolution = Evolution::begin(&experiment, &workers, self.0, &gate)?;
        let first = evolution.step(&gate, |_| {})?;
        let mut last = first.clone();
        let mut differences = vec![first.mean_difference];
        while !evolution.is_over() {
            last = evolution.step(&gate, |_| {})?;
            differences.push(last.mean_difference);
        }
        let catalogue = experiment.catalogue();
        let best = evolution.state().individuals[0].hierarchy.tree();
        let at =
            |share: f64| differences[((differences.len() - 1) as f64 * share).round() as usize];
        Ok(Outcome {
            differences: [0.0, 0.1, 0.25, 0.5, 0.75, 1.0].map(at),
            structure: canonical(&without_repeats(best, catalogue), catalogue),
            sides: sides(best, &last.individuals[0], catalogue),
            first,
            last,
        })
    }
}

fn sides(tree: &Tree, best: &RankedRecord, catalogue: &Catalogue) -> [usize; 2] {
    let composites = |names: [&str; 3]| {
        let nodes = tree.nodes().iter();
        nodes
            .filter(|node| names.contains(&node.subtask.name(catalogue)))
            .count()
    };
    let selectable = |types: [usize; 2]| -> usize {
        types
            .iter()
            .map(|&index| best.primitives_by_state_type[index].len())
            .sum()
    };
    [
        composites(["Capture", "FindBattery", "VisibleBattery"]) + selectable([0, 1]),
        composites(["Deliver", "FindNest", "VisibleNest"]) + selectable([2, 3]),
    ]
}

fn without_repeats(tree: &Tree, catalogue: &Catalogue) -> Tree {
    let repeats = |node: usize| {
        let entry = tree.nodes()[node];
        let primitive = !catalogue.subtask(entry.subtask).is_composite();
        primitive
            && entry.parent.is_some_and(|parent| {
                tree.children(parent)
                    .any(|other| other < node && tree.subtask(other) == entry.subtask)
            })
    };
    let kept = (0..tree.nodes().len()).filter(|&node| !repeats(node));
    let preorder: Vec<(SubtaskId, usize)> = kept
        .map(|node| (tree.subtask(node), tree.nodes()[node].depth))
        .collect();
    Tree::from_preorder(&preorder).unwrap_or_else(|| tree.clone())
}

fn most_frequent(outcomes: &[Outcome]) -> Vec<(String, usize)> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for outcome in outcomes {
        *counts.entry(&outcome.structure).or_default() += 1;
    }
    let mut counts: Vec<_> = counts.into_iter().map(|(s, n)| (s.to_owned(), n)).collect();
    counts.sort_by(|(a, n), (b, m)| m.cmp(n).then(a.cmp(b)));
    counts.truncate(2);
    counts
}

fn report(outcomes: &[Outcome]) {
    let mean =
        |of: &dyn Fn(&Outcome) -> f64| outcomes.iter().map(of).sum::<f64>() / outcomes.len() as f64;
    let count = |of: &dyn Fn(&Outcome) -> bool| outcomes.iter().filter(|&o| of(o)).count();
    let steps = |record: &GenerationRecord, rank| record.mean_trial_steps(rank).unwrap_or(f64::NAN);
    let best = |o: &Outcome| o.last.individuals[0].clone();
    let selectable = |o: &Outcome, index: usize| best(o).primitives_by_state_type[index].len();
    let mut generations: Vec<_> = outcomes.iter().map(|o| o.last.generation).collect();
    generations.sort_unstable();
    println!(
        "  generations, median (range), not converged   {} ({}-{}), {}",
        generations[generations.len() / 2],
        generations[0],
        generations[generations.len() - 1],
        count(&|o| !o.last.converged)
    );
    println!(
        "  best, mean trial length first -> last        {:.0} -> {:.0}",
        mean(&|o| steps(&o.first, 1)),
        mean(&|o| steps(&o.last, 1))
    );
    println!(
        "  rank 8, mean trial length first -> last      {:.0} -> {:.0}",
        mean(&|o| steps(&o.first, 8)),
        mean(&|o| steps(&o.last, 8))
    );
    println!(
        "  composites / distinct primitives in the best {:.2} / {:.2}",
        mean(&|o| best(o).composites as f64),
        mean(&|o| best(o).primitives.len() as f64)
    );
    let by_type = [0, 1, 2, 3].map(|index| mean(&|o| selectable(o, index) as f64));
    println!("  selectable primitives in types 1, 2, 3, 4    {by_type:.2?}");
    println!(
        "  two or more in type 2; in type 4             {}; {}",
        count(&|o| selectable(o, 1) >= 2),
        count(&|o| selectable(o, 3) >= 2)
    );
    println!(
        "  three or more in types 2 and 4               {}",
        count(&|o| selectable(o, 1) >= 3 && selectable(o, 3) >= 3)
    );
    println!(
        "  one primitive in every type                  {}",
        count(&|o| (0..4).all(|index| selectable(o, index) == 1))
    );
    println!(
        "  deliver side against capture side (>, =, <)  {} {} {}",
        count(&|o| o.sides[1] > o.sides[0]),
        count(&|o| o.sides[1] == o.sides[0]),
        count(&|o| o.sides[1] < o.sides[0])
    );
    println!(
        "  selectable in type 4 against type 2          {} {} {}",
        count(&|o| selectable(o, 3) > selectable(o, 1)),
        count(&|o| selectable(o, 3) == selectable(o, 1)),
        count(&|o| selectable(o, 3) < selectable(o, 1))
    );
    let differences = [0, 1, 2, 3, 4, 5].map(|index| mean(&|o| o.differences[index]));
    println!("  difference at 0, 10, 25, 50, 75, 100 %       {differences:.1?}");
    let steps = mean(&|o| o.last.control_steps as f64);
    println!(
        "  control steps of a run                       {:.1} million",
        steps / 1e6
    );
}
