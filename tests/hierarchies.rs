//! Contract: hierarchies are read, written, compared and checked as
//! `src/hierarchy/README.md` says.
//!
//! A hierarchy is the genome. A rule that is too strict closes paths of evolution; one that is
//! too loose lets in trees that cannot run. A canonical form that separates equal structures
//! keeps runs from converging; one that confuses different structures ends them too soon. So
//! thousands of random trees are compared with a second copy of the rules (`trees`), and every
//! rule has an accepted and a rejected example.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod trees;

use maxq_lab::hierarchy::{
    Glyphs, Summary, able, canonical, check, draw, folded_lines, lines, parse,
    structural_difference, to_dot, to_text,
};
use maxq_lab::worlds::World;
use maxq_lab::worlds::foraging::ForagingWorld;
use proptest::prelude::*;
use rand::RngExt;
use std::collections::BTreeMap;
use std::sync::LazyLock;
use trees::{MAXIMUM_DEPTH, Nested, chance, changed_tree, valid_tree, world};

static WORLD: LazyLock<ForagingWorld> = LazyLock::new(world);

/// Thesis Figure 4.2: all subtasks.
const COMPLETE: &str = "(Root (Capture (FindBattery Avoid Wander) \
    (VisibleBattery Avoid Wander ApproachBattery Turn)) (Deliver (FindNest Avoid Wander) \
    (VisibleNest Avoid Wander ApproachNest Turn)))";

fn difference(a: &str, b: &str) -> i64 {
    let catalogue = WORLD.catalogue();
    let [a, b] = [a, b].map(|text| parse(text, catalogue).unwrap());
    structural_difference(&a, &b, catalogue)
}

/// The structural difference computed a second way, from pairs of parent and primitive child.
fn difference_by_definition(a: &Nested, b: &Nested) -> i64 {
    let composites = |tree: &Nested| -> BTreeMap<&str, BTreeMap<&str, i64>> {
        let composites = tree
            .nodes()
            .into_iter()
            .filter(|n| trees::is_composite(n.name));
        composites
            .map(|node| {
                let mut counts = BTreeMap::new();
                for child in node
                    .children
                    .iter()
                    .filter(|c| !trees::is_composite(c.name))
                {
                    *counts.entry(child.name).or_default() += 1;
                }
                (node.name, counts)
            })
            .collect()
    };
    let (a, b) = (composites(a), composites(b));
    let names: std::collections::BTreeSet<_> = a.keys().chain(b.keys()).collect();
    let mut cost = 0;
    for name in names {
        let weight = if ["Capture", "Deliver"].contains(name) {
            4
        } else {
            2
        };
        cost += weight * i64::from(a.contains_key(name) != b.contains_key(name));
        for primitive in ["Avoid", "Wander", "ApproachBattery", "ApproachNest", "Turn"] {
            let count = |tree: &BTreeMap<&str, BTreeMap<&str, i64>>| {
                let children = tree.get(name).and_then(|counts| counts.get(primitive));
                children.copied().unwrap_or(0)
            };
            cost += (count(&a) - count(&b)).abs();
        }
    }
    -cost
}

/// Returns a text with random white space between its words.
fn spaced(text: &str, seed: u64) -> String {
    let mut rng = chance(seed);
    let mut space = |least: usize| -> String {
        let count = rng.random_range(least..4);
        (0..count)
            .map(|_| [' ', '\t', '\n', '\r'][rng.random_range(0..4)])
            .collect()
    };
    let mut out = space(0);
    for c in text.chars() {
        match c {
            '(' | ')' => out += &format!("{}{c}{}", space(0), space(0)),
            ' ' => out += &space(1),
            letter => out.push(letter),
        }
    }
    out + &space(0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_written_hierarchy_can_be_read_again(seed in any::<u64>(), spaces in any::<u64>()) {
        let catalogue = WORLD.catalogue();
        let nested = valid_tree(&mut chance(seed));
        let tree = nested.tree(catalogue);
        prop_assert_eq!(to_text(&tree, catalogue), nested.text());
        let read = parse(&spaced(&nested.text(), spaces), catalogue).unwrap();
        prop_assert_eq!(&read, &tree);
        prop_assert_eq!(Nested::of(&read, catalogue), nested);
    }

    #[test]
    fn the_canonical_structure_ignores_the_order_of_children_and_nothing_else(
        seed in any::<u64>(),
    ) {
        let catalogue = WORLD.catalogue();
        let mut rng = chance(seed);
        let nested = valid_tree(&mut rng);
        let form = |nested: &Nested| canonical(&nested.tree(catalogue), catalogue);
        let shuffled = nested.shuffled(&mut rng);
        prop_assert_eq!(form(&nested), form(&shuffled));
        // With a primitive subtask renamed it is another structure, unless a sibling
        // compensates.
        let mut other = shuffled;
        let place = rng.random_range(0..other.nodes().len());
        let node = other.node_mut(place);
        if node.children.is_empty() {
            node.name = ["Avoid", "Wander", "Turn"][rng.random_range(0..3)];
        } else {
            node.children.rotate_left(1);
        }
        let same = nested.sorted() == other.sorted();
        prop_assert_eq!(form(&nested) == form(&other), same);
        let stranger = valid_tree(&mut rng);
        let same = nested.sorted() == stranger.sorted();
        prop_assert_eq!(form(&nested) == form(&stranger), same);
    }

    #[test]
    fn the_structural_difference_is_that_of_the_definition(seed in any::<u64>()) {
        let catalogue = WORLD.catalogue();
        let mut rng = chance(seed);
        let (a, b) = (valid_tree(&mut rng), valid_tree(&mut rng));
        let of = |a: &Nested, b: &Nested| {
            structural_difference(&a.tree(catalogue), &b.tree(catalogue), catalogue)
        };
        prop_assert_eq!(of(&a, &b), difference_by_definition(&a, &b));
        prop_assert_eq!(of(&a, &b), of(&b, &a));
        prop_assert_eq!(of(&a, &a.shuffled(&mut rng)), 0);
        let c = valid_tree(&mut rng);
        prop_assert!(of(&a, &c) >= of(&a, &b) + of(&b, &c), "the triangle inequality holds");
    }

    #[test]
    fn the_typing_rules_agree_with_their_second_copy(seed in any::<u64>()) {
        let catalogue = WORLD.catalogue();
        let mut rng = chance(seed);
        for nested in [valid_tree(&mut rng), changed_tree(&mut rng), changed_tree(&mut rng)] {
            let checked = check(&nested.tree(catalogue), catalogue, MAXIMUM_DEPTH);
            prop_assert_eq!(checked.is_ok(), nested.obeys_the_rules(), "{} {:?}", nested.text(), checked);
        }
    }

    #[test]
    fn a_subtask_can_act_where_it_is_active_and_a_child_can_act(seed in any::<u64>()) {
        let catalogue = WORLD.catalogue();
        let nested = valid_tree(&mut chance(seed));
        let able = able(&nested.tree(catalogue), catalogue);
        prop_assert_eq!(able.len(), nested.nodes().len());
        for (able, node) in able.into_iter().zip(nested.nodes()) {
            let found: Vec<_> = able.iter().map(|t| t.number() as u8).collect();
            let expected: Vec<_> = (1..=4).filter(|&t| node.can_act(t)).collect();
            prop_assert_eq!(found, expected, "{}", node.text());
        }
    }

    #[test]
    fn summaries_count_subtasks(seed in any::<u64>()) {
        let catalogue = WORLD.catalogue();
        let nested = valid_tree(&mut chance(seed));
        let summary = Summary::of(&nested.tree(catalogue), catalogue);
        let nodes = nested.nodes();
        let composites = nodes.iter().filter(|node| trees::is_composite(node.name)).count();
        prop_assert_eq!(summary.composites, composites);
        prop_assert_eq!((summary.depth, &summary.tree), (nested.depth(), &nested.text()));
        let order = ["Avoid", "Wander", "ApproachBattery", "ApproachNest", "Turn"];
        let present = order.into_iter().filter(|name| nodes.iter().any(|n| n.name == *name));
        prop_assert_eq!(summary.primitives, present.collect::<Vec<_>>());
        for (state_type, found) in (1..).zip(summary.primitives_by_state_type) {
            let reached = order.into_iter().filter(|name| reaches(&nested, name, state_type));
            prop_assert_eq!(found, reached.collect::<Vec<_>>());
        }
    }
}

/// Returns whether a walk down from here can end in a primitive subtask in a state type.
fn reaches(node: &Nested, primitive: &str, state_type: u8) -> bool {
    let below = || {
        node.children
            .iter()
            .any(|child| reaches(child, primitive, state_type))
    };
    node.can_act(state_type) && (node.name == primitive || below())
}

/// Thesis Figure 4.6: -4 -2 -2 -1 -1 -1 -1 -1 -1. The trees of the figure are lost; these
/// have the same sum.
#[test]
fn the_example_of_figure_4_6_is_14_apart() {
    let a = "(Root (Capture (FindBattery Avoid Wander) (VisibleBattery ApproachBattery)) \
        (Deliver Wander ApproachNest))";
    let b = "(Root Wander ApproachBattery (Deliver Wander Wander ApproachNest))";
    assert_eq!(difference(a, b), -14);
    assert_eq!(difference(b, a), -14);
    assert_eq!(difference(a, a), 0);
}

#[test]
fn weights_are_those_of_the_levels() {
    let base = "(Root Wander ApproachBattery ApproachNest)";
    let with = |more: &str| format!("(Root Wander ApproachBattery ApproachNest {more})");
    assert_eq!(difference(base, &with("(Capture Wander)")), -5);
    assert_eq!(difference(base, &with("(Deliver Wander)")), -5);
    assert_eq!(difference(base, &with("(FindBattery Wander)")), -3);
    assert_eq!(difference(base, &with("(VisibleNest Wander Wander)")), -4);
    assert_eq!(difference(base, &with("Turn")), -1);
    assert_eq!(difference(base, &with("Wander Wander")), -2);
}

/// Each rule with an accepted and a rejected tree.
#[test]
fn every_rule_accepts_or_rejects_with_a_reason() {
    let catalogue = WORLD.catalogue();
    let result = |text: &str, depth| {
        let tree = parse(text, catalogue).unwrap();
        check(&tree, catalogue, depth).map_err(|error| error.to_string())
    };
    for (accepted, rejected, why) in [
        (
            "(Root (Capture Wander) Wander)",
            "(Capture Wander)",
            "the root is Capture; allowed: Root",
        ),
        (
            "(Root Wander (Capture Wander))",
            "(Root Wander (Root Wander))",
            "Root stands below itself; allowed: only at the top",
        ),
        (
            "(Root Wander (Capture Wander))",
            "(Root Wander Capture)",
            "Capture has no children; allowed: at least one",
        ),
        (
            "(Root Wander Avoid)",
            "(Root (Wander Avoid))",
            "Wander has children; allowed: none, it is a primitive subtask",
        ),
        (
            "(Root Wander (VisibleBattery ApproachBattery))",
            "(Root Wander (FindBattery ApproachBattery))",
            "ApproachBattery (active in state types 2) under FindBattery (active in 1); \
             allowed: a child active somewhere where its parent is",
        ),
        (
            // Turn is active in 2 and 4. A primitive child only has to share a state type.
            "(Root Wander (VisibleNest Turn))",
            "(Root Wander (FindNest Turn))",
            "Turn (active in state types 2,4) under FindNest (active in 3); \
             allowed: a child active somewhere where its parent is",
        ),
        (
            "(Root Wander (Capture (FindBattery Wander)))",
            "(Root Wander (FindBattery (Capture Wander)))",
            "Capture (active in state types 1,2) under FindBattery (active in 1); \
             allowed: a composite child active only where its parent is",
        ),
        (
            "(Root Wander (Capture Wander Wander) (FindBattery Wander))",
            "(Root Wander (Capture (FindBattery Wander)) (FindBattery Wander))",
            "FindBattery occurs more than once; allowed: every composite subtask at most once",
        ),
        (
            "(Root Wander ApproachBattery ApproachNest)",
            "(Root ApproachBattery ApproachNest)",
            "nothing can act in state types 1,3; allowed: a root that can act in all of them",
        ),
        (
            "(Root (Capture Wander) (Deliver Avoid))",
            "(Root (Capture (VisibleBattery Wander)) (Deliver Avoid))",
            "nothing can act in state types 1; allowed: a root that can act in all of them",
        ),
    ] {
        assert_eq!(result(accepted, MAXIMUM_DEPTH), Ok(()), "{accepted}");
        assert_eq!(
            result(rejected, MAXIMUM_DEPTH),
            Err(why.to_owned()),
            "{rejected}"
        );
    }
    assert_eq!(result(COMPLETE, 4), Ok(()));
    let too_deep = "the depth is 4; allowed: 2 to 3, the root counted";
    assert_eq!(result(COMPLETE, 3), Err(too_deep.to_owned()));
}

#[test]
fn malformed_text_is_an_error_that_names_the_place() {
    let error = |text: &str| parse(text, WORLD.catalogue()).unwrap_err().to_string();
    assert!(error("(Root Wonder)").starts_with("at byte 6: found \"Wonder\"; allowed: a subtask"));
    assert!(error("(Root Wander").starts_with("at byte 12: found the end of the text"));
    assert!(error("(Root Wander))").starts_with("at byte 13: found \")\"; allowed: the end"));
    assert!(error("Wander").starts_with("at byte 0: found \"Wander\"; allowed: '('"));
    assert!(error("()").starts_with("at byte 1: found \")\""));
    assert!(error("").starts_with("at byte 0: found the end"));
    assert!(error(&"(Root ".repeat(1000)).contains("allowed: at most 4096"));
}

#[test]
fn drawings_of_hierarchies_match_their_snapshots() {
    let catalogue = WORLD.catalogue();
    let tree = parse(COMPLETE, catalogue).unwrap();
    let flat = parse("(Root Wander Wander Turn)", catalogue).unwrap();
    insta::with_settings!({
        snapshot_path => "../snapshots",
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        insta::assert_snapshot!("hierarchy_dot", to_dot(&tree, catalogue));
        let unicode = draw(&tree, catalogue, Glyphs::Unicode).join("\n");
        insta::assert_snapshot!("hierarchy_unicode", unicode);
        let ascii = draw(&tree, catalogue, Glyphs::Ascii).join("\n");
        insta::assert_snapshot!("hierarchy_ascii", ascii);
        let flat = draw(&flat, catalogue, Glyphs::Unicode).join("\n");
        insta::assert_snapshot!("hierarchy_flat", flat);
    });
}

/// Every node keeps its place: keys and clicks go from node to node in folded lines too.
#[test]
fn primitive_siblings_share_lines() {
    let world = world();
    let catalogue = world.catalogue();
    let text = "(Root (Capture Avoid Wander ApproachBattery Turn) ApproachNest Avoid)";
    let tree = parse(text, catalogue).unwrap();
    let name = |node: usize| tree.subtask(node).name(catalogue).to_owned();
    let folded = folded_lines(&tree, catalogue, Glyphs::Unicode, 36, name);
    let drawn = folded.iter().map(|line| {
        let texts = line.nodes.iter().map(|text| text.text.as_str());
        line.branches.clone() + &texts.collect::<Vec<_>>().join("  ")
    });
    assert_eq!(
        drawn.collect::<Vec<_>>(),
        [
            "Root",
            "├─ Capture",
            "│  └─ Avoid  Wander  ApproachBattery",
            "│     Turn",
            "└─ ApproachNest  Avoid",
        ]
    );
    assert_eq!(folded[2].at(13), Some(3), "Wander");
    assert_eq!(folded[2].at(2), Some(2), "the first");
    assert!(folded[3].has(5) && !folded[2].has(5));
    assert_eq!(lines(&tree, catalogue, Glyphs::Ascii).len(), 8);
}
