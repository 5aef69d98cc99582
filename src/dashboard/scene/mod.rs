//! Drawings of worlds: cell by cell, or in true proportions.

mod cells;
mod field_of_view;
mod lattice;
mod marks;
mod plane;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

pub(super) use cells::share;
pub(super) use marks::Scene;
pub(super) use plane::{draw_mark, draw_walls, in_proportion};

use self::cells::draw_cells;
use self::lattice::Lattice;
use self::plane::draw_plane;
use super::context::ViewContext;

/// Draws the world and the agent, if there is one, as large as the area allows.
pub(in crate::dashboard) fn draw_scene(
    context: &ViewContext,
    scene: &Scene<'_>,
    area: Rect,
    buffer: &mut Buffer,
) {
    let scenery = context.scenery();
    // A world with too many cells for the area is drawn in proportion.
    let lattice = scenery.grid.and_then(|grid| Lattice::fitting(area, grid));
    if let Some(lattice) = lattice {
        return draw_cells(context, scene, lattice, buffer);
    }
    draw_plane(&context.look, scenery, scene, area, buffer);
}
