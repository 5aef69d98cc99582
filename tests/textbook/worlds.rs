//! The worlds agree with their MDPs in every state and for every action.

use std::collections::BTreeMap;

use maxq_lab::random::{Purpose, stream};
use maxq_lab::worlds::scene::Scenic;

use super::{cliff, four_rooms, taxi};

/// Steps sampled for each action in a state.
const SAMPLES: usize = 400;

/// Checks in every state that can be shown that rewards and next states of many steps are as
/// frequent as in the MDP. Returns the number of states.
fn check<W: Scenic>(world: &W) -> usize {
    let finite = world.mdp().unwrap();
    let mut rng = stream(3, 0, 0, Purpose::Trials);
    let [columns, rows] = world.scenery().grid.unwrap();
    let number = |state: &W::State| {
        let (state_type, percept) = (world.state_type(state), world.percept(state));
        let same = |(_, known): &(usize, &maxq_lab::worlds::mdp::MdpState<W::Percept>)| {
            // All terminal states have the same number.
            known.state_type == state_type
                && (known.outcomes.is_empty() || known.percept.as_ref() == percept.as_ref())
        };
        finite.existing().find(same).unwrap().0
    };
    let mut states = 0;
    for variant in 0..world.variants().len() {
        for (column, row) in (0..columns).flat_map(|c| (0..rows).map(move |r| (c, r))) {
            let at = [column as f64 + 0.5, row as f64 + 0.5];
            let Some(state) = world.state_at(at, 0.0, variant, &mut rng) else {
                continue;
            };
            assert_eq!(world.position(&state), at);
            assert_eq!(world.snapshot(&state).at, at);
            let known = finite.states[number(&state)].as_ref().unwrap();
            for (&(primitive, action), outcomes) in finite.actions.iter().zip(&known.outcomes) {
                let mut seen: BTreeMap<(usize, i64), f64> = BTreeMap::new();
                for _ in 0..SAMPLES {
                    let mut next = state.clone();
                    let reward = world.step(&mut next, primitive, action, &mut rng);
                    let key = (number(&next), reward as i64);
                    *seen.entry(key).or_default() += 1.0 / SAMPLES as f64;
                }
                let mut said: BTreeMap<(usize, i64), f64> = BTreeMap::new();
                for outcome in outcomes {
                    let key = (outcome.next, outcome.reward as i64);
                    *said.entry(key).or_default() += outcome.probability;
                }
                let total: f64 = outcomes.iter().map(|outcome| outcome.probability).sum();
                assert!((total - 1.0).abs() < 1e-12);
                for (key, share) in &seen {
                    let probability = said.get(key).copied().unwrap_or_default();
                    // Five standard deviations of a share of one half.
                    assert!((share - probability).abs() < 0.125, "{key:?}: {share}");
                    assert!(probability > 0.0, "{key:?} cannot happen");
                }
            }
            states += 1;
        }
    }
    let starts: f64 = finite.existing().map(|(_, state)| state.start).sum();
    assert!((starts - 1.0).abs() < 1e-9);
    states
}

#[test]
fn the_taxi_agrees_with_its_mdp() {
    assert_eq!(check(&taxi("taxi", &[]).world), 500);
}

#[test]
fn the_fickle_taxi_agrees_with_its_mdp() {
    assert_eq!(check(&taxi("taxi-fickle", &[]).world), 500);
}

#[test]
fn the_cliff_walk_agrees_with_its_mdp() {
    assert_eq!(check(&cliff(&[]).world), 38);
}

#[test]
fn four_rooms_agree_with_their_mdp() {
    assert_eq!(check(&four_rooms(&[]).world), 104);
    // The goal in a hallway, too.
    let hallway = "world.four_rooms.goal_cell=[8, 6]";
    assert_eq!(check(&four_rooms(&[hallway]).world), 104);
}
