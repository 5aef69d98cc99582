//! Typed crossover with Lamarckian inheritance.

use std::collections::{BTreeMap, BTreeSet};

use maxq_lab::evolution::{Individual, Inherited, Origin, Parent, crossover};
use maxq_lab::hierarchy::{parse, to_text};
use maxq_lab::learning::{CompositeValues, Hierarchy};
use maxq_lab::random::{Purpose, stream};
use maxq_lab::scenario::{Inheritance, LearningSettings, Reset, Scenario};
use maxq_lab::worlds::{Catalogue, World};
use proptest::prelude::*;

use super::trees::{Nested, chance, is_composite, valid_tree, world};
use super::{assert_frequencies, learned};

pub fn nested(individual: &Individual, catalogue: &Catalogue) -> Nested {
    Nested::of(individual.hierarchy.tree(), catalogue)
}

/// Both trees after their subtrees at these places in preorder are swapped.
fn swapped(a: &Nested, b: &Nested, [place_a, place_b]: [usize; 2]) -> [Nested; 2] {
    let (mut a, mut b) = (a.clone(), b.clone());
    std::mem::swap(a.node_mut(place_a), b.node_mut(place_b));
    [a, b]
}

/// All pairs of sites that lead to two valid offspring.
fn valid_pairs(a: &Nested, b: &Nested) -> Vec<[usize; 2]> {
    let places = |tree: &Nested| 1..tree.nodes().len();
    let pairs = places(a).flat_map(|i| places(b).map(move |j| [i, j]));
    pairs
        .filter(|&pair| swapped(a, b, pair).iter().all(Nested::obeys_the_rules))
        .collect()
}

/// The learned values of an individual by subtask; composites occur once.
pub fn values<'i>(
    individual: &'i Individual,
    catalogue: &'i Catalogue,
) -> BTreeMap<&'i str, &'i CompositeValues> {
    let tree = individual.hierarchy.tree();
    let values = individual.hierarchy.values().iter().enumerate();
    values
        .filter_map(|(node, value)| Some((tree.subtask(node).name(catalogue), value.as_ref()?)))
        .collect()
}

/// Names of the composites from the parent of a place up to the root.
pub fn path(tree: &Nested, place: usize) -> BTreeSet<&'static str> {
    fn walk(node: &Nested, place: usize, at: &mut usize, above: &mut Vec<&'static str>) -> bool {
        if *at == place {
            return true;
        }
        *at += 1;
        above.push(node.name);
        let found = node
            .children
            .iter()
            .any(|child| walk(child, place, at, above));
        if !found {
            above.pop();
        }
        found
    }
    let mut above = Vec::new();
    assert!(walk(tree, place, &mut 0, &mut above));
    above.into_iter().collect()
}

/// The parent of a place in preorder, and which of its children stands there.
pub fn parent_of(tree: &Nested, place: usize) -> (&'static str, usize) {
    let nodes = tree.nodes();
    let child: *const Nested = nodes[place];
    let of = |node: &&Nested| {
        let mut children = node.children.iter();
        let at = children.position(|other| std::ptr::eq(other, child));
        at.map(|at| (node.name, at))
    };
    nodes.iter().find_map(of).unwrap()
}

/// Asserts that a composite subtask has kept all that it had learned, but what it knows of the
/// child at a place, which is new.
pub fn assert_only_new(
    found: &CompositeValues,
    old: &CompositeValues,
    new: &CompositeValues,
    place: usize,
) -> Result<(), TestCaseError> {
    let mut expected = old.vectors();
    let new = new.vectors().remove(place);
    if old.children() == found.children() {
        expected[place] = new;
    } else {
        expected.insert(place, new);
    }
    prop_assert_eq!(found.vectors(), expected);
    prop_assert_eq!(found.temperature, old.temperature);
    Ok(())
}

fn site(origin: &Origin) -> (&Parent, &Parent, &[Inherited], &[String]) {
    match origin {
        Origin::Crossover {
            receiver,
            donor,
            inherited,
            reset,
            ..
        } => (receiver, donor, inherited, reset),
        other => panic!("{other:?} is no crossover"),
    }
}

/// Checks an offspring of `receiver` that got its subtree from `donor`.
fn check_offspring(
    child: &Individual,
    [receiver, donor]: [&Individual; 2],
    scenario: &Scenario,
    catalogue: &Catalogue,
) -> Result<(), TestCaseError> {
    let darwinian = scenario.evolution.inheritance == Inheritance::Darwinian;
    let only_child = scenario.evolution.reset == Reset::Child;
    let (to, from, inherited, reset) = site(&child.origin);
    let (old, given) = (nested(receiver, catalogue), nested(donor, catalogue));
    prop_assert_eq!((to.id, from.id), (receiver.id, donor.id));
    prop_assert_eq!(&to.subtask, old.nodes()[to.site].name);
    prop_assert_eq!(&from.subtask, given.nodes()[from.site].name);
    let [expected, _] = swapped(&old, &given, [to.site, from.site]);
    let tree = nested(child, catalogue);
    prop_assert_eq!(&tree, &expected);

    let on_path = if only_child {
        BTreeSet::new()
    } else {
        path(&tree, to.site)
    };
    let (above, place) = parent_of(&tree, to.site);
    let graft: BTreeSet<_> = given.nodes()[from.site]
        .nodes()
        .iter()
        .map(|n| n.name)
        .collect();
    let (found, old, given) = (
        values(child, catalogue),
        values(receiver, catalogue),
        values(donor, catalogue),
    );
    let composites = tree
        .nodes()
        .into_iter()
        .filter(|node| is_composite(node.name));
    let (mut expected_inherited, mut expected_reset) = (Vec::new(), Vec::new());
    for node in composites {
        let name = node.name;
        let subtask = catalogue.find(name).unwrap();
        let children = node
            .children
            .iter()
            .map(|child| catalogue.find(child.name).unwrap());
        let children: Vec<_> = children.collect();
        let new = CompositeValues::new(subtask, &children, catalogue, &LearningSettings::default());
        if darwinian || on_path.contains(name) {
            expected_reset.push(name.to_owned());
            prop_assert_eq!(found[name], &new);
        } else {
            let (parent, from) = match graft.contains(name) {
                true => (given[name], donor.id),
                false => (old[name], receiver.id),
            };
            if only_child && name == above {
                assert_only_new(found[name], parent, &new, place)?;
            } else {
                prop_assert_eq!(found[name], parent, "{} has lost what it had learned", name);
            }
            expected_inherited.push(Inherited {
                subtask: name.to_owned(),
                from,
            });
        }
    }
    prop_assert_eq!(inherited, expected_inherited);
    prop_assert_eq!(reset, expected_reset);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn offspring_are_valid_whole_and_keep_what_they_should(
        seed in any::<u64>(),
        darwinian in any::<bool>(),
        only_child in any::<bool>(),
    ) {
        let mut scenario = Scenario::load("environment-1").unwrap();
        if only_child {
            scenario.evolution.reset = Reset::Child;
        }
        if darwinian {
            scenario.evolution.inheritance = Inheritance::Darwinian;
        }
        let world = &*WORLD;
        let catalogue = world.catalogue();
        let mut rng = chance(seed);
        let mut parent = |id| learned(id, valid_tree(&mut rng).tree(catalogue), catalogue, &mut rng);
        let (a, b) = (parent(7), parent(3));
        let (tree_a, tree_b) = (nested(&a, catalogue), nested(&b, catalogue));
        let mut draws = stream(seed, 0, 0, Purpose::Breeding);
        let Some([first, second]) = crossover(&a, &b, [20, 21], &scenario, catalogue, &mut draws)
        else {
            // 200 draws found nothing: then there is little to find.
            let pairs = (tree_a.nodes().len() - 1) * (tree_b.nodes().len() - 1);
            let share = valid_pairs(&tree_a, &tree_b).len() as f64 / pairs as f64;
            prop_assert!(share < 0.1, "{} of the pairs are valid", share);
            return Ok(());
        };
        prop_assert_eq!((first.id, second.id), (20, 21));
        check_offspring(&first, [&a, &b], &scenario, catalogue)?;
        check_offspring(&second, [&b, &a], &scenario, catalogue)?;
        let (new_a, new_b) = (nested(&first, catalogue), nested(&second, catalogue));
        prop_assert!(new_a.obeys_the_rules(), "{}", new_a.text());
        prop_assert!(new_b.obeys_the_rules(), "{}", new_b.text());
        let (to, from, ..) = site(&first.origin);
        let (to_too, from_too, ..) = site(&second.origin);
        prop_assert!(to == from_too && from == to_too, "one swap makes both");
        let all = |x: &Nested, y: &Nested| {
            let mut names: Vec<_> = x.nodes().iter().chain(&y.nodes()).map(|n| n.name).collect();
            names.sort_unstable();
            names
        };
        prop_assert_eq!(all(&tree_a, &tree_b), all(&new_a, &new_b));
    }
}

pub static WORLD: std::sync::LazyLock<maxq_lab::worlds::foraging::ForagingWorld> =
    std::sync::LazyLock::new(world);

#[test]
fn every_valid_pair_of_sites_is_as_likely_as_any_other() {
    let scenario = Scenario::load("environment-1").unwrap();
    let catalogue = WORLD.catalogue();
    let mut rng = chance(1);
    let [a, b] = [
        "(Root Avoid Wander (VisibleBattery ApproachBattery Turn) ApproachNest)",
        "(Root (Capture (FindBattery Avoid) ApproachBattery) (Deliver Wander ApproachNest))",
    ]
    .map(|text| learned(1, parse(text, catalogue).unwrap(), catalogue, &mut rng));
    let pairs = valid_pairs(&nested(&a, catalogue), &nested(&b, catalogue));
    assert!(pairs.len() > 8, "{pairs:?}");
    let mut counts = vec![0; pairs.len()];
    let mut draws = stream(1, 0, 0, Purpose::Breeding);
    for _ in 0..20_000 {
        let offspring = crossover(&a, &b, [2, 3], &scenario, catalogue, &mut draws).unwrap();
        let (to, from, ..) = site(&offspring[0].origin);
        let pair = pairs.iter().position(|pair| *pair == [to.site, from.site]);
        counts[pair.expect("a valid pair")] += 1;
    }
    assert_frequencies(&counts, &vec![1.0 / pairs.len() as f64; pairs.len()]);
}

/// `reset: child`, by hand: every parameter of the receiver is -1 and every one of the donor -2.
/// Only what the parent knows of the new child starts again.
#[test]
fn a_new_child_alone_is_reset_if_the_scenario_says_so() {
    let mut scenario = Scenario::load("environment-1").unwrap();
    scenario.evolution.reset = Reset::Child;
    let catalogue = WORLD.catalogue();
    let marked = |id, text, mark| {
        let tree = parse(text, catalogue).unwrap();
        let individual = learned(id, tree, catalogue, &mut chance(id));
        let (tree, mut values) = individual.hierarchy.into_parts();
        for (node, value) in values.iter_mut().enumerate() {
            let Some(value) = value else { continue };
            let mut vectors = value.vectors();
            vectors
                .iter_mut()
                .flatten()
                .flatten()
                .for_each(|parameter| *parameter = mark);
            let children: Vec<_> = tree.children(node).map(|c| tree.subtask(c)).collect();
            let subtask = tree.subtask(node);
            let all = CompositeValues::from_vectors(subtask, &children, catalogue, -mark, &vectors);
            *value = all.unwrap();
        }
        let hierarchy = Hierarchy::from_parts(tree, values).unwrap();
        Individual {
            hierarchy,
            ..individual
        }
    };
    let a = marked(1, "(Root (Capture Avoid Wander Turn) Wander)", -1.0);
    let b = marked(
        2,
        "(Root Avoid (VisibleBattery ApproachBattery Turn))",
        -2.0,
    );
    let mut draws = stream(1, 0, 0, Purpose::Breeding);
    let wanted = "(Root (Capture Avoid (VisibleBattery ApproachBattery Turn) Turn) Wander)";
    let mut offspring = std::iter::repeat_with(|| {
        crossover(&a, &b, [3, 4], &scenario, catalogue, &mut draws).unwrap()
    });
    let [child, _] = offspring
        .find(|[child, _]| to_text(child.hierarchy.tree(), catalogue) == wanted)
        .unwrap();
    let values = values(&child, catalogue);
    let marks = |name: &str| -> Vec<f32> {
        let vectors = values[name].vectors();
        let mark = |[inside, outside]: &[Vec<f32>; 2]| {
            assert!(inside.iter().chain(outside).all(|one| *one == inside[0]));
            inside[0]
        };
        vectors.iter().map(mark).collect()
    };
    assert_eq!(marks("Root"), [-1.0, -1.0]);
    assert_eq!(marks("Capture"), [-1.0, 0.123, -1.0]);
    assert_eq!(marks("VisibleBattery"), [-2.0, -2.0]);
    let temperatures = ["Root", "Capture", "VisibleBattery"].map(|name| values[name].temperature);
    assert_eq!(temperatures, [1.0, 1.0, 2.0]);
}

/// A hierarchy that is too long to be read again would end the run that it is saved in.
#[test]
fn offspring_are_not_longer_than_can_be_read_again() {
    let mut scenario = Scenario::load("environment-1").unwrap();
    scenario.evolution.maximum_depth = 3;
    let catalogue = WORLD.catalogue();
    let mut rng = chance(4);
    let wanders = "Wander ".repeat(280);
    let [a, b] = [
        format!("(Root {wanders}(Capture {wanders}Avoid))"),
        format!("(Root {wanders}(Deliver {wanders}Avoid))"),
    ]
    .map(|text| learned(1, parse(&text, catalogue).unwrap(), catalogue, &mut rng));
    let mut draws = stream(2, 0, 0, Purpose::Breeding);
    let mut longest = 0;
    for _ in 0..200 {
        let offspring = crossover(&a, &b, [2, 3], &scenario, catalogue, &mut draws).unwrap();
        for child in &offspring {
            let text = to_text(child.hierarchy.tree(), catalogue);
            assert!(parse(&text, catalogue).is_ok(), "{} bytes", text.len());
            longest = longest.max(text.len());
        }
    }
    assert!(longest > 3900, "the limit is nearly reached: {longest}");
}

#[test]
fn offspring_are_not_deeper_than_allowed() {
    let mut scenario = Scenario::load("environment-1").unwrap();
    scenario.evolution.maximum_depth = 3;
    let catalogue = WORLD.catalogue();
    let mut rng = chance(2);
    let [a, b] = [
        "(Root Wander (Capture Wander ApproachBattery))",
        "(Root Wander (VisibleBattery ApproachBattery Turn) (FindBattery Avoid))",
    ]
    .map(|text| learned(1, parse(text, catalogue).unwrap(), catalogue, &mut rng));
    let mut draws = stream(2, 0, 0, Purpose::Breeding);
    let mut depths = [0; 5];
    for _ in 0..2000 {
        let offspring = crossover(&a, &b, [2, 3], &scenario, catalogue, &mut draws).unwrap();
        for child in &offspring {
            depths[child.hierarchy.tree().depth()] += 1;
        }
    }
    assert!(depths[3] > 1000 && depths[4] == 0, "{depths:?}");
}
