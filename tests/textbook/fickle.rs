//! The fickle taxi: a hierarchy with state abstraction learns in fewer steps than flat Q-learning.

use maxq_lab::evolution::Workers;
use maxq_lab::lab::{Algorithm, LearnProtocol, learn};
use maxq_lab::learning::Gate;

use super::{hand_made, taxi};

#[test]
fn a_hierarchy_with_state_abstraction_needs_fewer_steps_than_flat_q_learning() {
    let experiment = taxi("taxi-fickle", &[]);
    let protocol = LearnProtocol {
        steps: 150_000,
        every: 2000,
        tolerance: 1.0,
        repeats: 4,
    };
    let workers = Workers::new(1).unwrap();
    let steps = |algorithm: &Algorithm| {
        let gate = Gate::default();
        let learned = learn(
            &experiment,
            1,
            algorithm,
            &protocol,
            &workers,
            &gate,
            |_| {},
        );
        learned.unwrap().steps_until_optimal.unwrap().mean
    };
    let hierarchy = steps(&Algorithm::MaxqQ(hand_made(&experiment)));
    let flat = steps(&Algorithm::QLearning);
    assert!((20_000.0..60_000.0).contains(&hierarchy), "{hierarchy}");
    assert!(flat > 1.2 * hierarchy, "{flat} against {hierarchy}");
}
