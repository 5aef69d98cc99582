//! Runs with the options beyond the thesis: transparent walls, memory, commands, persistence,
//! values of leaving, replay.

use std::sync::OnceLock;

use maxq_lab::hierarchy::Glyphs::{self, Ascii, Unicode};
use maxq_lab::lab::inspection::StepTrace;
use maxq_lab::learning::Exit;
use maxq_lab::scenario::Scenario;

use super::common;
use super::frames::{LARGE, MIDDLE, SMALL, assert_looks};
use super::recorded::{Recorded, Screen};

/// A short run of environment 4.
pub fn remembering() -> &'static Recorded {
    static RUN: OnceLock<Recorded> = OnceLock::new();
    RUN.get_or_init(|| {
        let settings = common::SHORT.iter().map(|&setting| setting.into());
        let last = String::from("evolution.generation_limit=2");
        let settings: Vec<_> = settings.chain([last]).collect();
        let scenario = Scenario::load("environment-4").unwrap();
        Recorded::new(&scenario.with_settings(&settings).unwrap())
    })
}

/// Returns a dashboard in which the nest is remembered behind the robot's back.
fn reminded(theme: &str, glyphs: Glyphs, size: (u16, u16)) -> Screen {
    let start = "carrying with memory at 1500,700 heading 200";
    let start = remembering().experiment.read_start(start).unwrap();
    let mut screen = remembering().screen_from(Some(start), theme, glyphs, size);
    screen.press("r space . .");
    screen
}

/// Selects the individual of the first generation with this hierarchy, and halts its rollout.
fn select(screen: &mut Screen, tree: &str) {
    screen.press("<");
    screen.wait(0.1);
    let record = screen.0.app().context().shown().unwrap().clone();
    let mut individuals = record.individuals.iter();
    let rank = individuals.position(|individual| individual.tree == tree);
    screen.press("6 g");
    for _ in 0..rank.unwrap() {
        screen.press("j");
    }
    screen.wait(0.1);
    screen.press("space");
}

const TEN_CHILDREN: &str = "(Root Wander Recall ApproachBattery ApproachNest Forward Left Right \
                            HardLeft HardRight SpinLeft Back)";
const LARGEST: &str = "(Root (Capture (FindBattery Wander Forward Left Right SpinLeft Back Recall) \
                       (VisibleBattery Avoid Wander ApproachBattery Turn)) (Deliver (FindNest Avoid \
                       Wander Recall) (VisibleNest Avoid Wander ApproachNest Turn)))";
const DEEP: &str = "(Root (Capture (FindBattery Wander Recall) (VisibleBattery ApproachBattery)) \
                    (Deliver (FindNest Wander Recall) (VisibleNest ApproachNest)))";

#[test]
fn the_arena_shows_transparent_walls_and_the_remembered_place() {
    for (name, theme, glyphs, size) in [
        ("memory_arena_80x24_dark", "dark", Unicode, SMALL),
        ("memory_arena_120x40_mono", "mono", Unicode, MIDDLE),
        ("memory_arena_80x24_ascii", "mono", Ascii, SMALL),
        ("memory_arena_200x60_light", "light", Unicode, LARGE),
    ] {
        let mut screen = reminded(theme, glyphs, size);
        screen.press("2");
        let context = screen.0.app().context();
        let snapshot = context.player.rollout().unwrap().snapshot();
        assert!(snapshot.remembers.is_some() && snapshot.sees.is_none());
        let signs = context.look.signs;
        assert!(screen.text().contains(signs.remembered));
        assert_looks(name, &screen);
    }
}

#[test]
fn the_stepper_shows_what_is_recalled() {
    let mut screen = reminded("dark", Unicode, SMALL);
    screen.press("t .");
    let text = screen.text();
    for reading in ["recalled angle", "recalled distance"] {
        let line = text.lines().find(|line| line.contains(reading)).unwrap();
        let value = line.split(reading).nth(1).unwrap().trim_start();
        assert!(value.starts_with(|c: char| c == '-' || c.is_ascii_digit()));
    }
}

/// Every subtask is on the screen, in the views of one hierarchy and in the overview.
#[test]
fn many_children_share_lines() {
    for (name, size, tree, keys) in [
        ("memory_hierarchy_80x24", SMALL, LARGEST, "3"),
        ("memory_hierarchy_120x40", MIDDLE, TEN_CHILDREN, "3"),
        ("memory_hierarchy_200x60", LARGE, LARGEST, "3"),
        ("memory_overview_80x24", SMALL, TEN_CHILDREN, "1"),
        ("memory_inspector_80x24", SMALL, LARGEST, "i"),
    ] {
        let mut screen = remembering().screen("dark", Unicode, size);
        select(&mut screen, tree);
        screen.press(keys);
        screen.wait(0.1);
        assert_looks(name, &screen);
        let text = screen.text();
        let subtasks = tree.replace(['(', ')'], "");
        for subtask in subtasks.split(' ') {
            let wanted = subtasks.split(' ').filter(|&other| other == subtask);
            let shown = text.matches(subtask).count();
            assert!(shown >= wanted.count(), "{name}: {subtask} in\n{text}");
        }
    }
}

/// Keys go from subtask to subtask in folded lines too.
#[test]
fn subtasks_of_folded_lines_can_be_selected() {
    let mut screen = remembering().screen("dark", Unicode, SMALL);
    select(&mut screen, LARGEST);
    screen.press("3 j j j j");
    let context = screen.0.app().context();
    let tree = context.inspected_tree().unwrap();
    assert_eq!(tree.subtask(4).name(context.catalogue()), "Forward");
    let text = screen.text();
    assert!(text.contains("Forward: give one command"), "{text}");
    screen.press("i");
    let text = screen.text();
    assert!(text.contains("Forward always executes (600,600)"), "{text}");
    screen.press("G k k k k k");
    let text = screen.text().replace(['│', '\n'], " ");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("Recall has no values of its own"), "{text}");
}

/// Takes steps until one has what is wanted.
fn step_until(screen: &mut Screen, wanted: impl Fn(&StepTrace) -> bool) {
    for _ in 0..2000 {
        screen.press(".");
        if screen
            .0
            .app()
            .context()
            .player
            .trace(0)
            .is_some_and(&wanted)
        {
            return;
        }
    }
    panic!("no step has it");
}

#[test]
fn the_stepper_explains_persistence_values_of_leaving_and_replay() {
    let exits = |trace: &StepTrace| {
        let mut updates = trace.explanation.update_traces.iter();
        trace.ended.is_none()
            && updates.any(|update| {
                let Exit::Continuation { ancestor, .. } = update.exit else {
                    return false;
                };
                ancestor.is_some()
            })
    };
    let mut screen = remembering().screen("dark", Unicode, MIDDLE);
    select(&mut screen, DEEP);
    screen.press("t");
    step_until(&mut screen, exits);
    let text = screen.text();
    assert!(text.contains("exit worth "), "{text}");
    assert_looks("memory_stepper_120x40_exit", &screen);

    step_until(&mut screen, |trace| !trace.explanation.replayed.is_empty());
    assert!(screen.text().contains("the trial is replayed"));
    screen.0.update(maxq_lab::dashboard::Input::Resize(200, 60));
    assert_looks("memory_stepper_200x60_replay", &screen);

    let mut screen = remembering().screen("dark", Unicode, SMALL);
    select(&mut screen, TEN_CHILDREN);
    screen.press("t");
    step_until(&mut screen, |trace| trace.explanation.action.step == 2);
    let text = screen.text();
    assert!(text.contains(", step 2 of 3"), "{text}");
    assert_looks("memory_stepper_80x24_persistence", &screen);
}

#[test]
fn the_inspector_draws_learning_curves() {
    let mut screen = remembering().screen("dark", Unicode, SMALL);
    screen.press("2 + + + + + + i");
    screen.wait(4.0);
    screen.press("shift-tab");
    let lengths = screen.0.app().context().player.rollout().unwrap().status();
    let means = lengths.lengths.means();
    assert!(means.len() > 2);
    let text = screen.text();
    for steps in [means[0].1, means[means.len() - 1].1] {
        assert!(text.contains(&format!("{steps:.1}")), "{steps}: {text}");
    }
    let individual = screen.0.app().context().selected().unwrap();
    let steps = individual.mean_steps();
    assert!(text.contains(&format!("now {steps:.1}")), "{text}");
    assert_looks("memory_curve_80x24", &screen);
    screen.0.update(maxq_lab::dashboard::Input::Resize(120, 40));
    assert_looks("memory_curve_120x40", &screen);
}

#[test]
fn many_primitive_subtasks_fit_into_policy_and_map() {
    for (name, size, keys) in [
        ("memory_policy_80x24", SMALL, "5"),
        ("memory_policy_map_80x24", SMALL, "m j j"),
    ] {
        let mut screen = remembering().screen("dark", Unicode, size);
        screen.press(keys);
        assert_looks(name, &screen);
    }
}
