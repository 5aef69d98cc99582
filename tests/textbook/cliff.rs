//! The cliff walk: Figure 2.3, by all three flat algorithms.

use maxq_lab::lab::{Algorithm, GivenPolicy, value_grids};
use maxq_lab::worlds::World;

use super::{cliff, hand_made, learned};

/// Thesis Figure 2.3, all 38 values.
const FIGURE_2_3: [[Option<f64>; 12]; 4] = {
    let mut rows = [[None; 12]; 4];
    let mut column = 0;
    while column < 12 {
        let mut row = 0;
        while row < 3 {
            // The steps to the goal, with nothing in the way.
            rows[row][column] = Some(-((11 - column) as f64) - (3 - row) as f64);
            row += 1;
        }
        column += 1;
    }
    rows[3][0] = Some(-13.0);
    rows[3][11] = Some(0.0);
    rows
};

#[test]
fn the_figure_is_the_printed_one() {
    let row = |values: [i32; 12]| values.map(|value| Some(f64::from(value)));
    assert_eq!(
        FIGURE_2_3[0],
        row([-14, -13, -12, -11, -10, -9, -8, -7, -6, -5, -4, -3])
    );
    assert_eq!(
        FIGURE_2_3[2],
        row([-12, -11, -10, -9, -8, -7, -6, -5, -4, -3, -2, -1])
    );
    assert_eq!(FIGURE_2_3.iter().flatten().flatten().count(), 38);
}

fn check(algorithm: &Algorithm, tolerance: f64) {
    let experiment = cliff(&[]);
    let learned = learned(&experiment, algorithm, 100_000, 1);
    let grids = value_grids(&experiment.world, &learned);
    assert_eq!(grids.len(), 1);
    for (row, expected) in FIGURE_2_3.iter().enumerate() {
        assert_eq!(grids[0].exact[row], expected, "dynamic programming");
        for (column, expected) in expected.iter().enumerate() {
            let value = grids[0].learned[row][column];
            assert_eq!(value.is_some(), expected.is_some(), "{row}, {column}");
            let error = value.unwrap_or_default() - expected.unwrap_or_default();
            assert!(error.abs() < tolerance, "{row}, {column}: {value:?}");
        }
    }
}

#[test]
fn td0_learns_all_38_values_of_the_optimal_policy() {
    check(&Algorithm::Td0(GivenPolicy::Optimal), 1e-3);
}

#[test]
fn q_learning_learns_all_38_values() {
    check(&Algorithm::QLearning, 1e-3);
}

#[test]
fn q_learning_with_rbf_features_learns_all_38_values() {
    check(&Algorithm::QLearningRbf, 1e-2);
}

/// A random policy falls again and again. Its values are far from the optimal ones, and the
/// learning rate is small enough to average over chance.
#[test]
fn td0_learns_the_values_of_a_random_policy() {
    let experiment = cliff(&[
        "world.cliff.width=4",
        "world.cliff.height=3",
        "learning.learning_rate=0.003",
        "evolution.trial_step_limit=100000",
    ]);
    let learned = learned(
        &experiment,
        &Algorithm::Td0(GivenPolicy::Random),
        1_000_000,
        1,
    );
    let check = learned.repeats[0].checks.last().unwrap();
    let worst = learned.exact.iter().flatten().copied().fold(0.0, f64::min);
    assert!(worst < -500.0, "it falls often: {worst}");
    assert!(
        check.largest_error < 0.1 * worst.abs(),
        "{check:?} of {worst}"
    );
}

#[test]
fn maxq_q_finds_the_shortest_way() {
    let experiment = cliff(&[]);
    let algorithm = Algorithm::MaxqQ(hand_made(&experiment));
    let learned = learned(&experiment, &algorithm, 100_000, 1);
    assert!(learned.repeats[0].steps_until_always_optimal.is_some());
}

/// The random walk over the cliff takes tens of thousands of steps: sweeps over the states are
/// far from its values when they stop.
#[test]
fn values_of_the_random_walk_solve_their_equations() {
    for (settings, lowest) in [
        (&[][..], Some(-65_375.0)),
        (&["world.cliff.width=16"][..], None),
        (&["world.cliff.width=24", "world.cliff.height=6"][..], None),
    ] {
        let experiment = cliff(settings);
        let mdp = experiment.world.mdp().unwrap();
        let policy = mdp.random_policy();
        let values = mdp.exact_policy_values(&policy, 1.0).unwrap();
        let scale = values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        for (index, state) in mdp.existing() {
            let outcomes = state.outcomes.iter().flatten();
            let next = outcomes.map(|o| 0.25 * o.probability * (o.reward + values[o.next]));
            let next: f64 = next.sum();
            assert!((values[index] - next).abs() < 1e-9 * scale, "{settings:?}");
        }
        if let Some(lowest) = lowest {
            assert!((-scale - lowest).abs() < 1.0, "{scale}");
        }
    }
}
