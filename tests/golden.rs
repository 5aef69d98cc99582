//! Contract: every world gives the bits that are written down here, on every machine.
//!
//! Why it matters: a result can be checked by anybody only if another processor, compiler
//! or vector width computes the same numbers. `benches/README.md` says where this test has
//! passed.
//!
//! The numbers may change only with an intended change of the method or of its random streams.

#![allow(clippy::unwrap_used)]

mod common;

use common::{OPTIONS, SHORT_TRAINING, record, threads};
use maxq_lab::evolution::Workers;
use maxq_lab::lab::{Algorithm, AnyExperiment, GivenPolicy, LearnProtocol, experiment};
use maxq_lab::learning::Gate;
use maxq_lab::scenario::Scenario;

/// CRC-32 of `events.jsonl` of a short run with seed 1.
const EVOLUTION: &[(&str, u32)] = &[
    ("smoke", 0x893b_3dfa),
    ("taxi", 0x7630_5985),
    ("taxi-fickle", 0xc546_9801),
    ("cliff", 0x822e_bc69),
    ("four-rooms", 0x71ee_36be),
    ("environment-4", 0x05f4_b3ea),
    ("environment-6", 0x3fa2_e4d4),
];

/// The same for `taxi` with all of them.
const TAXI_WITH_OPTIONS: u32 = 0x4e85_8cd5;

/// CRC-32 of everything that a learner found in 5000 steps with seed 1, as JSON.
const LEARNING: &[(&str, &str, u32)] = &[
    ("cliff", "td0", 0x12a7_7f05),
    ("cliff", "q-learning", 0xc6c2_e8ee),
    ("cliff", "q-learning-rbf", 0x6d63_e998),
    ("cliff", "maxq-q", 0x5bdb_93fa),
    ("taxi", "q-learning", 0x8764_a4c0),
    ("taxi", "maxq-q", 0x4cd7_2b8b),
    ("taxi-fickle", "q-learning", 0xdf3f_71d7),
    ("taxi-fickle", "maxq-q", 0x1fa9_cacc),
    ("four-rooms", "q-learning", 0x8b50_1dd5),
    ("four-rooms", "maxq-q", 0x4189_02c6),
];

/// `smoke` as it is; the other scenarios with settings that make them as short.
fn scenario(name: &str) -> Scenario {
    let scenario = Scenario::load(name).unwrap();
    if name == "smoke" {
        return scenario;
    }
    let mut short = vec![
        "evolution.trials_per_generation=8",
        "evolution.generation_limit=4",
    ];
    if name.starts_with("environment") {
        short.extend(SHORT_TRAINING);
        short.push("evolution.trial_step_limit=400");
    }
    with(scenario, &short)
}

fn with(scenario: Scenario, settings: &[&str]) -> Scenario {
    let settings: Vec<_> = settings.iter().map(|&setting| setting.to_owned()).collect();
    scenario.with_settings(&settings).unwrap()
}

#[test]
fn evolution_gives_the_published_bits() {
    let mut runs: Vec<_> = EVOLUTION
        .iter()
        .map(|&(name, golden)| (name, scenario(name), golden))
        .collect();
    let taxi = with(scenario("taxi"), OPTIONS);
    runs.push(("taxi with options", taxi, TAXI_WITH_OPTIONS));
    let mut different = Vec::new();
    for (name, scenario, golden) in runs {
        let found = crc32fast::hash(&record(&scenario, 1, &threads(2)).events);
        if found != golden {
            different.push(format!("{name}: {found:#010x}, not {golden:#010x}"));
        }
    }
    assert!(
        different.is_empty(),
        "CRC-32 of events.jsonl: {different:?}"
    );
}

#[test]
fn learning_gives_the_published_bits() {
    for &(name, algorithm, golden) in LEARNING {
        let experiment = experiment(Scenario::load(name).unwrap(), 1).unwrap();
        let found = crc32fast::hash(learned(&*experiment, algorithm).as_bytes());
        assert_eq!(
            found, golden,
            "{algorithm} in {name} has CRC-32 {found:#010x}, not {golden:#010x}"
        );
    }
}

fn learned(experiment: &dyn AnyExperiment, algorithm: &str) -> String {
    let algorithm = match algorithm {
        "td0" => Algorithm::Td0(GivenPolicy::Optimal),
        "q-learning" => Algorithm::QLearning,
        "q-learning-rbf" => Algorithm::QLearningRbf,
        _ => Algorithm::MaxqQ(
            experiment
                .read_tree(experiment.hand_made().unwrap())
                .unwrap(),
        ),
    };
    let protocol = LearnProtocol {
        steps: 5000,
        every: 1000,
        tolerance: 0.1,
        repeats: 1,
    };
    let workers = Workers::new(2).unwrap();
    let gate = Gate::default();
    let learned = experiment.learn(&algorithm, &protocol, &workers, &gate, &|_| {});
    let learned = learned.unwrap();
    let values = experiment.value_grids(&learned);
    serde_json::to_string(&learned).unwrap() + &serde_json::to_string(&values).unwrap()
}
