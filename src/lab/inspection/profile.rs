//! Learned values, drawn over the inputs that they depend on.

use crate::hierarchy::Tree;
use crate::learning::{Choice, Policy};
use crate::worlds::scene::{Scale, Scenic, Sweep};
use crate::worlds::{Kind, StateType, SubtaskId};

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Q_prim of a primitive subtask's actions.
    ActionValue,
    /// C~ + V, what a composite subtask chooses by.
    Preference,
    /// C~ of its children.
    CTilde,
    /// C of its children.
    C,
    /// V of its children.
    Value,
    /// The probability of its children.
    Probability,
}

/// One curve, or one sheet over two dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The action or the child.
    pub label: String,
    /// The child's node, for the children of a composite subtask.
    pub node: Option<usize>,
    /// The values, row by row of the sweep.
    pub values: Vec<f32>,
}

/// Learned values of a node over some inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// What is drawn.
    pub quantity: Quantity,
    /// The type of the states; values of primitive subtasks are the same in all.
    pub state_type: StateType,
    /// From column to column.
    pub across: Scale,
    /// From row to row, if there is more than one row.
    pub down: Option<Scale>,
    /// One curve an action or a child that can act.
    pub curves: Vec<Curve>,
}

/// All profiles of a node: for every state type that it can act in, every sweep and
/// every quantity.
pub(in crate::lab) fn profiles<W: Scenic>(
    world: &W,
    tree: &Tree,
    node: usize,
    policy: &mut Policy<'_>,
) -> Vec<Profile> {
    let Some(subtask) = tree.nodes().get(node).map(|node| node.subtask) else {
        return Vec::new();
    };
    match &world.catalogue().subtask(subtask).kind {
        Kind::Primitive { actions } => action_profiles(world, subtask, actions, policy),
        Kind::Composite { .. } => {
            let types = world.catalogue().subtask(subtask).active.iter();
            types
                .flat_map(|state_type| choice_profiles(world, tree, node, state_type, policy))
                .collect()
        }
    }
}

fn action_profiles<W: Scenic>(
    world: &W,
    subtask: SubtaskId,
    actions: &[String],
    policy: &mut Policy<'_>,
) -> Vec<Profile> {
    let catalogue = world.catalogue();
    let primitive = catalogue.primitives().position(|p| p == subtask);
    let state_type = catalogue.subtask(subtask).active.iter().next();
    let (Some(primitive), Some(state_type)) = (primitive, state_type) else {
        return Vec::new();
    };
    let sweeps = world.sweeps(subtask, state_type).into_iter();
    sweeps
        .map(|sweep| {
            let mut curves: Vec<_> = actions.iter().map(|label| curve(label, None)).collect();
            for probe in &sweep.probes {
                policy.look(state_type, probe.percept.as_ref());
                for (curve, value) in curves.iter_mut().zip(policy.action_values(primitive)) {
                    curve.values.push(*value);
                }
            }
            profile(Quantity::ActionValue, state_type, &sweep, curves)
        })
        .collect()
}

/// Reads a quantity off a choice.
type Read = fn(&Choice) -> f32;

/// What is drawn of a composite subtask.
const OF_CHOICES: [(Quantity, Read); 5] = [
    (Quantity::Preference, Choice::preference),
    (Quantity::CTilde, |choice| choice.c_tilde),
    (Quantity::C, |choice| choice.c),
    (Quantity::Value, |choice| choice.value),
    (Quantity::Probability, |choice| choice.probability),
];

fn choice_profiles<W: Scenic>(
    world: &W,
    tree: &Tree,
    node: usize,
    state_type: StateType,
    policy: &mut Policy<'_>,
) -> Vec<Profile> {
    let catalogue = world.catalogue();
    let mut all = Vec::new();
    for sweep in world.sweeps(tree.subtask(node), state_type) {
        let probes = sweep.probes.iter();
        let choices: Vec<Vec<Choice>> = probes
            .map(|probe| {
                policy.look(state_type, probe.percept.as_ref());
                policy.choices(node).1
            })
            .collect();
        let Some(first) = choices.first().filter(|first| !first.is_empty()) else {
            continue;
        };
        for (quantity, read) in OF_CHOICES {
            let curves = first.iter().enumerate().map(|(index, choice)| {
                let name = tree.subtask(choice.node).name(catalogue);
                Curve {
                    values: choices
                        .iter()
                        .map(|choices| read(&choices[index]))
                        .collect(),
                    ..curve(name, Some(choice.node))
                }
            });
            all.push(profile(quantity, state_type, &sweep, curves.collect()));
        }
    }
    all
}

fn curve(label: &str, node: Option<usize>) -> Curve {
    Curve {
        label: label.to_owned(),
        node,
        values: Vec::new(),
    }
}

fn profile<P>(
    quantity: Quantity,
    state_type: StateType,
    sweep: &Sweep<P>,
    curves: Vec<Curve>,
) -> Profile {
    Profile {
        quantity,
        state_type,
        across: sweep.across.clone(),
        down: sweep.down.clone(),
        curves,
    }
}
