//! The subtasks of the cliff walk.

use super::CliffSettings;
use crate::worlds::builder::CatalogueBuilder;
use crate::worlds::grid::{Cells, add_moves};
use crate::worlds::{Axis, Blocks, Catalogue, FeatureKind, Index, MapId, StateType, SubtaskId};

numbered! {
    STATE_TYPES: StateType {
        AT_START = "at the start",
        ABOVE = "above the cliff",
        LAST = "above the goal",
        AT_GOAL = "at the goal",
    }
}

numbered! {
    SUBTASKS: SubtaskId {
        ROOT = "Root",
        LEAVE = "Leave",
        CROSS = "Cross",
        DESCEND = "Descend",
        UP = "Up",
        DOWN = "Down",
        RIGHT = "Right",
        LEFT = "Left",
    }
}

numbered! {
    MAPS: MapId {
        CELL = "cell",
        POSITION = "x, y",
    }
}

/// The primitive subtasks.
pub(super) const ACTIONS: [SubtaskId; 4] = [UP, DOWN, RIGHT, LEFT];

/// Number of inputs: the cell, and its position along x and y.
pub(super) const INPUTS: usize = 3;

pub(super) fn catalogue(cells: Cells, settings: &CliffSettings) -> Catalogue {
    let mut builder =
        CatalogueBuilder::new(Blocks::One, STATE_TYPES, SUBTASKS.iter().copied(), MAPS);
    let all = [AT_START, ABOVE, LAST];
    let walk = "walk from the start to the goal";
    builder.composite(ROOT, walk, CELL, all, [AT_GOAL], 0);
    builder.composite(LEAVE, "leave the start", CELL, [AT_START], [ABOVE], 2);
    builder.composite(CROSS, "walk to above the goal", CELL, [ABOVE], [LAST], 2);
    builder.composite(DESCEND, "walk down to the goal", CELL, [LAST], [AT_GOAL], 2);
    add_moves(&mut builder, ACTIONS, CELL, all);
    let values = cells.count();
    builder.map(CELL, FeatureKind::Table(vec![Index { input: 0, values }]));
    let axis = |input, centres: usize| Axis {
        input,
        centres,
        sigma: settings.rbf_width_cells / (centres - 1) as f64,
    };
    let axes = vec![axis(1, cells.columns), axis(2, cells.rows)];
    builder.map(POSITION, FeatureKind::Gaussian(axes));
    builder.finish()
}
