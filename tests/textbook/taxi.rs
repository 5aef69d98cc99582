//! The deterministic taxi: the numbers of Thesis 2.2.2, and the optimal policy everywhere.

use maxq_lab::evolution::Experiment;
use maxq_lab::lab::Algorithm;
use maxq_lab::learning::{Agent, Gate, Hierarchy, Policy, PrimitiveSet};
use maxq_lab::random::{Purpose, stream};
use maxq_lab::worlds::World;
use maxq_lab::worlds::taxi::{Passenger, TaxiState, TaxiWorld};

use super::{hand_made, learned, taxi};

/// Trials after which the values have settled.
const TRIALS: usize = 20_000;

/// Trains the hand-made hierarchy by random trials.
fn taught(experiment: &Experiment<TaxiWorld>) -> (Hierarchy, PrimitiveSet) {
    let primitives = PrimitiveSet::untrained(experiment.catalogue(), &experiment.scenario.learning);
    let mut agent = experiment.agent(experiment.untrained(hand_made(experiment)), primitives);
    let mut rng = stream(1, 0, 0, Purpose::Trials);
    let limit = experiment.scenario.evolution.trial_step_limit;
    for _ in 0..TRIALS {
        let start = experiment.world.draw_start(&mut rng);
        agent
            .run_trial(&start, limit, &mut rng, &Gate::default())
            .unwrap();
    }
    agent.into_parts()
}

/// Figure 2.6: the passenger waits at R and wants to go to B. The taxi is one cell south of R. The
/// stands R, G, Y and B have the numbers 0 to 3.
const S1: TaxiState = TaxiState {
    taxi: 5,
    passenger: Passenger::Waiting(0),
    destination: 3,
};

fn check_the_values_of_2_2_2(settings: &[&str]) {
    let experiment = taxi("taxi", settings);
    let world = &experiment.world;
    let (hierarchy, primitives) = taught(&experiment);
    let (catalogue, tree) = (experiment.catalogue(), hierarchy.tree());
    let node = |name: &str, under: &str| {
        let nodes = 0..tree.nodes().len();
        let named = |node: usize| tree.subtask(node).name(catalogue);
        nodes
            .filter(|&node| named(node) == name)
            .find(|&node| under.is_empty() || named(tree.nodes()[node].parent.unwrap()) == under)
            .unwrap()
    };
    let learning = &experiment.scenario.learning;
    let mut policy = Policy::new(
        catalogue,
        &experiment.encoder,
        learning,
        &hierarchy,
        &primitives,
    );
    policy.look(world.state_type(&S1), world.percept(&S1).as_ref());
    let close = |found: f32, expected: f32| assert!((found - expected).abs() < 1e-3, "{found}");
    let mut child = |parent: &str, parent_of: &str, child: &str| {
        let (_, choices) = policy.choices(node(parent, parent_of));
        let child = node(child, parent);
        *choices.iter().find(|choice| choice.node == child).unwrap()
    };
    // Q(Navigate(R), s1, North) = -1 + 0.
    let north = child("NavigateToPassenger", "Get", "North");
    close(north.value, -1.0);
    close(north.c, 0.0);
    // V(Navigate(R), s1) = -1; Q(Get, s1, Navigate(R)) = -1 + -1.
    let navigate = child("Get", "Root", "NavigateToPassenger");
    close(navigate.value, -1.0);
    close(navigate.c, -1.0);
    // V(Get, s1) = -2; Q(Root, s1, Get) = -2 + 12.
    let get = child("Root", "", "Get");
    close(get.value, -2.0);
    close(get.c, 12.0);
    // V(Root, s1) = 10.
    close(policy.value(), 10.0);
    assert_eq!(policy.greedy(), Some((catalogue.find("North").unwrap(), 0)));
}

#[test]
fn the_values_are_those_of_thesis_2_2_2() {
    check_the_values_of_2_2_2(&[]);
}

#[test]
fn the_values_are_the_same_without_state_abstraction() {
    check_the_values_of_2_2_2(&["world.taxi.state_abstraction=false"]);
}

/// From every start the agent, with its stack of active subtasks, earns the optimal return.
#[test]
fn the_greedy_policy_is_optimal_from_every_start() {
    for abstraction in ["true", "false"] {
        let setting = format!("world.taxi.state_abstraction={abstraction}");
        let experiment = taxi("taxi", &[&setting]);
        let (hierarchy, primitives) = taught(&experiment);
        let finite = experiment.world.mdp().unwrap();
        let exact = finite.optimal_values(1.0).0;
        // The agent neither explores nor learns.
        let mut still = experiment.scenario.learning.clone();
        (still.probability_limit, still.epsilon, still.learning_rate) = (0.0, 0.0, 0.0);
        let (world, encoder) = (&experiment.world, &experiment.encoder);
        let mut agent = Agent::new(world, encoder, &still, hierarchy, primitives, 100);
        let mut rng = stream(2, 0, 0, Purpose::Trials);
        let mut starts = 0;
        for taxi in 0..25 {
            for (source, destination) in (0..4).flat_map(|s| (0..4).map(move |d| (s, d))) {
                let start = TaxiState {
                    taxi,
                    passenger: Passenger::Waiting(source),
                    destination,
                };
                let trial = agent
                    .run_trial(&start, 100, &mut rng, &Gate::default())
                    .unwrap();
                let mut states = finite.existing();
                let percept = world.percept(&start);
                let (number, _) = states.find(|(_, state)| state.percept == percept).unwrap();
                assert!(trial.done, "{start:?}");
                assert!((trial.reward - exact[number]).abs() < 1e-6, "{start:?}");
                starts += 1;
            }
        }
        assert_eq!(starts, 400);
    }
}

/// The root's values are the optimal ones in all 400 start states.
#[test]
fn learned_values_are_exact_in_every_start_state() {
    let experiment = taxi("taxi", &[]);
    let algorithm = Algorithm::MaxqQ(hand_made(&experiment));
    let learned = learned(&experiment, &algorithm, 300_000, 1);
    let finite = experiment.world.mdp().unwrap();
    let course = &learned.repeats[0];
    for (number, state) in finite.existing() {
        if state.start > 0.0 {
            let (value, exact) = (course.values[number], learned.exact[number]);
            assert!(
                (value.unwrap() - exact.unwrap()).abs() < 0.01,
                "state {number}"
            );
        }
    }
    assert!(course.steps_until_always_optimal.is_some());
}
