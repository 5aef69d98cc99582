//! The subtasks of the cliff walk.

use super::CliffSettings;
use crate::worlds::grid::Cells;
use crate::worlds::{
    Axis, Blocks, Catalogue, FeatureKind, FeatureMap, Index, Kind, MapId, StateType, StateTypeInfo,
    StateTypes, Subtask, SubtaskId,
};

/// At the start.
pub const AT_START: StateType = StateType(0);
/// Above the cliff or the start.
pub const ABOVE: StateType = StateType(1);
/// In the last column, above the goal.
pub const LAST: StateType = StateType(2);
/// At the goal.
pub const AT_GOAL: StateType = StateType(3);

/// The primitive subtask Up.
pub const UP: SubtaskId = SubtaskId(4);
/// The primitive subtask Down.
pub const DOWN: SubtaskId = SubtaskId(5);
/// The primitive subtask Right.
pub const RIGHT: SubtaskId = SubtaskId(6);
/// The primitive subtask Left.
pub const LEFT: SubtaskId = SubtaskId(7);

/// Number of inputs: the cell, and its place along x and y.
pub(super) const INPUTS: usize = 3;

/// The cell.
pub(super) const CELL: MapId = MapId(0);
/// Gaussians over the place.
pub(super) const PLACE: MapId = MapId(1);

pub(super) fn catalogue(cells: Cells, settings: &CliffSettings) -> Catalogue {
    Catalogue {
        state_types: ["at the start", "above the cliff", "above the goal"]
            .map(|description| StateTypeInfo {
                description: String::from(description),
            })
            .into(),
        subtasks: subtasks(),
        maps: maps(cells, settings),
    }
}

fn subtasks() -> Vec<Subtask> {
    let composite = |name, purpose, active: &[StateType], goal, weight| Subtask {
        name: String::from(name),
        purpose: String::from(purpose),
        active: StateTypes::of(active),
        map: CELL,
        kind: Kind::Composite {
            goal: StateTypes::of(&[goal]),
            weight,
            blocks: Blocks::One,
            abstractions: Vec::new(),
        },
    };
    let primitive = |name: &str, purpose| Subtask {
        name: String::from(name),
        purpose: String::from(purpose),
        active: StateTypes::of(&[AT_START, ABOVE, LAST]),
        map: CELL,
        kind: Kind::Primitive {
            actions: vec![name.to_lowercase()],
        },
    };
    let all = [AT_START, ABOVE, LAST];
    vec![
        composite("Root", "walk from the start to the goal", &all, AT_GOAL, 0),
        composite("Leave", "leave the start", &[AT_START], ABOVE, 2),
        composite("Cross", "walk to above the goal", &[ABOVE], LAST, 2),
        composite("Descend", "walk down to the goal", &[LAST], AT_GOAL, 2),
        primitive("Up", "walk one cell up"),
        primitive("Down", "walk one cell down"),
        primitive("Right", "walk one cell to the right"),
        primitive("Left", "walk one cell to the left"),
    ]
}

fn maps(cells: Cells, settings: &CliffSettings) -> Vec<FeatureMap> {
    let axis = |input, centres: usize| Axis {
        input,
        centres,
        sigma: settings.rbf_width_cells / (centres - 1) as f64,
    };
    vec![
        FeatureMap {
            name: String::from("cell"),
            kind: FeatureKind::Table(vec![Index {
                input: 0,
                values: cells.columns * cells.rows,
            }]),
        },
        FeatureMap {
            name: String::from("x, y"),
            kind: FeatureKind::Gaussian(vec![axis(1, cells.columns), axis(2, cells.rows)]),
        },
    ]
}
