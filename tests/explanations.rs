//! Contract: an explained step is the step that the agent takes anyway, and every number in
//! the explanation is the one that decided the step or that the step produced.
//!
//! The trial stepper teaches the method to its reader. A display that computed values a moment
//! too late, or changed the agent by looking at it, would teach another method without anyone
//! noticing. So explained agents are compared with unexplained ones bit for bit, and the
//! numbers with the slow `reference`, which shares no code with the library. Tolerances are
//! those of `maxq_reference.rs`.

#![allow(clippy::unwrap_used, clippy::expect_used)]
// The reference serves two test files; each uses a part of it.
#![allow(dead_code, unused_imports)]

mod reference;

use maxq_lab::learning::{
    Agent, Change, Exit, Explanation, Hierarchy, PrimitiveSet, SelectionRule,
};
use maxq_lab::random::{Purpose, stream};
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::ForagingWorld;
use reference::{DELIVERED, Event, Lab, MaxqQ, Reading, State};

const TOLERANCE: f64 = 2e-5;
const STEP_LIMIT: u32 = 600;

/// Thesis Figure 4.2, and a tree with repeated primitives at all depths.
const TREES: [&str; 2] = [
    "(Root (Capture (FindBattery Avoid Wander) (VisibleBattery Avoid Wander ApproachBattery Turn)) \
     (Deliver (FindNest Avoid Wander) (VisibleNest Avoid Wander ApproachNest Turn)))",
    "(Root Wander (Capture Wander Wander (VisibleBattery ApproachBattery Turn ApproachBattery)) \
     (FindNest Avoid Wander Avoid) ApproachNest ApproachNest)",
];

/// Counts of what was met, so that a test can show that it tested something.
#[derive(Debug, Default)]
struct Met {
    steps: usize,
    soft: usize,
    greedy: usize,
    only: usize,
    standing: usize,
    distant: usize,
    at_goal: usize,
    failed: usize,
    learned_actions: usize,
    truncated: usize,
}

/// Runs the same trials with two agents, one of them explained, and checks every step.
fn check(lab: &Lab, tree: &str, trials: usize) -> Met {
    let mut met = Met::default();
    let world = &lab.experiment.world;
    let untrained = lab.untrained(tree);
    let (mut plain, mut explained) = (lab.agent(untrained.clone()), lab.agent(untrained));
    let mut rng = stream(11, 0, 0, Purpose::Trials);
    for _ in 0..trials {
        let start = world.draw_start(&mut rng);
        let mut same_rng = rng.clone();
        let mut trial = plain.begin(&start, &mut rng);
        let mut watched = explained.begin(&start, &mut same_rng);
        while !trial.done && trial.steps < STEP_LIMIT {
            let mut recorder = lab.recorder();
            let before = recorder.state(&watched.state);
            let past = explained.clone();
            plain.advance(&mut trial, STEP_LIMIT, &mut rng, &mut recorder);
            let explanation = explained
                .advance_explained(&mut watched, STEP_LIMIT, &mut same_rng)
                .unwrap();
            assert_eq!(watched.state.pose, trial.state.pose);
            assert_eq!((watched.steps, watched.done), (trial.steps, trial.done));
            assert_same_events(&explanation, &recorder.events);
            if trial.steps % 5 == 0 || explanation.update_traces.len() > 1 {
                let after = recorder.state(&watched.state);
                assert_numbers(lab, &past, &explained, [&before, &after], &explanation);
            }
            met.note(&explanation);
        }
        met.truncated += usize::from(!trial.done);
        assert!(
            explained
                .advance_explained(&mut watched, STEP_LIMIT, &mut same_rng)
                .is_none()
        );
    }
    assert!(plain.into_parts() == explained.into_parts());
    met
}

impl Met {
    fn note(&mut self, explanation: &Explanation) {
        self.steps += 1;
        for level in &explanation.levels {
            match level.rule {
                SelectionRule::Softmax => self.soft += 1,
                SelectionRule::EpsilonGreedy => self.greedy += 1,
                SelectionRule::OnlyChoice => self.only += 1,
                SelectionRule::Uniform => {}
            }
            self.standing += usize::from(!level.chose);
        }
        for update_trace in &explanation.update_traces {
            self.distant += usize::from(update_trace.updates.len() > 1);
            self.at_goal += usize::from(update_trace.termination.is_some_and(|end| end.at_goal));
            self.failed += usize::from(update_trace.exit == Exit::PseudoReward(-1.0));
        }
        self.learned_actions += usize::from(explanation.action.learned.is_some());
    }
}

/// Asserts that the explanation has the events that an observer of the same step recorded.
fn assert_same_events(explanation: &Explanation, events: &[Event]) {
    let levels = explanation.levels.iter().filter(|level| level.chose);
    let explained: Vec<_> = levels.map(|level| (level.node, level.active)).collect();
    let seen = events.iter().filter_map(|event| match event {
        Event::Chose { node, child } => Some((*node, *child)),
        _ => None,
    });
    assert_eq!(explained, seen.collect::<Vec<_>>());

    let action = &explanation.action;
    let acted = events.iter().find_map(|event| match event {
        Event::Acted {
            node,
            action,
            reward,
            ..
        } => Some((*node, *action, *reward)),
        _ => None,
    });
    let explained = (action.node, action.chosen, explanation.reward);
    assert_eq!(Some(explained), acted);

    let explained: Vec<_> = explanation
        .update_traces
        .iter()
        .flat_map(|l| &l.updates)
        .collect();
    let seen = events.iter().filter_map(|event| match event {
        Event::Updated(update) => Some(update),
        _ => None,
    });
    assert_eq!(explained, seen.collect::<Vec<_>>());

    let ended = explanation.update_traces.iter().filter_map(|update_trace| {
        update_trace
            .termination
            .map(|end| (update_trace.node, end.at_goal))
    });
    let seen = events.iter().filter_map(|event| match event {
        Event::Terminated { node, at_goal } => Some((*node, *at_goal)),
        _ => None,
    });
    assert_eq!(ended.collect::<Vec<_>>(), seen.collect::<Vec<_>>());

    // The stack reaches from the root to the action without a gap.
    let path: Vec<_> = explanation.levels.iter().map(|level| level.node).collect();
    let next = path.iter().skip(1).chain([&action.node]);
    let active = explanation.levels.iter().map(|level| &level.active);
    assert!(path[0] == 0 && active.eq(next));
}

/// Compares every number with the reference at the values from before and after the step.
fn assert_numbers(
    lab: &Lab,
    past: &Agent<'_, ForagingWorld>,
    present: &Agent<'_, ForagingWorld>,
    [before, after]: [&State; 2],
    explanation: &Explanation,
) {
    let (past, present) = (past.clone().into_parts(), present.clone().into_parts());
    let (old, new) = (reference(lab, &past), reference(lab, &present));
    for level in &explanation.levels {
        let expected = old.choices(level.node, before);
        assert_eq!(level.choices.len(), expected.len());
        close(level.temperature, old.tau[level.node]);
        for (choice, (child, preference)) in level.choices.iter().zip(expected) {
            assert_eq!(choice.node, child);
            close(choice.value, old.v(child, before));
            close(choice.c_tilde, old.c_tilde(level.node, before, child));
            close(choice.c, old.c(level.node, before, child));
            close(choice.preference(), preference);
        }
        let sum: f32 = level.choices.iter().map(|choice| choice.probability).sum();
        close(sum, 1.0);
    }
    let action = &explanation.action;
    for (value, expected) in action.values.iter().zip(old.q_prim(action.node, before)) {
        close(*value, expected);
    }
    if let Some(learned) = action.learned {
        let q = |of: &MaxqQ<'_>| of.q_prim(action.node, before)[action.chosen];
        changed(learned, [q(&old), q(&new)]);
    }
    let mut expected_end = after.state_type == DELIVERED;
    for update_trace in explanation.update_traces.iter().rev() {
        let (i, a) = (update_trace.node, update_trace.child);
        changed(
            update_trace.c_tilde,
            [&old, &new].map(|r| r.c_tilde(i, before, a)),
        );
        changed(update_trace.c, [&old, &new].map(|r| r.c(i, before, a)));
        if let Some(end) = update_trace.termination {
            changed(end.temperature, [&old, &new].map(|r| r.tau[i]));
            // Delivery is a goal of every subtask, a lost target of none.
            expected_end &= end.at_goal;
            let pseudo_reward = if end.at_goal { 0.0 } else { -1.0 };
            assert_eq!(update_trace.exit, Exit::PseudoReward(pseudo_reward));
        }
    }
    assert!(after.state_type != DELIVERED || expected_end);
}

fn reference<'a>(lab: &'a Lab, parts: &'a (Hierarchy, PrimitiveSet)) -> MaxqQ<'a> {
    let model = &lab.experiment.scenario.learning;
    let catalogue = lab.experiment.catalogue();
    MaxqQ::new(&parts.0, &parts.1, catalogue, model, Reading::BeforeTheLoop)
}

fn changed(change: Change, [before, after]: [f64; 2]) {
    close(change.before, before);
    close(change.after, after);
}

fn close(value: f32, expected: f64) {
    let difference = (f64::from(value) - expected).abs();
    assert!(difference < TOLERANCE, "{value}, not {expected}");
}

#[test]
fn explained_steps_are_the_steps_that_agents_take() {
    let lab = Lab::new("environment-2", &[]);
    let [complete, repeated] = TREES.map(|tree| check(&lab, tree, 8));
    println!("{complete:?} {repeated:?}");
    assert!(complete.only > 50 && repeated.soft > 50);
    for met in [&complete, &repeated] {
        assert!(met.standing > 50 && met.distant > 20, "{met:?}");
        assert!(met.at_goal > 20 && met.truncated > 0, "{met:?}");
        assert_eq!(met.learned_actions, 0);
    }
    assert!(complete.failed > 0);
}

#[test]
fn the_switch_to_epsilon_greedy_selection_is_explained() {
    let cold = [
        "learning.temperature_decrease=0.5",
        "learning.probability_limit=0.7",
    ];
    let met = check(&Lab::new("environment-1", &cold), TREES[1], 4);
    assert!(met.greedy > 50, "{met:?}");
}

#[test]
fn updates_of_primitive_subtasks_are_explained_where_they_learn() {
    let shared = ["learning.primitive_learning=shared"];
    let met = check(&Lab::new("environment-1", &shared), TREES[0], 3);
    assert!(met.learned_actions == met.steps, "{met:?}");
}
