//! A world and the agent in it, drawn in its true proportions.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Rect};
use ratatui::style::{Modifier, Style};

use super::cells::draw_cells;
use super::desk::Desk;
use super::lattice::Lattice;
use super::look::{Canvas, Layer, Look, Paint, put};
use super::sight::Sight;
use crate::lab::specimen::PolicyMap;
use crate::worlds::scene::{Mark, Role, Scenery, Snapshot};

/// The largest area in the middle that shows the extent in its true proportions, cells
/// being about twice as high as wide.
pub(super) fn in_proportion(area: Rect, extent: [f64; 2]) -> Rect {
    let ratio = 2.0 * extent[0] / extent[1];
    let (width, height) = (f64::from(area.width), f64::from(area.height));
    let height = height.min(width / ratio);
    let width = width.min(height * ratio);
    area.centered(
        Constraint::Length(width.round() as u16),
        Constraint::Length(height.round() as u16),
    )
}

/// What is drawn besides the scenery.
#[derive(Default)]
pub(super) struct Scene<'s> {
    /// The agent and its surroundings.
    pub(super) snapshot: Option<&'s Snapshot>,
    /// What can move or go, where it is while there is no agent to look at.
    pub(super) marks: &'s [Mark],
    /// Where the agent has been.
    pub(super) trail: Vec<[f64; 2]>,
    /// What the agent would do in each cell of a world of cells.
    pub(super) cells: Option<&'s PolicyMap>,
}

impl Scene<'_> {
    /// What stands somewhere, the agent apart.
    pub(super) fn marks<'a>(&'a self, scenery: &'a Scenery) -> impl Iterator<Item = &'a Mark> {
        let moving = self.snapshot.map_or(self.marks, |snapshot| &snapshot.marks);
        scenery.places.iter().chain(moving)
    }
}

/// Draws the world and, if there is one, the agent in it, as large as the area allows.
pub(super) fn draw_scene(desk: &Desk, scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let scenery = desk.scenery();
    // Where cells are too many for the area the world is drawn as one without cells.
    let lattice = scenery.grid.and_then(|grid| Lattice::fitting(area, grid));
    if let Some(lattice) = lattice {
        return draw_cells(desk, scene, lattice, buffer);
    }
    let look = &desk.look;
    let area = in_proportion(area, scenery.extent);
    let mut canvas = Canvas::new(look, area, [0.0, 0.0], scenery.extent);
    if let Some(snapshot) = scene.snapshot {
        shade_sight(look, &canvas, scenery, snapshot, area, buffer);
        for (from, to) in scene.trail.iter().zip(scene.trail.iter().skip(1)) {
            canvas.line(*from, *to, Layer::Trail, Paint::Trail);
        }
        for [from, to] in &snapshot.rays {
            canvas.line(*from, *to, Layer::Ray, Paint::Ray);
        }
    }
    for [from, to] in &scenery.walls {
        canvas.line(*from, *to, Layer::Wall, Paint::Wall);
    }
    canvas.finish(buffer);
    for mark in scene.marks(scenery) {
        draw_mark(look, &canvas, mark, area, buffer);
    }
    if let Some(snapshot) = scene.snapshot {
        put_at(&canvas, snapshot.at, agent(look, snapshot), area, buffer);
    }
}

/// Shades what the agent sees, behind everything else.
fn shade_sight(
    look: &Look,
    canvas: &Canvas<'_>,
    scenery: &Scenery,
    snapshot: &Snapshot,
    area: Rect,
    buffer: &mut Buffer,
) {
    let Some(sight) = Sight::of(snapshot, scenery) else {
        return;
    };
    let style = look.style(Paint::Sight);
    let coloured = style.bg.is_some();
    for row in 0..area.height {
        for column in 0..area.width {
            if !sight.sees(canvas.place(column, row)) {
                continue;
            }
            if coloured {
                let cell = Rect::new(area.x + column, area.y + row, 1, 1);
                buffer.set_style(cell.intersection(buffer.area), style);
            } else if (column + 2 * row) % 4 == 0 {
                put(buffer, area, (column, row), look.signs.sight, style);
            }
        }
    }
}

pub(super) fn draw_mark(
    look: &Look,
    canvas: &Canvas<'_>,
    mark: &Mark,
    area: Rect,
    buffer: &mut Buffer,
) {
    put_at(canvas, mark.at, sign(look, mark), area, buffer);
}

/// What stands for a mark.
pub(super) fn sign<'m>(look: &Look, mark: &'m Mark) -> (&'m str, Style) {
    let signs = look.signs;
    let (sign, paint) = match mark.role {
        Role::Goal => (signs.goal, Paint::Goal),
        Role::Object => (signs.object, Paint::Object),
        Role::Hazard => (signs.hazard, Paint::Hazard),
        Role::Landmark => (mark.label.as_str(), Paint::Landmark),
    };
    (sign, look.style(paint))
}

/// What stands for the agent: a robot that carries something looks like what it carries.
pub(super) fn agent(look: &Look, snapshot: &Snapshot) -> (&'static str, Style) {
    let sign = match snapshot.heading {
        Some(heading) => look.signs.heading(heading),
        None => look.signs.agent,
    };
    let style = match snapshot.carries {
        Some(_) => look.style(Paint::Object).add_modifier(Modifier::REVERSED),
        None => look.style(Paint::Agent),
    };
    (sign, style)
}

/// Writes a sign at a place, over what is there.
fn put_at(
    canvas: &Canvas<'_>,
    at: [f64; 2],
    (sign, style): (&str, Style),
    area: Rect,
    buffer: &mut Buffer,
) {
    let Some((column, row)) = canvas.cell(at) else {
        return;
    };
    let Some(cell) = buffer.cell_mut((area.x + column, area.y + row)) else {
        return;
    };
    let background = Style::new().bg(cell.bg);
    cell.reset();
    put(buffer, area, (column, row), sign, background.patch(style));
}
