//! The options beyond the thesis, one by one and together.

use super::reference::{Lab, Seen};
use super::{COMPLETE, REPEATED, assert_choices, assert_same_in};

/// Step limits of successive trials.
const LIMITS: [u32; 7] = [700, 12, 1500, 45, 300, 1500, 1500];

/// Trees 4, 5, 6, 12 and 16 of the initial population of environments 4 to 6.
const WITH_COMMANDS: &str = "(Root (Capture Recall ApproachBattery Wander Forward Left Right \
    SpinLeft Back) (Deliver Recall ApproachNest Wander Forward Left Right SpinLeft Back))";
const DEEP: &str = "(Root (Capture (FindBattery Wander Recall) (VisibleBattery ApproachBattery)) \
    (Deliver (FindNest Wander Recall) (VisibleNest ApproachNest)))";
const DEEP_WITH_COMMANDS: &str = "(Root (Capture (FindBattery Wander Forward Left Right SpinLeft \
    Back Recall) (VisibleBattery ApproachBattery Avoid)) (Deliver (FindNest Avoid Wander Recall) \
    (VisibleNest ApproachNest Avoid)))";
const MIXED: &str = "(Root (FindBattery Wander Forward Left Right SpinLeft Back) ApproachBattery \
    (Deliver (FindNest Avoid Wander) ApproachNest Forward Left Right Back))";
const ALL: &str = "(Root (Capture (FindBattery Wander Forward Left Right SpinLeft Back Recall) \
    (VisibleBattery Avoid Wander ApproachBattery Turn)) (Deliver (FindNest Avoid Wander Recall) \
    (VisibleNest Avoid Wander ApproachNest Turn)))";
const TIMED: [&str; 5] = [WITH_COMMANDS, DEEP, DEEP_WITH_COMMANDS, MIXED, ALL];

/// Two trees of the thesis in one of its environments, with these settings.
fn alone(scenario: &str, settings: &[&str]) -> Seen {
    let seen = assert_same_in(
        &Lab::new(scenario, settings),
        &[COMPLETE, REPEATED],
        &LIMITS,
    );
    assert!(
        seen.updates > 5000 && seen.distant_updates > 1000,
        "{seen:?}"
    );
    assert!(seen.delivered > 2 && seen.truncated > 2, "{seen:?}");
    seen
}

/// All options, in an environment that has them, with settings that change some of them.
fn together(scenario: &str, settings: &[&str], trees: &[&str]) -> Seen {
    let seen = assert_same_in(&Lab::new(scenario, settings), trees, &LIMITS);
    assert!(seen.updates > 5000 && seen.repeated > 2000, "{seen:?}");
    assert!(seen.delivered > 0 && seen.truncated > 3, "{seen:?}");
    assert!(seen.commands > 100 && seen.continuations > 40, "{seen:?}");
    assert!(seen.recalled.iter().all(|&steps| steps > 50), "{seen:?}");
    seen
}

#[test]
fn composites_are_rewarded_for_time() {
    alone(
        "environment-1",
        &[r#"learning.composite_reward={"per_step":-0.1}"#],
    );
}

#[test]
fn an_exit_is_worth_what_follows() {
    for more in [
        "learning.pseudo_reward=all",
        "learning.pseudo_reward=terminal",
    ] {
        let seen = alone("environment-3", &["learning.exit_value=continuation", more]);
        assert!(
            seen.continuations > 60 && seen.pseudo_rewards == 0,
            "{seen:?}"
        );
    }
}

#[test]
fn bootstrap_values_are_means_over_the_present_policy() {
    alone("environment-1", &["learning.bootstrap=expected"]);
    // Cold subtasks choose epsilon-greedily.
    let cold = [
        "learning.bootstrap=expected",
        "learning.initial_temperature=0.05",
    ];
    alone("environment-1", &cold);
}

#[test]
fn bootstrap_values_of_random_choices_are_plain_means() {
    let random = [
        "learning.bootstrap=expected",
        "learning.composite_choice=random",
    ];
    alone("environment-1", &random);
}

#[test]
fn a_primitive_subtask_persists_and_its_later_rewards_count() {
    for persistence in ["learning.persistence=3", "learning.persistence=4"] {
        let seen = alone("environment-3", &[persistence]);
        assert!(seen.later_rewards > 1000, "{seen:?}");
    }
}

#[test]
fn updates_are_repeated_backwards_after_the_trial() {
    for (passes, times) in [("learning.replay=1", 1), ("learning.replay=3", 3)] {
        let seen = alone("environment-1", &[passes]);
        assert_eq!(seen.repeated * (times + 1), seen.updates * times);
    }
}

#[test]
fn composites_have_a_temperature_of_their_own_and_cool_once_a_trial() {
    alone("environment-1", &["learning.composite_temperature=0.3"]);
    let trial = [
        "learning.cool_on=trial",
        "learning.temperature_decrease=0.8",
    ];
    alone("environment-1", &trial);
}

#[test]
fn all_options_work_together_in_the_yard() {
    together("environment-4", &[], &TIMED);
}

#[test]
fn all_options_work_together_in_the_greenhouse() {
    together("environment-6", &[], &TIMED);
}

#[test]
fn later_rewards_are_those_of_the_subtasks_where_these_are_what_counts() {
    let settings = ["learning.composite_reward=subtask"];
    let seen = together("environment-4", &settings, &[WITH_COMMANDS, ALL]);
    assert!(seen.later_rewards > 1000, "{seen:?}");
}

#[test]
fn options_work_with_greedy_values_and_with_random_choices() {
    together(
        "environment-4",
        &["learning.bootstrap=greedy"],
        &[WITH_COMMANDS, DEEP_WITH_COMMANDS],
    );
    let random = ["learning.composite_choice=random"];
    together(
        "environment-6",
        &random,
        &[WITH_COMMANDS, DEEP_WITH_COMMANDS],
    );
}

#[test]
fn recall_and_commands_work_where_primitive_subtasks_learn() {
    let settings = [
        "learning.primitive_learning=shared",
        "learning.composite_reward=subtask",
        "world.foraging.memory.odometry_noise=0.1",
    ];
    together(
        "environment-6",
        &settings,
        &[WITH_COMMANDS, DEEP_WITH_COMMANDS],
    );
}

/// Where composites are rewarded for time, they choose by it.
#[test]
fn choices_follow_the_values_of_all_options() {
    let lab = Lab::new("environment-4", &[]);
    let [soft, _] = assert_choices(&lab, &[WITH_COMMANDS, ALL]);
    assert!(soft > 5, "{soft} soft");
}
