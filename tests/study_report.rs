//! A report states what the runs show and no more. An effect that exists is found; one that does
//! not exist is attributed to drift or left undecided. Every number has its n, every table is plain
//! CSV, every table and figure says what it was made from, and the same runs give the same bytes.
//!
//! Why it matters: people quote these verdicts without looking at the runs.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

use common::{output, program, short, stderr, stdout, threads};
use maxq_lab::report::figures::{FigureNumber, Panel, RunSource};
use maxq_lab::report::{
    Arm, Base, Facts, Findings, FreshFacts, GenerationFacts, JudgedClaim, Plan, Study, Verdict,
    Winner,
};

const SEEDS: u64 = 30;

/// Creates a study of the thesis's environments, whose runs are invented.
fn study(folder: &Path) -> Study {
    let scenarios = ["environment-1", "environment-2", "environment-3"].map(str::to_owned);
    let arms = [Base::Evolved, Base::RandomSelection, Base::HandDesigned].map(Arm::of);
    let plan = Plan::of(&scenarios, "1..30".parse().unwrap(), arms.to_vec()).unwrap();
    Study::create(plan, folder).unwrap()
}

/// Invents a run, whose winner is minimal or not and has a given trial length on fresh trials.
fn facts(
    study: &Study,
    scenario: usize,
    arm: usize,
    seed: u64,
    minimal: bool,
    steps: f64,
) -> Facts {
    let run = study
        .runs()
        .into_iter()
        .find(|run| (run.scenario, run.arm, run.seed) == (scenario, arm, seed))
        .unwrap();
    let names = |names: &[&str]| {
        names
            .iter()
            .map(|&name| name.to_owned())
            .collect::<Vec<_>>()
    };
    let second = if minimal {
        names(&["ApproachBattery"])
    } else {
        names(&["ApproachBattery", "Wander"])
    };
    let moment = |best: f64, difference: f64| GenerationFacts {
        best_steps: best,
        middle_steps: 2.0 * best,
        difference,
        policy_change: 0.1,
    };
    Facts {
        run,
        version: String::from("0.0.0 (made up)"),
        generations: 10,
        converged: true,
        control_steps: 1000,
        winner: Winner {
            tree: String::from("(Root Wander ApproachBattery ApproachNest)"),
            structure: String::from("(Root ApproachBattery ApproachNest Wander)"),
            composites: names(&["Root"]),
            primitives: names(&["Wander", "ApproachBattery", "ApproachNest"]),
            selectable: vec![
                names(&["Wander"]),
                second,
                names(&["Wander"]),
                names(&["ApproachNest"]),
            ],
            forages: true,
        },
        course: (0..10).map(|g| moment(200.0, f64::from(g) - 9.0)).collect(),
        later: None,
        fresh: FreshFacts {
            steps,
            standard_error: Some(5.0),
            delivered_share: 1.0,
        },
    }
}

/// Invents the runs of all seeds, scenarios and arms. For each arm, `minimal` is the number of
/// minimal winners and `steps` their shortest trial length.
fn all(study: &Study, minimal: [u64; 3], steps: [f64; 3]) -> Vec<Facts> {
    let mut all = Vec::new();
    for seed in 1..=SEEDS {
        for scenario in 0..3 {
            for arm in 0..3 {
                let length = steps[arm] + seed as f64;
                all.push(facts(
                    study,
                    scenario,
                    arm,
                    seed,
                    seed <= minimal[arm],
                    length,
                ));
            }
        }
    }
    all
}

fn judged<'f>(findings: &'f Findings, claim: &str, scenario: &str) -> &'f JudgedClaim {
    let is = |judged: &&JudgedClaim| judged.claim == claim && judged.scenario == scenario;
    findings.claims.iter().find(is).unwrap()
}

#[test]
fn claims_are_tested_against_the_control() {
    let parent = tempfile::tempdir().unwrap();
    let study = study(parent.path());
    for (evolved, control, verdict) in [
        (28, 9, Verdict::Holds),
        (28, 27, Verdict::ByDriftAlone),
        (3, 9, Verdict::DoesNotHold),
        (16, 12, Verdict::Undecided),
    ] {
        let all = all(&study, [evolved, control, 0], [100.0, 200.0, 150.0]);
        let findings = Findings::from_facts(&study, &all);
        let found = judged(&findings, "one-primitive", "environment-1");
        assert_eq!((found.tested.shown, found.tested.n), (evolved, SEEDS));
        assert_eq!(found.control.unwrap().shown, control);
        assert_eq!(found.verdict, Some(verdict), "{evolved} against {control}");
    }
}

#[test]
fn a_claim_on_two_environments_is_paired_by_seed_and_needs_both() {
    let parent = tempfile::tempdir().unwrap();
    let study = study(parent.path());
    let mut all = all(&study, [SEEDS, SEEDS, 0], [100.0; 3]);
    // Environment 3 has more primitives in 29 seeds of the tested arm and in 2 of the control.
    for facts in &mut all {
        let grows = match facts.run.arm {
            0 => facts.run.seed > 1,
            _ => facts.run.seed <= 2,
        };
        if facts.run.scenario == 2 && grows {
            facts.winner.selectable[3].push(String::from("Avoid"));
        }
    }
    let findings = Findings::from_facts(&study, &all);
    let found = judged(&findings, "primitives-grow", "environment-1, environment-3");
    assert_eq!((found.tested.shown, found.control.unwrap().shown), (29, 2));
    assert_eq!(found.verdict, Some(Verdict::Holds));

    // A seed without environment 3 does not count.
    all.retain(|facts| facts.run.scenario != 2 || facts.run.seed > 10);
    let findings = Findings::from_facts(&study, &all);
    let found = judged(&findings, "primitives-grow", "environment-1, environment-3");
    assert_eq!(found.tested.n, 20);
}

/// Without selection, a seed leads to the same structures in every environment. A comparison within
/// one seed would never find a difference, and any difference under selection would look real.
#[test]
fn claims_across_environments_compare_different_seeds_of_the_control() {
    let parent = tempfile::tempdir().unwrap();
    let study = study(parent.path());
    let mut all = all(&study, [SEEDS, SEEDS, 0], [100.0; 3]);
    for facts in &mut all {
        if facts.run.arm != 0 && facts.run.seed <= 15 {
            facts.winner.selectable[3].push(String::from("Avoid"));
        }
    }
    let findings = Findings::from_facts(&study, &all);
    let found = judged(&findings, "primitives-grow", "environment-1, environment-3");
    // Environment 1 of seeds 29 and 30 is compared with environment 3 of seeds 1 and 2.
    assert_eq!((found.control.unwrap().shown, found.tested.shown), (2, 0));
}

#[test]
fn arms_are_compared_by_fresh_trials_paired_by_seed() {
    let parent = tempfile::tempdir().unwrap();
    let study = study(parent.path());
    let findings = Findings::from_facts(&study, &all(&study, [0; 3], [100.0, 150.0, 100.0]));
    let of = |scenario: &str, against: &str| {
        let is = |c: &&maxq_lab::report::Comparison| c.scenario == scenario && c.against == against;
        findings.comparisons.iter().find(is).unwrap()
    };
    let control = of("environment-2", "random_selection");
    let mean = control.difference_mean.unwrap();
    // Seeds differ by up to 29 steps, but all pairs by exactly 50.
    assert_eq!((mean.n, mean.value), (30, -50.0));
    let interval = mean.interval.unwrap();
    assert_eq!((interval.low, interval.high), (-50.0, -50.0));
    assert_eq!(control.improvement.value, 1.0);
    assert!(control.p.unwrap() < 1e-9);
    let same = of("environment-2", "hand_designed");
    assert_eq!((same.improvement.value, same.p), (0.5, Some(1.0)));
    assert_eq!(of("all", "random_selection").improvement.n, 90);
}

#[test]
fn a_single_seed_has_no_interval_and_decides_nothing() {
    let parent = tempfile::tempdir().unwrap();
    let study = study(parent.path());
    let one: Vec<_> = all(&study, [SEEDS; 3], [100.0; 3])
        .into_iter()
        .filter(|facts| facts.run.seed == 1)
        .collect();
    let findings = Findings::from_facts(&study, &one);
    assert!(
        findings
            .groups
            .iter()
            .flat_map(|group| &group.metrics)
            .all(|m| m.mean.interval.is_none())
    );
    assert!(
        findings
            .claims
            .iter()
            .all(|claim| claim.verdict == Some(Verdict::Undecided))
    );
    assert_eq!((findings.provenance.runs, findings.provenance.of), (9, 270));
    // Before any run is done, the provenance names no version.
    let nothing = Findings::from_facts(&study, &[]).provenance.line();
    let (before, command) = nothing.split_once("; ").unwrap();
    assert!(before.ends_with("0 of 270 runs, seeds 1..30"), "{nothing}");
    assert!(
        command.starts_with("maxq-lab study study.json --out "),
        "{nothing}"
    );
}

/// Returns the rows of a CSV text. Its first line says what made it, and all rows must have the
/// same number of fields.
fn rows(csv: &str) -> Vec<Vec<String>> {
    let (provenance, csv) = csv.split_once('\n').unwrap();
    assert!(
        provenance.starts_with("# ") && provenance.contains("maxq-lab "),
        "{provenance}"
    );
    let mut rows = vec![vec![String::new()]];
    let mut quoted = false;
    for c in csv.trim_end_matches('\n').chars() {
        let row = rows.last_mut().unwrap();
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => row.push(String::new()),
            '\n' if !quoted => rows.push(vec![String::new()]),
            c => row.last_mut().unwrap().push(c),
        }
    }
    for row in &rows {
        assert_eq!(row.len(), rows[0].len(), "{row:?}");
    }
    rows
}

fn succeeds(command: &mut Command) -> String {
    let done = output(command);
    assert!(done.status.success(), "{command:?}: {}", stderr(&done));
    stdout(&done)
}

#[test]
fn the_report_of_real_runs_repeats_and_reads_as_tables() {
    let parent = tempfile::tempdir().unwrap();
    let plan = parent.path().join("plan.json");
    let settings: Vec<_> = common::SHORT
        .iter()
        .map(|setting| format!("{setting:?}"))
        .collect();
    let arm = |base: &str| {
        format!(
            r#"{{"name":"{base}","base":"{base}","settings":[{}]}}"#,
            settings.join(",")
        )
    };
    let text = format!(
        r#"{{"format":1,"name":"small","scenarios":["smoke"],"seeds":"1..3","arms":[{},{}],
            "control":"random_selection",
            "reevaluation":{{"warmup":1,"trials":1,"repeats":2,"banks":1}}}}"#,
        arm("evolved"),
        arm("random_selection")
    );
    fs::write(&plan, text).unwrap();
    let out = parent.path().join("out");
    succeeds(program().arg("study").arg(&plan).arg("--out").arg(&out));
    let report = || {
        let text = succeeds(program().args(["study", "report"]).arg(&out));
        let folder = fs::read_dir(out.join("report")).unwrap();
        let mut files: Vec<_> = folder.map(|entry| entry.unwrap().path()).collect();
        files.sort();
        let read = |path| (fs::read_to_string(&path).unwrap(), path);
        (text, files.into_iter().map(read).collect::<Vec<_>>())
    };
    let (text, files) = report();
    assert_eq!((&text, &files), (&report().0, &report().1));
    assert!(text.contains("6 of 6 runs, seeds 1..3"), "{text}");
    for (content, path) in &files {
        let name = path.file_name().unwrap().to_str().unwrap();
        if name.ends_with(".csv") {
            let rows = rows(content);
            assert!(rows.len() > 1, "{name} has no row");
            assert!(rows[0].iter().all(|column| !column.is_empty()), "{name}");
        } else if name.ends_with(".svg") {
            let content = words(content);
            assert!(content.contains("seeds 1..3"), "{name} says what made it");
            for command in ["maxq-lab study study.json --out", "maxq-lab study report"] {
                assert!(content.contains(command), "{name}");
            }
            assert!(!content.contains("DIR"), "{name} has a placeholder");
        }
    }
    assert_eq!(files.len(), 7 + 2 * FigureNumber::ALL.len());

    let runs = rows(&succeeds(
        program().arg("export").arg(&out).args(["--format", "csv"]),
    ));
    assert_eq!(runs.len(), 7);
    let column = runs[0]
        .iter()
        .position(|name| name == "fresh_trial_steps")
        .unwrap();
    assert!(
        runs[1..]
            .iter()
            .all(|row| row[column].parse::<f64>().unwrap() > 0.0)
    );
    let json = succeeds(program().arg("export").arg(&out).args(["--format", "json"]));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["kinds"][0]["n"], 3);
}

/// Returns the words of an SVG image, whatever lines they are in.
fn words(svg: &str) -> String {
    let texts = svg.split('<').filter_map(|part| part.split_once('>'));
    let words: Vec<_> = texts
        .flat_map(|(_, text)| text.split_whitespace())
        .collect();
    words.join(" ")
}

#[test]
fn every_figure_of_a_run_is_drawn_with_its_provenance() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    common::run_in(&folder, &short(&[]), 7, &threads(1));
    let source = RunSource::read(&folder).unwrap();
    let at = folder.display().to_string();
    for number in FigureNumber::ALL {
        let figure = source.figure(number, "svg").unwrap();
        let svg = figure.svg().unwrap();
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
        let text = figure.text(80);
        let made_by = format!(
            "maxq-lab export {at} --format svg --figure {}",
            number.name()
        );
        assert!(text.trim_end().ends_with(&made_by), "{text}");
        for drawn in [words(&svg), words(&format!("<>{text}"))] {
            for part in [
                "smoke with ",
                "evolution.generation_limit=6",
                "seed 7",
                &made_by,
            ] {
                assert!(drawn.contains(part), "{part} in figure {}", number.name());
            }
        }
        assert!(rows(&figure.table().csv()).len() > 1);
    }
    // A line for every rank of the better half, a point for every generation.
    let performance = source.figure(FigureNumber::F4_8, "csv").unwrap().table();
    assert_eq!(performance.rows.len(), 4 * source.records.len());
    // Actions of ApproachBattery, ApproachNest and Turn.
    let values = source.figure(FigureNumber::F4_3, "svg").unwrap();
    assert_eq!(values.panels.len(), 3);
    assert!(values.svg().unwrap().contains("angle (deg)"));
    // Probabilities are comparable between panels: one scale, and one mark for each subtask.
    let mut marks = std::collections::BTreeMap::new();
    for panel in source.figure(FigureNumber::F4_10, "svg").unwrap().panels {
        let Panel::Chart(chart) = panel else {
            panic!("a hierarchy")
        };
        assert_eq!(chart.y_range, Some([0.0, 1.0]));
        for series in chart.series {
            let known = *marks.entry(series.name.clone()).or_insert(series.mark);
            assert_eq!(known, series.mark, "{}", series.name);
        }
    }
    assert!(marks.len() > 2, "{marks:?}");
    let best = source.records.last().unwrap().individuals[0].tree.clone();
    let dot = succeeds(
        program()
            .arg("export")
            .arg(&folder)
            .args(["--format", "dot"]),
    );
    assert_eq!(
        dot.matches("[shape=").count(),
        best.split_whitespace().count()
    );
}

#[test]
fn exports_say_what_is_allowed() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    common::run_in(&folder, &short(&[]), 1, &threads(1));
    for (arguments, expected) in [
        (
            &["--format", "svg"][..],
            "with --format svg or text; allowed: 4.3, 4.5",
        ),
        (
            &["--format", "dot", "--figure", "4.8"],
            "found dot with --figure; allowed",
        ),
        (
            &["--format", "svg", "--figure", "4.6"],
            "allowed: 4.3, 4.5, 4.7",
        ),
    ] {
        let refused = output(program().arg("export").arg(&folder).args(arguments));
        assert!(!refused.status.success());
        assert!(stderr(&refused).contains(expected), "{}", stderr(&refused));
    }
    let nothing = output(
        program()
            .arg("export")
            .arg(parent.path())
            .args(["--format", "csv"]),
    );
    assert!(
        stderr(&nothing).contains("run.json"),
        "{}",
        stderr(&nothing)
    );
}
