//! The primitive subtasks learn their purpose before evolution starts.
//!
//! An independent implementation measured the numbers. They are the first to change with an error
//! in rewards, features, episodes or temperatures.

use maxq_lab::evolution::{Experiment, Workers};
use maxq_lab::learning::{Gate, PrimitiveSet};
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::ForagingWorld;

use super::world;

const SEEDS: std::ops::RangeInclusive<u64> = 1..=4;

/// Trains primitive subtasks in environments 1 and 2.
fn trained() -> Vec<(Experiment<ForagingWorld>, PrimitiveSet)> {
    let workers = Workers::new(2).unwrap();
    let of = |(scenario, seed): (&str, u64)| {
        let experiment = Scenario::load(scenario).unwrap();
        let experiment = Experiment::new(experiment, world(scenario)).unwrap();
        let primitives = experiment.train(seed, 0, &workers, &Gate::default());
        (experiment, primitives.unwrap())
    };
    let scenarios = ["environment-1", "environment-2"].into_iter();
    let runs = scenarios.flat_map(|scenario| SEEDS.map(move |seed| (scenario, seed)));
    runs.map(of).collect()
}

/// Returns the action values of a primitive subtask at one of its probes.
fn values(
    (experiment, primitives): &(Experiment<ForagingWorld>, PrimitiveSet),
    name: &str,
    label: &str,
) -> Vec<f32> {
    let subtask = experiment.catalogue().find(name).unwrap();
    let primitive = primitives
        .all()
        .iter()
        .find(|primitive| primitive.subtask == subtask)
        .unwrap();
    let probes = experiment.world.probes(subtask);
    let probe = probes.iter().find(|probe| probe.label == label).unwrap();
    primitive.action_values(&experiment.encoder, &probe.percept)
}

fn greedy(values: &[f32]) -> usize {
    let best = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    1 + values.iter().position(|&value| value == best).unwrap()
}

#[test]
fn primitive_subtasks_learn_their_purpose() {
    let runs = trained();
    // Greedy actions at -60, -50, +50, +60 degrees, actions numbered from 1.
    let labels = ["-60 deg", "-50 deg", "+50 deg", "+60 deg"];
    let mut wrong = Vec::new();
    for run in &runs {
        for (name, expected) in [
            ("ApproachBattery", [5, 5, 4, 4]),
            ("ApproachNest", [5, 5, 4, 4]),
            ("Turn", [3, 3, 4, 4]),
        ] {
            let actions = labels.map(|label| greedy(&values(run, name, label)));
            for (label, (found, expected)) in labels.iter().zip(actions.iter().zip(expected)) {
                if *found != expected {
                    wrong.push((name, *label, *found));
                }
            }
        }
    }
    // Of 192 actions at +-60 degrees in 32 trainings one of Turn was wrong. Here are 48 in 8.
    let at_the_edge =
        |&(name, label, _): &(&str, &str, usize)| name == "Turn" && label.ends_with("60 deg");
    assert!(
        wrong.len() <= 1 && wrong.iter().all(at_the_edge),
        "{wrong:?}"
    );

    let mean = |name: &str, label: &str| -> Vec<f32> {
        let all: Vec<_> = runs.iter().map(|run| values(run, name, label)).collect();
        let count = all.len() as f32;
        (0..5)
            .map(|a| all.iter().map(|q| q[a]).sum::<f32>() / count)
            .collect()
    };
    let near = |found: &[f32], expected: [f32; 5], tolerance: f32| {
        let pairs = found.iter().zip(expected);
        let worst = pairs
            .map(|(q, expected)| (q - expected).abs())
            .fold(0.0, f32::max);
        assert!(worst <= tolerance, "{found:?}, not {expected:?}");
    };
    let wander = [-0.30, -0.49, -0.48, -0.69, -0.69];
    let avoid = [-0.50, -0.50, -0.75, -0.75, -0.87];
    near(&mean("Wander", "open"), wander, 0.03);
    near(&mean("Avoid", "open"), avoid, 0.02);
    for run in &runs {
        near(&values(run, "Wander", "open"), wander, 0.08);
        near(&values(run, "Avoid", "open"), avoid, 0.05);
        near(&values(run, "Wander", "wall ahead"), [-0.96; 5], 0.05);
    }
}
