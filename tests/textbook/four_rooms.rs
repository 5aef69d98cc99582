//! Four rooms: the ways between hallways make up the shortest way, and lead on where moves slip.

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
        // Straight to the goal; through the hallways in the east, the south, the north.
        ([10, 10], 4.0),
        ([8, 5], 3.0),
        ([4, 9], 5.0),
        ([4, 2], 10.0),
        // Through the west, for through the north it is 16.
        ([0, 4], 14.0),
    ] {
        assert_eq!(values[cell(from)], -steps, "{from:?}");
    }
}

/// Hallways have a single cell, so that the shortest way is made of the shortest ways from
/// hallway to hallway: what is recursively optimal is optimal here.
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

/// Where chance decides, all policies are alike and ways are long: no policy is better than
/// the best, and one whose value is not known counts for nothing.
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
