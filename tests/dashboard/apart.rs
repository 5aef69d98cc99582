//! The views of one individual: inspector, policy map, trial stepper, comparison.

use maxq_lab::dashboard::Effect;
use maxq_lab::hierarchy::Glyphs::{Ascii, Unicode};
use maxq_lab::learning::Exit;

use super::frames::{LARGE, MIDDLE, SMALL, assert_shots};
use super::recorded::{Screen, cells, foraging};

fn screen() -> Screen {
    foraging().screen("dark", Unicode, MIDDLE)
}

#[test]
fn the_views_of_an_individual() {
    let shots = [
        ("stepper_80x24_dark", "dark", Unicode, SMALL, "t . ."),
        ("stepper_120x40_dark", "dark", Unicode, MIDDLE, "t . . ."),
        ("stepper_200x60_light", "light", Unicode, LARGE, "t . . ."),
        ("stepper_80x24_ascii", "mono", Ascii, SMALL, "t . . , ,"),
        ("stepper_120x40_mono", "mono", Unicode, MIDDLE, "t ."),
        ("inspector_80x24_dark", "dark", Unicode, SMALL, "i j"),
        ("inspector_80x24_ascii", "mono", Ascii, SMALL, "i tab tab"),
        ("inspector_80x24_selection", "dark", Unicode, SMALL, "i tab"),
        ("inspector_120x40_dark", "dark", Unicode, MIDDLE, "i v j j"),
        (
            "inspector_200x60_contrast",
            "high-contrast",
            Unicode,
            LARGE,
            "i G",
        ),
        ("map_80x24_dark", "dark", Unicode, SMALL, "m left left"),
        ("map_80x24_ascii", "mono", Ascii, SMALL, "m j"),
        ("map_120x40_values", "dark", Unicode, MIDDLE, "m v"),
        ("compare_80x24_dark", "dark", Unicode, SMALL, "[ [ [ c j j"),
        (
            "compare_120x40_ascii",
            "mono",
            Ascii,
            MIDDLE,
            "[ [ [ [ c M j",
        ),
    ];
    assert_shots(foraging(), [2.0, 0.1], &shots);
}

#[test]
fn individuals_of_other_worlds() {
    let shots = [
        ("stepper_taxi", "dark", Unicode, MIDDLE, "t . ."),
        ("inspector_taxi", "dark", Unicode, MIDDLE, "i j"),
        ("map_taxi", "dark", Unicode, MIDDLE, "m j"),
    ];
    assert_shots(&cells("taxi"), [0.0, 0.1], &shots);
}

/// Trial and number of the shown step.
fn shown(screen: &Screen) -> (u64, u64) {
    let text = screen.text();
    let after = |word: &str| -> u64 {
        let rest = text.split(word).nth(1).unwrap_or_else(|| panic!("{text}"));
        let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
        digits.parse().unwrap()
    };
    (after("trial "), after(" step "))
}

#[test]
fn keys_step_forward_and_back_through_a_trial() {
    let mut screen = screen();
    screen.press("t .");
    let (trial, step) = shown(&screen);
    screen.press(". . .");
    assert_eq!(shown(&screen), (trial, step + 3));
    screen.press(", ,");
    assert_eq!(shown(&screen), (trial, step + 1));
    assert!(screen.text().contains("2 steps back"));
    // Forward through the recorded steps, then on to new ones.
    screen.press(". .");
    assert_eq!(shown(&screen), (trial, step + 3));
    screen.press(".");
    assert_eq!(shown(&screen), (trial, step + 4));
    screen.wait(3.0);
    assert_eq!(shown(&screen), (trial, step + 4), "it is halted");
    screen.press("N .");
    assert_eq!(shown(&screen), (trial + 1, 1));
}

/// Steps of an earlier trial cannot be mistaken for steps of this one.
#[test]
fn the_steps_of_an_earlier_trial_are_below_its_number() {
    let mut screen = screen();
    screen.press("t . . . N . .");
    let text = screen.text();
    let steps = text.split("earlier steps").nth(1).unwrap();
    let lines: Vec<_> = steps.lines().skip(1).collect();
    let has = |line: usize, words: &str| {
        assert!(
            lines[line].contains(words),
            "{words} in line {line} of\n{text}"
        );
    };
    has(0, " 1  type");
    has(1, " trial 1 ");
    has(2, " 3  type");
}

/// An earlier step is shown with the trail up to it, not with later positions.
#[test]
fn the_trail_is_that_of_the_step_shown() {
    let mut screen = screen();
    screen.press("t . . . .");
    let player = &screen.0.app().context().player;
    let whole = player.trail(0);
    for back in 0..4 {
        let (trail, step) = (player.trail(back), player.trace(back).unwrap());
        assert_eq!(trail.len(), step.step as usize + 1);
        assert_eq!(trail[..], whole[..trail.len()]);
        assert_eq!(trail.last(), Some(&step.after.at));
    }
    // Of an ended trial the recorded positions remain.
    screen.press("N .");
    let player = &screen.0.app().context().player;
    assert_eq!(player.trail(0).len(), 2);
    assert_eq!(player.trail(1).last(), whole.last());
}

/// In an earlier generation, every caption names individual and generation.
#[test]
fn captions_name_individual_and_generation() {
    let mut screen = screen();
    screen.press("[ [ space");
    let subject = screen.0.app().context().player.subject().unwrap();
    let (id, generation) = (subject.id, subject.generation);
    assert_eq!(generation, 4);
    for (keys, caption) in [
        ("1", format!("id {id}, gen {generation}")),
        ("t .", format!("individual {id}, generation {generation}")),
        ("i", format!("individual {id}, generation {generation}")),
        ("m", format!("individual {id}, generation {generation}")),
        ("c", format!("individual {id}, generation {generation}")),
    ] {
        screen.press(keys);
        assert!(
            screen.text().contains(&caption),
            "{caption} in\n{}",
            screen.text()
        );
    }
}

#[test]
fn every_part_of_a_step_is_on_the_screen() {
    let mut screen = screen();
    screen.press("t .");
    let trace = screen.0.app().context().player.trace(0).unwrap().clone();
    let text = screen.text();
    let catalogue = foraging().experiment.catalogue();
    let tree = screen.0.app().context().player.tree().unwrap().clone();
    let name = |node: usize| tree.subtask(node).name(catalogue);
    for level in &trace.explanation.levels {
        assert!(text.contains(name(level.node)));
        for choice in &level.choices {
            for value in [choice.preference(), choice.value, choice.c_tilde, choice.c] {
                let number = format!("{value:.3}").replace("-0.000", "0.000");
                assert!(text.contains(&number), "{number} in\n{text}");
            }
        }
    }
    for update_trace in &trace.explanation.update_traces {
        let told = format!(
            "{} updates {}",
            name(update_trace.node),
            name(update_trace.child)
        );
        assert!(text.contains(&told), "{told} in\n{text}");
        if let Exit::PseudoReward(reward) = update_trace.exit {
            assert!(text.contains(&format!("pseudo-reward {reward}")));
        }
        assert!(text.contains(&format!("N {}", update_trace.updates[0].steps)));
    }
    assert!(text.contains(&format!("reward {:.3}", trace.explanation.reward)));
}

#[test]
fn the_map_changes_heading_and_load() {
    let mut screen = screen();
    screen.press("m");
    let at_first = screen.text();
    assert!(at_first.contains("heading 0") && at_first.contains("empty-handed"));
    screen.press("left down");
    let turned = screen.text();
    assert!(turned.contains("heading 15") && turned.contains("carrying"));
    screen.press("right up");
    assert_eq!(screen.text(), at_first);
    screen.press("v");
    assert!(screen.text().contains("V(root)"));
}

#[test]
fn the_marked_individual_is_what_others_are_compared_with() {
    let mut screen = screen();
    screen.press("6 j j j M");
    let marked = screen.0.app().context().selected().unwrap().id;
    screen.press("b c");
    assert_eq!(screen.0.app().context().rivals().unwrap()[1].id, marked);
    let text = screen.text();
    assert!(
        text.contains(&format!("individual {marked}, generation 6")),
        "{text}"
    );
    assert!(text.contains("marked: rank"), "{text}");
    // The marked individual is not compared with itself.
    screen.press("j j j");
    assert_eq!(screen.0.app().context().selected().unwrap().id, marked);
    assert_ne!(screen.0.app().context().rivals().unwrap()[1].id, marked);
}

fn exported(screen: &mut Screen, keys: &str) -> String {
    let effects = screen.press(keys);
    let export = effects.into_iter().find_map(|effect| match effect {
        Effect::Export(export) => Some(export.contents),
        _ => None,
    });
    export.unwrap_or_else(|| panic!("{keys} exports nothing"))
}

#[test]
fn the_views_of_an_individual_can_be_exported() {
    let mut screen = screen();
    let head = |csv: &str| csv.lines().next().unwrap().to_owned();
    for (view, columns, least) in [
        ("t .", "trial,step,node,subtask,item,quantity,value", 20),
        (
            "i",
            "quantity,state_type,across,at,down,at_down,of,value",
            6,
        ),
        ("m", "x,y,state_type,primitive,probability,value", 100),
        ("c", "individual,rank,node,parent,subtask,only_here", 6),
    ] {
        screen.press(view);
        let csv = exported(&mut screen, "e c");
        assert_eq!(head(&csv), columns);
        assert!(csv.lines().count() > least, "{view}: {csv}");
    }
    for view in ["t", "i", "c"] {
        screen.press(view);
        assert!(exported(&mut screen, "e d").starts_with("digraph hierarchy"));
    }
    screen.press("i tab");
    assert!(exported(&mut screen, "e c").starts_with("state_type,primitive,probability"));
    screen.press("tab");
    assert!(exported(&mut screen, "e c").starts_with("id,born,last_seen,rank"));
    assert!(exported(&mut screen, "e d").starts_with("digraph lineage"));
}
