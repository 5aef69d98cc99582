//! Random hierarchies of the foraging task, and a second copy of its typing rules.

#![allow(dead_code)] // Each test file uses a part.

use std::collections::BTreeSet;

use maxq_lab::hierarchy::Tree;
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::WorldSettings;
use maxq_lab::worlds::foraging::ForagingWorld;
use maxq_lab::worlds::{Catalogue, SubtaskId};
use rand::rngs::SmallRng;
use rand::{RngExt, SeedableRng};

/// Active state types of Thesis Tables 4.2 and 4.3; composites first.
const ACTIVE: [(&str, &[u8]); 12] = [
    ("Root", &[1, 2, 3, 4]),
    ("Capture", &[1, 2]),
    ("Deliver", &[3, 4]),
    ("FindBattery", &[1]),
    ("VisibleBattery", &[2]),
    ("FindNest", &[3]),
    ("VisibleNest", &[4]),
    ("Avoid", &[1, 2, 3, 4]),
    ("Wander", &[1, 2, 3, 4]),
    ("ApproachBattery", &[2]),
    ("ApproachNest", &[4]),
    ("Turn", &[2, 4]),
];
const COMPOSITES: usize = 7;
pub const MAXIMUM_DEPTH: usize = 4;

/// The world of environment 1.
pub fn world() -> ForagingWorld {
    let WorldSettings::Foraging(model) = Scenario::load("environment-1").unwrap().world else {
        panic!("a foraging scenario")
    };
    ForagingWorld::new(&model).unwrap()
}

/// A tree as nested lists.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Nested {
    pub name: &'static str,
    pub children: Vec<Nested>,
}

impl Nested {
    /// The same tree in the library's form.
    pub fn tree(&self, catalogue: &Catalogue) -> Tree {
        let mut preorder = Vec::new();
        self.preorder(1, catalogue, &mut preorder);
        Tree::from_preorder(&preorder).unwrap()
    }

    fn preorder(&self, depth: usize, catalogue: &Catalogue, out: &mut Vec<(SubtaskId, usize)>) {
        out.push((catalogue.find(self.name).unwrap(), depth));
        for child in &self.children {
            child.preorder(depth + 1, catalogue, out);
        }
    }

    /// The plain form of a library tree.
    pub fn of(tree: &Tree, catalogue: &Catalogue) -> Self {
        Self::below(tree, 0, catalogue)
    }

    fn below(tree: &Tree, node: usize, catalogue: &Catalogue) -> Self {
        Self {
            name: known(tree.subtask(node).name(catalogue)).0,
            children: tree
                .children(node)
                .map(|child| Self::below(tree, child, catalogue))
                .collect(),
        }
    }

    /// All nodes in preorder.
    pub fn nodes(&self) -> Vec<&Self> {
        let below = self.children.iter().flat_map(Self::nodes);
        std::iter::once(self).chain(below).collect()
    }

    /// The node at a place in preorder.
    pub fn node_mut(&mut self, place: usize) -> &mut Self {
        fn find<'t>(tree: &'t mut Nested, left: &mut usize) -> Option<&'t mut Nested> {
            if *left == 0 {
                return Some(tree);
            }
            *left -= 1;
            tree.children.iter_mut().find_map(|child| find(child, left))
        }
        find(self, &mut { place }).unwrap()
    }

    /// The text form with one space between words.
    pub fn text(&self) -> String {
        match self.children.as_slice() {
            [] => self.name.to_owned(),
            children => {
                let children: Vec<_> = children.iter().map(Self::text).collect();
                format!("({} {})", self.name, children.join(" "))
            }
        }
    }

    /// The same tree with all children sorted.
    pub fn sorted(&self) -> Self {
        let mut children: Vec<_> = self.children.iter().map(Self::sorted).collect();
        children.sort();
        Self {
            name: self.name,
            children,
        }
    }

    /// The same tree with all children in a random order.
    pub fn shuffled(&self, rng: &mut SmallRng) -> Self {
        let mut children: Vec<_> = self.children.iter().map(|c| c.shuffled(rng)).collect();
        for last in (1..children.len()).rev() {
            children.swap(last, rng.random_range(0..=last));
        }
        Self {
            name: self.name,
            children,
        }
    }

    pub fn depth(&self) -> usize {
        1 + self.children.iter().map(Self::depth).max().unwrap_or(0)
    }

    /// Returns whether the tree obeys every typing rule.
    pub fn obeys_the_rules(&self) -> bool {
        let mut composites = BTreeSet::new();
        let once = |node: &&Self| !is_composite(node.name) || composites.insert(node.name);
        self.name == "Root"
            && self.nodes().iter().all(once)
            && self.depth() <= MAXIMUM_DEPTH
            && self.children_are_allowed()
            && (1..=4).all(|state_type| self.can_act(state_type))
    }

    fn children_are_allowed(&self) -> bool {
        let mut children = self.children.iter();
        children.all(|child| allowed(child.name, self.name) && child.children_are_allowed())
            && is_composite(self.name) != self.children.is_empty()
    }

    /// Whether a subtask of this tree can act in a state type, numbered from 1.
    pub fn can_act(&self, state_type: u8) -> bool {
        active(self.name).contains(&state_type)
            && (!is_composite(self.name) || self.children.iter().any(|c| c.can_act(state_type)))
    }
}

fn known(name: &str) -> &'static (&'static str, &'static [u8]) {
    ACTIVE.iter().find(|(known, _)| *known == name).unwrap()
}

pub fn active(name: &str) -> &'static [u8] {
    known(name).1
}

pub fn is_composite(name: &str) -> bool {
    ACTIVE[..COMPOSITES].iter().any(|(known, _)| *known == name)
}

/// Whether a child is allowed under a parent.
fn allowed(child: &str, parent: &str) -> bool {
    let mut types = active(child).iter();
    if is_composite(child) {
        types.all(|t| active(parent).contains(t))
    } else {
        types.any(|t| active(parent).contains(t))
    }
}

/// A valid tree with one node changed: renamed, replaced, without children or with one more.
pub fn changed_tree(rng: &mut SmallRng) -> Nested {
    let mut tree = valid_tree(rng);
    let place = rng.random_range(0..tree.nodes().len());
    let name = ACTIVE[rng.random_range(0..ACTIVE.len())].0;
    let given = valid_tree(rng);
    let given = given.nodes()[rng.random_range(0..given.nodes().len())].clone();
    let node = tree.node_mut(place);
    match rng.random_range(0..4) {
        0 => node.name = name,
        1 => node.children.clear(),
        2 => node.children.push(given),
        _ => *node = given,
    }
    tree
}

/// A valid tree.
pub fn valid_tree(rng: &mut SmallRng) -> Nested {
    loop {
        let mut used = BTreeSet::from(["Root"]);
        let tree = grow("Root", 1, rng, &mut |parent, rng| {
            loop {
                let name = ACTIVE[rng.random_range(1..ACTIVE.len())].0;
                let fits = allowed(name, parent);
                if fits && (!is_composite(name) || used.insert(name)) {
                    return name;
                }
            }
        });
        if tree.obeys_the_rules() {
            return tree;
        }
    }
}

fn grow(
    name: &'static str,
    depth: usize,
    rng: &mut SmallRng,
    draw: &mut impl FnMut(&'static str, &mut SmallRng) -> &'static str,
) -> Nested {
    let count = if is_composite(name) && depth < MAXIMUM_DEPTH {
        rng.random_range(1..=4)
    } else {
        0
    };
    let children = (0..count).map(|_| {
        let child = draw(name, rng);
        grow(child, depth + 1, rng, draw)
    });
    Nested {
        name,
        children: children.collect(),
    }
}

/// A random generator with this seed.
pub fn chance(seed: u64) -> SmallRng {
    SmallRng::seed_from_u64(seed)
}
