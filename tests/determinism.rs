//! Contract: the same scenario and seed give the same events and the same checkpoint, bit for bit,
//! for any number of threads, paused or not, watched or not; and every switch of a scenario has an
//! effect.
//!
//! Why it matters: a result that depends on the machine cannot be checked by anybody, an
//! interrupted run could not be resumed, and watching an experiment would change it.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::time::Duration;

use common::{OPTIONS, Record, SHORT, record, short, stop_after, threads, wait_until};
use crossbeam_channel::never;
use maxq_lab::lab::{Activity, Controls, Event, Run, RunOptions, read_events, resume, start};
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::Scenario;
use rand::RngExt;

/// Returns the record of a run; `treated` may disturb it first.
fn record_when(scenario: &Scenario, treated: impl FnOnce(&mut Run)) -> Record {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    let mut run = start(scenario.clone(), 1, &folder, &threads(2)).unwrap();
    treated(&mut run);
    run.join().unwrap();
    Record::of(&folder)
}

#[test]
fn the_number_of_threads_changes_nothing() {
    for seed in [1, u64::MAX] {
        let one = record(&short(&[]), seed, &threads(1));
        for count in [2, 8] {
            let other = record(&short(&[]), seed, &threads(count));
            one.assert_same(&other, &format!("1 and {count} threads, seed {seed}"));
        }
    }
}

#[test]
fn different_seeds_give_different_runs() {
    let [one, other] = [1, 2].map(|seed| record(&short(&[]), seed, &threads(2)));
    assert_ne!(generations(&one), generations(&other));
}

/// The events of a run after the first, which is its scenario and seed.
fn generations(record: &Record) -> String {
    let text = String::from_utf8(record.events.clone()).unwrap();
    text.split_once('\n').unwrap().1.to_owned()
}

#[test]
fn pausing_and_stepping_at_random_moments_changes_nothing() {
    let undisturbed = record(&short(&[]), 1, &threads(2));
    for round in 0..5 {
        let disturbed = record_when(&short(&[]), |run| disturb(run, round));
        disturbed.assert_same(&undisturbed, &format!("paused at random, round {round}"));
    }
}

/// Pauses, steps and resumes until the run is over. The first pause comes at once, so that the run
/// cannot end before it.
fn disturb(run: &mut Run, round: u64) {
    let mut rng = stream(round, 0, 0, Purpose::Trials);
    run.controls.pause();
    let commands: [fn(&Controls); 4] = [
        Controls::pause,
        Controls::step,
        Controls::resume,
        Controls::checkpoint,
    ];
    for _ in 0..60 {
        commands[rng.random_range(0..commands.len())](&run.controls);
        // The moment is random; the test waits for nothing.
        std::thread::sleep(Duration::from_micros(rng.random_range(0..800)));
    }
    run.controls.resume();
    let events: Vec<_> = run.events.iter().collect();
    assert!(events.contains(&Event::Paused) && events.contains(&Event::Resumed));
}

#[test]
fn a_step_is_one_generation_and_a_paused_run_computes_nothing() {
    let undisturbed = record(&short(&[]), 1, &threads(2));
    let stepped = record_when(&short(&[]), |run| {
        run.controls.pause();
        for _ in 0..3 {
            run.controls.step();
            wait_until("the end of the step", || {
                run.controls.activity() == Activity::Paused
            });
        }
        let told: Vec<_> = run.events.try_iter().collect();
        let is_generation = |event: &&Event| matches!(event, Event::Generation(_));
        assert_eq!(told.iter().filter(is_generation).count(), 3);
        let steps = run.controls.control_steps();
        std::thread::sleep(Duration::from_millis(20));
        assert_eq!(run.controls.control_steps(), steps, "a paused run computes");
        run.controls.resume();
    });
    stepped.assert_same(&undisturbed, "stepped");
}

#[test]
fn a_slow_or_missing_reader_changes_nothing() {
    // A large population has more events than the channel holds.
    let mut scenario = short(&["evolution.trial_step_limit=20"]);
    let evolution = &mut scenario.evolution;
    evolution.initial_population = vec![evolution.initial_population.clone(); 10].concat();
    evolution.population_size = evolution.initial_population.len();
    let unread = record_when(&scenario, |_| {});
    let gone = record_when(&scenario, |run| {
        run.events.recv().unwrap();
        run.events = never();
    });
    gone.assert_same(&unread, "a reader that went away");
    let slow = record_when(&scenario, |run| {
        // The run reaches its end although nobody reads its events.
        let log = run.folder.join("events.jsonl");
        let complete = unread.events.iter().filter(|&&byte| byte == b'\n').count();
        wait_until("the end of the run", || common::lines(&log) == complete);
        let told: Vec<_> = run.events.iter().collect();
        assert!(
            told.len() > 256,
            "the scenario has too few events for this test"
        );
        let recorded: Vec<_> = told.into_iter().filter(Event::is_recorded).collect();
        assert_eq!(recorded, read_events(&log).unwrap());
    });
    slow.assert_same(&unread, "a slow reader");
}

#[test]
fn the_kept_generations_change_nothing() {
    let all = record(&short(&[]), 1, &threads(2));
    let none = RunOptions {
        keep: Some("none".parse().unwrap()),
        ..threads(2)
    };
    record(&short(&[]), 1, &none).assert_same(&all, "nothing kept");
}

#[test]
fn every_switch_is_deterministic_and_matters() {
    // Quick cooling, so that its time matters in a short run.
    const COOLING: &str = "learning.temperature_decrease=0.7";
    let default = record(&short(&[COOLING]), 1, &threads(2));
    let switches = [
        "learning.primitive_learning=shared",
        "learning.composite_choice=random",
        "learning.cool_on=goal",
        "learning.pseudo_reward=all",
        "evolution.selection=random",
        "evolution.inheritance=darwinian",
        "evolution.prune_probability=0.5",
        "evolution.grow_probability=0.5",
        "evolution.variation=random_trees",
        "evolution.variation=none",
        r#"world.foraging.memory={"odometry_noise":0.1}"#,
        "world.foraging.arena.transparent_walls_mm=[[500,900,1500,900]]",
        "world.foraging.features.rbf_width=variance",
    ];
    for &switch in switches.iter().chain(OPTIONS) {
        let scenario = short(&[COOLING, switch]);
        let one = record(&scenario, 1, &threads(1));
        let two = record(&scenario, 1, &threads(2));
        one.assert_same(&two, switch);
        // The first line says which scenario it is.
        let (with, without) = (generations(&one), generations(&default));
        assert!(with != without, "{switch} has no effect");
    }
}

/// The yard, with all options beyond the thesis, on one thread and on two, interrupted or not.
#[test]
fn all_options_together_are_deterministic_and_survive_an_interruption() {
    let settings: Vec<_> = SHORT.iter().map(|&setting| setting.to_owned()).collect();
    let yard = Scenario::load("environment-4").unwrap();
    let yard = yard.with_settings(&settings).unwrap();
    let one = record(&yard, 1, &threads(1));
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    stop_after(start(yard, 1, &folder, &threads(2)).unwrap(), 3);
    resume(&folder, None, &threads(2)).unwrap().join().unwrap();
    Record::of(&folder).assert_same(&one, "on two threads, interrupted");
}
