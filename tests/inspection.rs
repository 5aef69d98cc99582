//! Contract: everything that inspection shows of an individual (rollouts, learned values, maps,
//! ancestors, past populations) is what the run has, and inspecting changes nothing.
//!
//! Why it matters: the dashboard shows a run through this interface alone. If a rollout depended
//! on how it is watched, a figure could not be repeated; if a map or a probability came from other
//! numbers than the run's, the screen would contradict the record.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::fs;
use std::path::Path;

use common::{run_in, short, threads};
use maxq_lab::evolution::{GenerationRecord, Origin};
use maxq_lab::lab::inspection::{
    Archive, ArchiveError, InspectedIndividual, MapView, Quantity, lineage,
};
use maxq_lab::lab::{
    AnyExperiment, Event, Keep, RunOptions, experiment, lasting_experiment, read_events, start,
};
use maxq_lab::scenario::Scenario;

const SEED: u64 = 3;

/// A finished run.
struct Finished {
    folder: tempfile::TempDir,
    experiment: &'static dyn AnyExperiment,
    records: Vec<GenerationRecord>,
}

impl Finished {
    fn new(scenario: Scenario, keep: Keep) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run");
        let options = RunOptions {
            keep: Some(keep),
            ..threads(1)
        };
        run_in(&path, &scenario, SEED, &options);
        let events = read_events(&path.join("events.jsonl")).unwrap();
        let records = events.into_iter().filter_map(|event| match event {
            Event::Generation(record) => Some(*record),
            _ => None,
        });
        Self {
            records: records.collect(),
            experiment: lasting_experiment(scenario, SEED).unwrap(),
            folder,
        }
    }

    fn path(&self) -> std::path::PathBuf {
        self.folder.path().join("run")
    }

    fn archive(&self) -> Archive {
        Archive::new(self.experiment, &self.path(), None)
    }
}

fn finished() -> Finished {
    Finished::new(short(&[]), Keep::All)
}

#[test]
fn a_rollout_is_the_same_stepped_or_advanced() {
    let run = finished();
    let state = run.archive().latest().unwrap();
    let individual = InspectedIndividual::at(&state, 0).unwrap();
    let mut stepped = run.experiment.rollout(individual, 0, None);
    let mut advanced = run.experiment.rollout(individual, 0, None);
    let mut taken = 0;
    for stride in [1, 1, 2, 7, 60, 300, 1, 500] {
        advanced.advance(stride);
        for _ in 0..stride {
            let trace = stepped.step().unwrap();
            assert_eq!(trace.after, stepped.snapshot());
            assert_eq!(trace.step, stepped.status().steps);
            taken += 1;
        }
        assert_eq!(
            stepped.snapshot(),
            advanced.snapshot(),
            "after {taken} steps"
        );
        assert_eq!(stepped.status(), advanced.status());
        assert_eq!(stepped.temperatures(), advanced.temperatures());
    }
    let status = stepped.status();
    assert!(status.trial > 1 && status.history.len() as u64 >= status.trial - 1);
    assert_eq!(status.visits[0], status.trial);
    assert_eq!(status.trail.len() as u32, status.steps + 1);
}

#[test]
fn each_rollout_has_its_own_random_stream() {
    let run = finished();
    let state = run.archive().latest().unwrap();
    let individual = InspectedIndividual::at(&state, 0).unwrap();
    let start = |number| {
        run.experiment
            .rollout(individual, number, None)
            .snapshot()
            .at
    };
    assert_eq!(start(0), start(0));
    assert_ne!(start(0), start(1));
}

#[test]
fn a_finished_trial_stays_until_the_next_step() {
    let run = finished();
    let state = run.archive().latest().unwrap();
    let individual = InspectedIndividual::at(&state, 0).unwrap();
    let mut rollout = run.experiment.rollout(individual, 0, None);
    let last = loop {
        let trace = rollout.step().unwrap();
        if trace.ended.is_some() {
            break trace;
        }
    };
    assert_eq!(rollout.snapshot(), last.after);
    assert_eq!(rollout.status().ended, last.ended);
    let next = rollout.step().unwrap();
    assert_eq!((next.trial, next.step), (last.trial + 1, 1));
    assert_eq!(next.explanation.levels[0].node, 0);
}

#[test]
fn selection_probabilities_equal_those_of_the_record() {
    let run = finished();
    let mut archive = run.archive();
    let record = run.records.last().unwrap();
    let state = archive.generation(record.generation).unwrap();
    let better = state.individuals.len() / 2;
    let all: Vec<_> = (0..better)
        .map(|index| {
            run.experiment
                .selection(InspectedIndividual::at(&state, index).unwrap())
        })
        .collect();
    let names: Vec<_> = run.experiment.catalogue().primitives().collect();
    for (state_type, recorded) in record.selection_probabilities.iter().enumerate() {
        for (place, primitive) in names.iter().enumerate() {
            let sum: f64 = all
                .iter()
                .map(|own| own[state_type].as_ref().unwrap()[place])
                .sum();
            let name = primitive.name(run.experiment.catalogue());
            let recorded = recorded.as_ref().unwrap()[name];
            assert_eq!(
                (sum / better as f64).to_bits(),
                recorded.to_bits(),
                "{name}"
            );
        }
    }
}

#[test]
fn maps_are_repeatable_and_empty_where_no_agent_can_be() {
    let run = Finished::new(
        Scenario::load("environment-2")
            .unwrap()
            .with_settings(&common::SHORT.iter().map(|&s| s.into()).collect::<Vec<_>>())
            .unwrap(),
        Keep::None,
    );
    let state = run.archive().latest().unwrap();
    let individual = InspectedIndividual::at(&state, 0).unwrap();
    let view = MapView {
        heading: 0.7,
        variant: 1,
        columns: 31,
        rows: 23,
    };
    let map = run.experiment.policy_map(individual, view);
    assert_eq!(map, run.experiment.policy_map(individual, view));
    assert_eq!(map.cells.len(), 31 * 23);
    // A robot of radius 75 has no room within 75 of the outer walls.
    assert!((0..31).all(|column| map.cell(column, 0).is_none()));
    assert!(map.cell(31, 5).is_none() && map.cell(3, 23).is_none());
    let types: Vec<_> = map
        .cells
        .iter()
        .flatten()
        .map(|c| c.state_type.number())
        .collect();
    assert!(types.contains(&3) && types.contains(&4));
    assert!(
        types.iter().all(|number| [3, 4].contains(number)),
        "carrying"
    );
    let empty_handed = MapView { variant: 0, ..view };
    assert_ne!(
        map.cells,
        run.experiment.policy_map(individual, empty_handed).cells
    );
    let [low, high] = map.values().unwrap();
    assert!(low < high);
    for cell in map.cells.iter().flatten() {
        assert!(cell.probability > 0.0 && cell.probability <= 1.0 + 1e-9);
    }
}

#[test]
fn profiles_cover_every_node_that_can_act() {
    let run = finished();
    let state = run.archive().latest().unwrap();
    let individual = InspectedIndividual::at(&state, 0).unwrap();
    let tree = individual.individual.hierarchy.tree();
    for node in 0..tree.nodes().len() {
        let profiles = run.experiment.profiles(individual, node);
        assert!(!profiles.is_empty(), "node {node}");
        for profile in &profiles {
            let rows = profile.down.as_ref().map_or(1, |down| down.len());
            let values = rows * profile.across.len();
            assert!(!profile.curves.is_empty());
            assert!(
                profile
                    .curves
                    .iter()
                    .all(|curve| curve.values.len() == values)
            );
            if profile.quantity == Quantity::Probability {
                for place in 0..values {
                    let sum: f32 = profile.curves.iter().map(|c| c.values[place]).sum();
                    assert!((sum - 1.0).abs() < 1e-5);
                }
            }
        }
    }
    assert!(
        run.experiment
            .profiles(individual, tree.nodes().len())
            .is_empty()
    );
}

#[test]
fn every_kept_generation_can_be_read() {
    let run = finished();
    let mut archive = run.archive();
    for _ in 0..2 {
        for record in &run.records {
            let state = archive.generation(record.generation).unwrap();
            let ids: Vec<_> = state
                .individuals
                .iter()
                .map(|individual| individual.id)
                .collect();
            let recorded: Vec<_> = record.individuals.iter().map(|ranked| ranked.id).collect();
            assert_eq!(ids, recorded);
        }
    }
    let latest = archive.latest().unwrap();
    assert_eq!(latest.generation, run.records.len() as u64);
}

#[test]
fn a_generation_that_was_not_kept_is_a_clear_error() {
    let run = Finished::new(short(&[]), Keep::Every(2));
    let error = run.archive().generation(3).unwrap_err().to_string();
    assert!(
        error.contains("generation 3") && error.contains("2, 4"),
        "{error}"
    );
    let none = Finished::new(short(&[]), Keep::None);
    let error = none.archive().generation(1).unwrap_err().to_string();
    assert!(error.contains("the latest"), "{error}");
    let last = none.records.len() as u64;
    assert_eq!(none.archive().generation(last).unwrap().generation, last);
}

#[test]
fn errors_name_files_that_are_damaged_or_of_another_run() {
    let run = finished();
    let kept = run.path().join("generations").join("000002.json");
    let other = lasting_experiment(short(&[]), SEED + 1).unwrap();
    let mut archive = Archive::new(other, &run.path(), None);
    let error = archive.generation(2).unwrap_err();
    assert!(matches!(error, ArchiveError::File(_)), "{error}");
    assert!(error.to_string().contains("000002.json: seed"), "{error}");
    let text = fs::read_to_string(&kept).unwrap();
    fs::write(
        &kept,
        text.replacen("\"generation\":2", "\"generation\":1", 1),
    )
    .unwrap();
    let error = run.archive().generation(2).unwrap_err();
    assert!(error.to_string().contains("000002.json: crc32"), "{error}");
    let empty = tempfile::tempdir().unwrap();
    let nothing = Archive::new(run.experiment, Path::new(empty.path()), None);
    assert!(matches!(
        nothing.latest(),
        Err(ArchiveError::Nothing { .. })
    ));
}

#[test]
fn the_latest_population_of_a_live_run_comes_from_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let scenario = short(&[]);
    let run = start(scenario.clone(), SEED, &path, &threads(1)).unwrap();
    let experiment = lasting_experiment(scenario, SEED).unwrap();
    let archive = Archive::new(
        experiment,
        Path::new("/nowhere"),
        Some(run.controls.clone()),
    );
    let seen = run.events.iter().find_map(|event| match event {
        Event::Generation(record) if record.generation == 2 => Some(record.generation),
        _ => None,
    });
    assert!(archive.latest().unwrap().generation >= seen.unwrap());
    run.join().unwrap();
}

#[test]
fn lineages_reach_back_to_the_start() {
    let run = finished();
    let last = run.records.last().unwrap();
    for ranked in &last.individuals {
        let lineage = lineage(&run.records, ranked.id).unwrap();
        let line: Vec<_> = lineage.line().collect();
        assert_eq!(line[0].id, ranked.id);
        assert_eq!(line[0].tree, ranked.tree);
        assert!(line.windows(2).all(|pair| pair[1].born < pair[0].born));
        let first = line.last().unwrap();
        assert_eq!((first.born, &first.origin), (1, &Origin::HandCoded));
        for ancestor in lineage.ancestors.values() {
            assert!(
                ancestor.origin != Origin::Reproduced,
                "born, not reproduced"
            );
            let parents = ancestor.parents();
            assert!(parents.iter().all(|id| lineage.ancestors.contains_key(id)));
        }
    }
    assert!(lineage(&run.records, 1 << 40).is_none());
}

#[test]
fn inspection_leaves_the_run_unchanged() {
    let run = finished();
    let before = common::Record::of(&run.path());
    let state = run.archive().latest().unwrap();
    let copy = (*state).clone();
    let individual = InspectedIndividual::at(&state, 1).unwrap();
    run.experiment.rollout(individual, 5, None).advance(1000);
    let _ = run.experiment.selection(individual);
    let _ = run.experiment.profiles(individual, 0);
    assert!(*state == copy);
    common::Record::of(&run.path()).assert_same(&before, "after looking");
}

/// Commands and Recall have no learned values, and no profiles that would pretend so.
#[test]
fn commands_and_imitations_have_nothing_learned() {
    let told = |scenario, name| {
        let experiment = experiment(Scenario::load(scenario).unwrap(), 1).unwrap();
        let subtask = experiment.catalogue().find(name).unwrap();
        experiment.nothing_learned(subtask)
    };
    assert_eq!(
        told("environment-4", "Back").unwrap(),
        "always executes (-300,-300); it has nothing to choose and learns nothing"
    );
    assert_eq!(
        told("environment-4", "Recall").unwrap(),
        "has no values of its own; where the place is remembered, it acts as ApproachBattery in \
         state type 1 and as ApproachNest in state type 3, else as Wander"
    );
    for name in ["Avoid", "Turn", "Capture"] {
        assert_eq!(told("environment-4", name), None);
    }
    assert_eq!(told("taxi", "Pickup"), None);
}

/// The line of descent has a mean in every generation, the last one that of the individual.
#[test]
fn the_course_of_a_line_ends_with_the_individual() {
    let run = Finished::new(short(&[]), Keep::All);
    let best = &run.records.last().unwrap().individuals[0];
    let lineage = lineage(&run.records, best.id).unwrap();
    let course = lineage.course(&run.records);
    let generations: Vec<_> = course.iter().map(|&(generation, _)| generation).collect();
    let all = run.records.iter().map(|record| record.generation);
    assert_eq!(generations, all.collect::<Vec<_>>());
    assert_eq!(course.last().unwrap().1, best.mean_steps());
    let first = lineage.line().last().unwrap();
    let trials = best.scored() as f64;
    assert_eq!(course[0].1, first.fitness_steps as f64 / trials);
}
