//! A study has the same bytes however it is done: without a break or interrupted at any moment
//! and resumed, one run at a time or in parallel, in any order. Every arm does what its name says.
//!
//! Why it matters: claims rest on hundreds of runs that no machine does in one session. If a run
//! depended on what was done before it, nobody could check its numbers.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::Duration;

use common::{SHORT, output, program, stderr, stdout};
use maxq_lab::evolution::Origin;
use maxq_lab::lab::{Event, Keep, RunFolder, read_events};
use maxq_lab::report::{
    Arm, Base, Facts, Plan, Reevaluation, RunState, StatusWatch, Study, StudyControls, StudyEvent,
    StudyRun, run_study, status,
};
use maxq_lab::scenario::EMBEDDED;

fn plan(arms: &[Base]) -> Plan {
    let arm = |base: &Base| Arm {
        settings: SHORT.iter().map(|&setting| setting.to_owned()).collect(),
        ..Arm::of(*base)
    };
    let arms = arms.iter().map(arm).collect();
    let mut plan = Plan::of(&[String::from("smoke")], "1..2".parse().unwrap(), arms).unwrap();
    plan.reevaluation = Reevaluation {
        warmup: 1,
        trials: 2,
        repeats: 4,
        primitive_sets: 2,
    };
    plan
}

fn two() -> NonZeroUsize {
    NonZeroUsize::new(2).unwrap()
}

fn do_all(study: &Study) {
    let controls = StudyControls::default();
    run_study(
        study,
        &study.runs(),
        two(),
        Keep::None,
        &controls,
        |event| {
            if let StudyEvent::Failed { error, .. } = event {
                panic!("{error}");
            }
        },
    );
}

/// Returns whether the bytes of a file depend on the plan alone.
fn depends_on_the_plan_alone(name: &str) -> bool {
    let names = [
        "study.json",
        "events.jsonl",
        "checkpoint.json",
        "evaluation.json",
    ];
    names.contains(&name)
}

fn assert_same(one: &Path, other: &Path) {
    common::assert_same_files(one, other, depends_on_the_plan_alone);
}

#[test]
fn an_interrupted_study_and_one_in_another_order_have_the_same_bytes() {
    let parent = tempfile::tempdir().unwrap();
    let plan = plan(&[Base::Evolved, Base::RandomSearch, Base::HandDesigned]);
    let whole = Study::create(plan.clone(), &parent.path().join("whole")).unwrap();
    do_all(&whole);

    let broken = Study::create(plan.clone(), &parent.path().join("broken")).unwrap();
    for milliseconds in [0, 20, 50, 90, 140] {
        let controls = StudyControls::default();
        thread::scope(|scope| {
            scope.spawn(|| {
                thread::sleep(Duration::from_millis(milliseconds));
                controls.stop();
            });
            run_study(
                &broken,
                &broken.runs(),
                two(),
                Keep::None,
                &controls,
                |_| {},
            );
        });
    }
    do_all(&broken);
    assert_same(&whole.folder, &broken.folder);

    // Here the arms with a matched budget come before the evolved run.
    let reverse = Study::create(plan, &parent.path().join("reverse")).unwrap();
    let mut runs = reverse.runs();
    runs.reverse();
    let controls = StudyControls::default();
    run_study(&reverse, &runs, two(), Keep::None, &controls, |_| {});
    assert_same(&whole.folder, &reverse.folder);
    assert!(
        status(&reverse)
            .iter()
            .all(|status| status.stage == RunState::Done)
    );
}

#[test]
fn a_study_that_is_killed_and_then_done_by_two_processes_has_the_same_bytes() {
    let parent = tempfile::tempdir().unwrap();
    let plan = plan(&[Base::Evolved, Base::RandomSelection]);
    let whole = Study::create(plan.clone(), &parent.path().join("whole")).unwrap();
    do_all(&whole);
    let killed = Study::create(plan, &parent.path().join("killed")).unwrap();
    let command = || {
        let mut command = program();
        command.arg("study").arg(killed.folder.join("study.json"));
        command
            .arg("--out")
            .arg(&killed.folder)
            .args(["--jobs", "2"]);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    for milliseconds in [30, 60, 90, 120] {
        let mut process = command().spawn().unwrap();
        thread::sleep(Duration::from_millis(milliseconds));
        process.kill().unwrap();
        process.wait().unwrap();
    }
    let mut both = [command().spawn().unwrap(), command().spawn().unwrap()];
    for process in &mut both {
        assert!(process.wait().unwrap().success());
    }
    assert!(
        status(&killed)
            .iter()
            .all(|status| status.stage == RunState::Done)
    );
    assert_same(&whole.folder, &killed.folder);
}

#[test]
fn every_arm_does_what_its_name_says() {
    let parent = tempfile::tempdir().unwrap();
    let study = Study::create(plan(&Base::ALL), parent.path()).unwrap();
    do_all(&study);
    let mut trials = BTreeMap::new();
    for run in study.runs().into_iter().filter(|run| run.seed == 1) {
        let base = study.arm(&run).base;
        let folder = study.run_folder(&run);
        let events = read_events(&folder.join("events.jsonl")).unwrap();
        let records: Vec<_> = events
            .into_iter()
            .filter_map(|event| match event {
                Event::Generation(record) => Some(record),
                _ => None,
            })
            .collect();
        // Reproduced individuals have half of the trials.
        let individuals = records.iter().flat_map(|record| &record.individuals);
        let lived: usize = individuals
            .clone()
            .map(|individual| {
                if individual.origin == Origin::Reproduced {
                    1
                } else {
                    2
                }
            })
            .sum();
        trials.insert(base.name(), (records.len(), lived));
        let scenario = RunFolder::read_manifest(&folder).unwrap().scenario;
        let complete = "(Root (Capture (FindBattery Avoid Wander) (VisibleBattery Avoid Wander \
                        ApproachBattery Turn)) (Deliver (FindNest Avoid Wander) (VisibleNest Avoid \
                        Wander ApproachNest Turn)))";
        let flat = "(Root Avoid Wander ApproachBattery ApproachNest Turn)";
        match base {
            Base::HandDesigned => assert!(individuals.clone().all(|i| i.tree == complete)),
            Base::Flat => assert!(individuals.clone().all(|i| i.tree == flat)),
            Base::RandomSearch => {
                let fresh = |o: &Origin| matches!(o, Origin::Random | Origin::Reproduced);
                assert!(individuals.clone().all(|i| fresh(&i.origin)));
            }
            Base::NoLearningInheritance => {
                for individual in individuals {
                    if let Origin::Crossover { inherited, .. } = &individual.origin {
                        assert!(inherited.is_empty());
                    }
                }
            }
            Base::RandomSelection => {
                let sorted = |r: &maxq_lab::evolution::GenerationRecord| {
                    r.individuals.is_sorted_by_key(|i| i.fitness_steps)
                };
                assert!(!records.iter().all(|record| sorted(record)));
            }
            Base::RandomChoice => {
                assert_ne!(
                    scenario.learning,
                    maxq_lab::scenario::LearningSettings::default()
                );
            }
            Base::Evolved => {}
        }
    }
    assert_eq!(trials["random_search"], trials["evolved"], "as many trials");
    assert_eq!(
        trials["hand_designed"].0, trials["evolved"].0,
        "as many generations"
    );
    assert_eq!(trials["flat"], trials["hand_designed"]);
}

#[test]
fn a_look_reads_only_what_has_changed() {
    let parent = tempfile::tempdir().unwrap();
    let study = Study::create(plan(&[Base::Evolved]), parent.path()).unwrap();
    let [run, other] = study.runs()[..] else {
        panic!("two seeds")
    };
    let mut watch = StatusWatch::of(&study);
    let mut states = || {
        let looked = watch.look();
        looked.iter().map(|status| status.stage).collect::<Vec<_>>()
    };
    assert_eq!(states(), [RunState::Waiting, RunState::Waiting]);
    do_all(&study);
    assert_eq!(states(), [RunState::Done, RunState::Done]);

    // The damaged file has the old size and time, so only reading it would show the damage.
    let file = study.run_folder(&run).join("evaluation.json");
    let before = fs::metadata(&file).unwrap();
    fs::write(&file, " ".repeat(before.len().try_into().unwrap())).unwrap();
    let opened = fs::File::options().write(true).open(&file).unwrap();
    opened.set_modified(before.modified().unwrap()).unwrap();
    assert_eq!(states(), [RunState::Done, RunState::Done]);
    assert_eq!(status(&study)[0].stage, RunState::Unreadable);
    fs::remove_file(&file).unwrap();

    // A run whose evolution has not ended is followed from where it was.
    let folder = study.run_folder(&other);
    for later in ["summary.json", "evaluation.json", "checkpoint.json"] {
        fs::remove_file(folder.join(later)).unwrap();
    }
    let log = folder.join("events.jsonl");
    let whole = fs::read_to_string(&log).unwrap();
    let lines: Vec<_> = whole.split_inclusive('\n').collect();
    let mut look_after = |lived: usize| {
        // The start of the run is a line too.
        fs::write(&log, lines[..=lived].concat()).unwrap();
        let looked = watch.look().remove(1);
        assert_eq!(looked.generations, lived as u64);
        assert_eq!(looked.best_steps.len(), lived);
        looked.stage
    };
    assert_eq!(look_after(2), RunState::Interrupted);
    assert_eq!(look_after(4), RunState::Interrupted);
    assert_eq!(
        look_after(3),
        RunState::Interrupted,
        "some of it was cut off"
    );
    fs::write(&log, &whole).unwrap();
    do_all(&study);
    let ends = watch.look().into_iter().map(|status| status.stage);
    assert!(ends.eq([RunState::Done, RunState::Done]));
}

#[test]
fn a_run_is_done_only_as_the_run_of_this_plan() {
    let parent = tempfile::tempdir().unwrap();
    let mut changed = plan(&[Base::Evolved]);
    let study = Study::create(changed.clone(), parent.path()).unwrap();
    do_all(&study);
    let stages =
        |study: &Study| -> Vec<_> { status(study).into_iter().map(|run| run.stage).collect() };
    assert_eq!(stages(&study), [RunState::Done, RunState::Done]);

    // A damaged log: the checkpoint holds its checksum.
    let log = study.run_folder(&study.runs()[0]).join("events.jsonl");
    let whole = fs::read_to_string(&log).unwrap();
    fs::write(&log, whole.replacen("\"rank\":1", "\"rank\":9", 1)).unwrap();
    let damaged = status(&study).remove(0);
    assert_eq!(damaged.stage, RunState::Unreadable);
    assert!(
        damaged
            .trouble
            .unwrap()
            .contains("events.jsonl: found CRC-32")
    );
    assert!(Facts::read(&study, &study.runs()[0]).is_err());
    fs::write(&log, whole).unwrap();

    // A plan that was edited after its runs.
    changed.scenarios[0].learning.discount = 0.5;
    fs::write(parent.path().join("study.json"), changed.to_file().unwrap()).unwrap();
    let edited = Study::open(parent.path()).unwrap();
    for run in status(&edited) {
        assert_eq!(run.stage, RunState::Unreadable);
        assert!(run.trouble.unwrap().contains("holds another run"));
    }
    let controls = StudyControls::default();
    for run in edited.runs() {
        let run = StudyRun {
            study: &edited,
            run,
            keep: Keep::None,
            controls: &controls,
        };
        let error = run.finish().unwrap_err().to_string();
        assert!(error.contains("holds another run"), "{error}");
    }
}

#[test]
fn every_arm_fits_every_embedded_scenario() {
    let names: Vec<_> = EMBEDDED
        .iter()
        .map(|embedded| embedded.name.to_owned())
        .collect();
    let arms: Vec<_> = Base::ALL.map(Arm::of).to_vec();
    let plan = Plan::of(&names, "1".parse().unwrap(), arms).unwrap();
    assert_eq!(plan.scenarios.len(), EMBEDDED.len());
}

#[test]
fn what_is_added_to_a_study_is_all_that_is_done() {
    let parent = tempfile::tempdir().unwrap();
    let at = |name: &str| parent.path().join(name);
    let mut whole = plan(&[Base::Evolved, Base::Flat]);
    whole.seeds = "1..3".parse().unwrap();
    let mut grown = Study::create(plan(&[Base::Evolved]), &at("grown")).unwrap();
    do_all(&grown);
    let first = grown.run_folder(&grown.runs()[0]).join("summary.json");
    let before = fs::read(&first).unwrap();

    // The refusal of a larger plan names the command, unless arms have settings.
    let mut larger = grown.plan.clone();
    larger.seeds = whole.seeds.clone();
    let said = Study::create(larger, &at("grown")).unwrap_err().to_string();
    assert!(said.contains("seeds is 1..2 there, 1..3 here"), "{said}");
    let command = format!("maxq-lab study add {} --seeds 1..3", at("grown").display());
    assert!(said.contains(&command), "{said}");
    let said = Study::create(whole.clone(), &at("grown")).unwrap_err();
    assert!(!said.to_string().contains("study add"), "{said}");

    let flat = whole.arms[1].clone();
    let more = "3".parse().unwrap();
    assert_eq!(grown.add(Some(&more), vec![flat.clone()]).unwrap(), 4);
    assert_eq!(grown.add(Some(&more), vec![flat.clone()]).unwrap(), 0);
    assert_eq!(Study::open(&at("grown")).unwrap().plan, whole);
    let other = Arm {
        settings: Vec::new(),
        ..flat
    };
    let error = grown.add(None, vec![other]).unwrap_err().to_string();
    assert!(
        error.contains("arm flat: found another arm of this name"),
        "{error}"
    );

    do_all(&grown);
    assert_eq!(fs::read(&first).unwrap(), before, "it was not done again");
    do_all(&Study::create(whole, &at("whole")).unwrap());
    assert_same(&at("grown"), &at("whole"));
}

#[test]
fn a_study_takes_no_folder_of_another_plan_and_no_run_of_another_study() {
    let parent = tempfile::tempdir().unwrap();
    let study = Study::create(plan(&[Base::Evolved]), parent.path()).unwrap();
    let error = Study::create(plan(&[Base::Flat]), parent.path()).unwrap_err();
    let said = error.to_string();
    for part in [
        "holds the study of another plan: arms.evolved is {",
        "arms.flat is nothing there, {",
        "allowed: another folder",
    ] {
        assert!(said.contains(part), "{part:?} is not in {said}");
    }
    assert_eq!(Study::open(parent.path()).unwrap(), study);

    let run = study.runs()[0];
    let other = common::short(&["learning.discount=0.5"]);
    common::run_in(&study.run_folder(&run), &other, 1, &common::threads(1));
    fs::remove_file(study.run_folder(&run).join("summary.json")).unwrap();
    let mut failed = Vec::new();
    let failures = std::sync::Mutex::new(&mut failed);
    run_study(
        &study,
        &[run],
        two(),
        Keep::None,
        &StudyControls::default(),
        |event| {
            if let StudyEvent::Failed { error, .. } = event {
                failures.lock().unwrap().push(error.to_string());
            }
        },
    );
    assert!(failed[0].contains("holds another run"), "{failed:?}");
}

/// An evaluation with another protocol, or of another hierarchy, is not the one of the plan.
#[test]
fn an_evaluation_of_another_plan_is_refused_until_it_is_removed() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("study");
    let study = Study::create(plan(&[Base::Evolved]), &folder).unwrap();
    do_all(&study);
    let run = study.runs()[0];
    let path = study.run_folder(&run).join("evaluation.json");
    let made = fs::read_to_string(&path).unwrap();
    let expected = Facts::read(&study, &run).unwrap();
    for (part, other, what) in [
        (
            "\"warmup\":1",
            "\"warmup\":0",
            "warmup: found 0; allowed: 1",
        ),
        ("\"seed\":", "\"seed\":1", "seed: found 1"),
        (
            "\"tree\":\"(Root ",
            "\"tree\":\"(Root Wander ",
            "tree: found another",
        ),
        ("\"bank\":1", "\"bank\":0", "banks: found 1; allowed: 2"),
    ] {
        let changed = made.replace(part, other);
        assert_ne!(changed, made, "{part}");
        fs::write(&path, changed).unwrap();
        let error = Facts::read(&study, &run).unwrap_err().to_string();
        assert!(
            error.contains(what) && error.contains("evaluation.json"),
            "{error}"
        );
    }
    fs::remove_file(&path).unwrap();
    do_all(&study);
    assert_eq!(fs::read_to_string(&path).unwrap(), made);
    assert_eq!(Facts::read(&study, &run).unwrap(), expected);
}

#[test]
fn the_command_does_a_plan_and_its_errors_say_what_is_allowed() {
    let parent = tempfile::tempdir().unwrap();
    let file = parent.path().join("plan.json");
    let settings: Vec<_> = SHORT.iter().map(|setting| format!("{setting:?}")).collect();
    let text = |name: &str| {
        format!(
            r#"{{"format":1,"name":"{name}","scenarios":["smoke"],"seeds":"1..2",
                "arms":["evolved",{{"name":"short","settings":[{}]}}],
                "reevaluation":{{"warmup":0,"trials":1,"repeats":2,"banks":1}}}}"#,
            settings.join(",")
        )
    };
    fs::write(&file, text("mine")).unwrap();
    let out = parent.path().join("out");
    let study = || {
        let mut command = program();
        command.arg("study").arg(&file).arg("--out").arg(&out);
        command
    };
    let one = output(study().args(["--only", "smoke/short/seed-2"]));
    assert!(
        stdout(&one).starts_with("1 of 1 runs done"),
        "{}",
        stderr(&one)
    );
    let checked = output(program().arg("check").arg(&file).arg("thesis"));
    assert_eq!(
        stdout(&checked).matches(": valid").count(),
        2,
        "{}",
        stderr(&checked)
    );
    let status = output(program().args(["study", "status"]).arg(&out));
    assert!(
        stdout(&status).starts_with("mine: 4 runs, 1 done, 3 waiting"),
        "{}",
        stdout(&status)
    );

    for (change, expected) in [
        (
            "\"evolved\"",
            "arms[0]: found \"evoluted\"; allowed: evolved, random_selection",
        ),
        ("\"smoke\"", "scenarios[0]: no scenario \"smoked\""),
        ("\"seeds\":\"1..2\"", "at seeds: found \"2..1\"; allowed"),
    ] {
        let wrong = expected.split('"').nth(1).unwrap_or_default();
        let new = match change {
            "\"seeds\":\"1..2\"" => String::from("\"seeds\":\"2..1\""),
            _ => format!("\"{wrong}\""),
        };
        fs::write(&file, text("mine").replace(change, &new)).unwrap();
        let refused = output(&mut study());
        assert_eq!(refused.status.code(), Some(1));
        assert!(stderr(&refused).contains(expected), "{}", stderr(&refused));
    }
}
