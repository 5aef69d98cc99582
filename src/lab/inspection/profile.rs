//! Learned values as curves over the inputs that they depend on.

use crate::hierarchy::Tree;
use crate::learning::{Choice, Policy};
use crate::worlds::scene::{Scale, Scenic, Sweep};
use crate::worlds::{Kind, StateType, SubtaskId};

/// The quantity that a profile shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Q_prim of the actions of a primitive subtask.
    ActionValue,
    /// C~ + V of the children of a composite subtask, by which it chooses.
    Preference,
    /// C~ of the children.
    CTilde,
    /// C of the children.
    C,
    /// V of the children.
    Value,
    /// The probability of choosing each child.
    Probability,
}

/// One curve, or one surface over two inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name of the action or child.
    pub label: String,
    /// Node of the child; `None` for an action.
    pub node: Option<usize>,
    /// The values, row by row of the sweep.
    pub values: Vec<f32>,
}

/// Learned values of a node over one or two inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The quantity.
    pub quantity: Quantity,
    /// Type of the states. The values of a primitive subtask are the same for all types.
    pub state_type: StateType,
    /// The input that changes from column to column.
    pub across: Scale,
    /// The input that changes from row to row, if there is more than one row.
    pub down: Option<Scale>,
    /// One curve for each action, or for each child that can act.
    pub curves: Vec<Curve>,
}

/// Returns all profiles of a node: one for each state type in which it can act, each sweep and each
/// quantity.
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
        Kind::Primitive { actions, .. } => action_profiles(world, subtask, actions, policy),
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

/// Returns a quantity of a choice.
type Read = fn(&Choice) -> f32;

/// The quantities of a composite subtask.
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
