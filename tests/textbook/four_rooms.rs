//! Four rooms: shortest ways consist of ways between hallways, with and without slips.

use maxq_lab::lab::Algorithm;
use maxq_lab::worlds::World;

use super::{four_rooms, hand_made, learned};

/// Columns and rows.
const SIDE: usize = 11;

fn cell([column, row]: [usize; 2]) -> usize {
    row * SIDE + column
}

#[test]
fn exact_values_are_minus_the_lengths_of_the_shortest_ways() {
    let experiment = four_rooms(&["world.four_rooms.slip=0"]);
    let values = experiment.world.mdp().unwrap().optimal_values(1.0).0;
    for (from, steps) in [
        ([8, 8], 0.0),
        // Without a hallway; through the eastern one; through the southern one; through the northern
        // and the eastern one.
        ([10, 10], 4.0),
        ([8, 5], 3.0),
        ([4, 9], 5.0),
        ([4, 2], 10.0),
        // Through the west: the way through the north has 16 steps.
        ([0, 4], 14.0),
    ] {
        assert_eq!(values[cell(from)], -steps, "{from:?}");
    }
}

/// Hallways have a single cell, so that the shortest way consists of the shortest ways from hallway
/// to hallway: a recursively optimal policy is optimal here.
#[test]
fn maxq_q_on_the_ways_between_hallways_finds_the_shortest_way() {
    for goal in ["[8, 8]", "[8, 6]"] {
        let goal = format!("world.four_rooms.goal_cell={goal}");
        let experiment = four_rooms(&["world.four_rooms.slip=0", &goal]);
        let algorithm = Algorithm::MaxqQ(hand_made(&experiment));
        let learned = learned(&experiment, &algorithm, 200_000, 1);
        let course = &learned.repeats[0];
        assert!(course.steps_until_always_optimal.is_some(), "{goal}");
    }
}

/// With a slip of 0.75 every action moves in a random direction, so that all policies are equally
/// good and trials are long. A policy whose value did not converge has none.
#[test]
fn no_policy_is_better_than_the_best() {
    let experiment = four_rooms(&["world.four_rooms.slip=0.75"]);
    let learned = learned(&experiment, &Algorithm::QLearning, 20_000, 2);
    assert!(learned.optimal_return < -500.0);
    let mut known = 0;
    for check in learned.repeats.iter().flat_map(|course| &course.checks) {
        if let Some(greedy) = check.greedy_return {
            assert!((greedy - learned.optimal_return).abs() < 1e-3, "{check:?}");
            known += 1;
        }
    }
    assert!(known > 0);
}

#[test]
fn q_learning_comes_near_the_best_where_moves_slip() {
    let experiment = four_rooms(&["learning.learning_rate=0.03"]);
    let learned = learned(&experiment, &Algorithm::QLearning, 1_000_000, 1);
    let greedy = learned.repeats[0].checks.last().unwrap().greedy_return;
    let lost = learned.optimal_return - greedy.unwrap();
    assert!(
        (0.0..0.5).contains(&lost),
        "{lost} of {}",
        learned.optimal_return
    );
}
