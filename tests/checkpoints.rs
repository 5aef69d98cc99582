//! Contract: loading a checkpoint and saving it again gives the same bytes, and a run can be
//! resumed from every kept checkpoint.
//!
//! Why it matters: if a number came back from the disk one bit off, or a field were forgotten, a
//! resumed run would silently become another run.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{Record, assert_same_bytes, run_in, short, smoke, threads};
use maxq_lab::lab::{Checkpoint, experiment, resume};
use maxq_lab::scenario::Scenario;
use proptest::prelude::*;

/// Loads a checkpoint, rebuilds its state, and saves both again.
fn assert_round_trip(bytes: &[u8], what: &str) {
    let text = std::str::from_utf8(bytes).unwrap();
    let loaded = Checkpoint::from_text(text).unwrap();
    assert_same_bytes(&loaded.to_bytes().unwrap(), bytes, what);
    let experiment = experiment(loaded.scenario.clone(), loaded.seed).unwrap();
    let state = experiment.population(&loaded).unwrap();
    let (scenario, catalogue) = (experiment.scenario(), experiment.catalogue());
    let again = Checkpoint::of(scenario, catalogue, loaded.seed, &state, loaded.events).unwrap();
    let rebuilt = again.to_bytes().unwrap();
    assert_same_bytes(&rebuilt, bytes, &format!("{what}, by its state"));
}

/// Returns the kept checkpoints of a run, in order.
fn kept(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.join("generations")).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

#[test]
fn saving_a_loaded_checkpoint_of_smoke_gives_the_same_bytes() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    let outcome = run_in(&folder, &smoke(&[]), 1, &threads(2));
    assert_round_trip(&Record::of(&folder).checkpoint, "smoke");
    let kept = kept(&folder);
    assert_eq!(kept.len() as u64, outcome.generations);
    for path in kept {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert_round_trip(&fs::read(&path).unwrap(), &name);
    }
}

#[test]
fn resuming_from_any_kept_checkpoint_gives_the_same_result() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let never_left = Record::of(&folder);
    let kept = kept(&folder);
    assert!(kept.len() > 1);
    for path in kept {
        let back = fs::read(&path).unwrap();
        fs::write(folder.join("checkpoint.json"), back).unwrap();
        resume(&folder, None, &threads(2)).unwrap().join().unwrap();
        let from = format!("from {}", path.file_name().unwrap().display());
        Record::of(&folder).assert_same(&never_left, &from);
    }
}

#[test]
fn states_survive_the_disk_bit_for_bit() {
    let saved = common::record(&short(&[]), 3, &threads(2)).checkpoint;
    let text = String::from_utf8(saved).unwrap();
    let once = Checkpoint::from_text(&text).unwrap();
    let twice = String::from_utf8(once.to_bytes().unwrap()).unwrap();
    assert!(Checkpoint::from_text(&twice).unwrap() == once);
    assert_eq!((once.seed, once.scenario.clone()), (3, short(&[])));
}

proptest! {
    // Each case is a run.
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn saving_a_loaded_checkpoint_of_any_run_gives_the_same_bytes(
        seed: u64,
        generations in 1_u64..5,
        shared: bool,
        initial in -1000.0..1000.0_f64,
        mutation in 0.0..=1.0_f64,
    ) {
        let learning = if shared { "shared" } else { "frozen" };
        let scenario: Scenario = short(&[
            &format!("evolution.generation_limit={generations}"),
            &format!("learning.primitive_learning={learning}"),
            &format!("learning.initial_parameter={initial}"),
            &format!("evolution.prune_probability={mutation}"),
            &format!("evolution.grow_probability={mutation}"),
        ]);
        let record = common::record(&scenario, seed, &threads(2));
        assert_round_trip(&record.checkpoint, "a run");
    }
}
