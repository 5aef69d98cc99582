//! Drawing of a world in true proportions.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Rect};
use ratatui::style::Style;

use super::field_of_view::FieldOfView;
use super::marks::{Scene, agent, sign};
use crate::dashboard::look::{Canvas, Layer, Look, Paint, put};
use crate::worlds::scene::{Mark, Scenery, Snapshot};

/// Returns the largest centred area that shows the extent in true proportions, for terminal
/// cells twice as high as wide.
pub(in crate::dashboard) fn in_proportion(area: Rect, extent: [f64; 2]) -> Rect {
    let ratio = 2.0 * extent[0] / extent[1];
    let (width, height) = (f64::from(area.width), f64::from(area.height));
    let height = height.min(width / ratio);
    let width = width.min(height * ratio);
    area.centered(
        Constraint::Length(width.round() as u16),
        Constraint::Length(height.round() as u16),
    )
}

/// Shades the field of view, behind everything else.
fn shade_field_of_view(
    look: &Look,
    canvas: &Canvas<'_>,
    scenery: &Scenery,
    snapshot: &Snapshot,
    area: Rect,
    buffer: &mut Buffer,
) {
    let Some(field) = FieldOfView::of(snapshot, scenery) else {
        return;
    };
    let style = look.style(Paint::Sight);
    let coloured = style.bg.is_some();
    for row in 0..area.height {
        for column in 0..area.width {
            if !field.sees(canvas.place(column, row)) {
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

pub(in crate::dashboard) fn draw_mark(
    look: &Look,
    canvas: &Canvas<'_>,
    mark: &Mark,
    area: Rect,
    buffer: &mut Buffer,
) {
    put_at(canvas, mark.at, sign(look, mark), area, buffer);
}

/// Draws solid and transparent walls.
pub(in crate::dashboard) fn draw_walls(canvas: &mut Canvas<'_>, scenery: &Scenery) {
    for [from, to] in &scenery.transparent_walls {
        canvas.line(*from, *to, Layer::TransparentWall, Paint::TransparentWall);
    }
    for [from, to] in &scenery.walls {
        canvas.line(*from, *to, Layer::Wall, Paint::Wall);
    }
}

/// Draws a sign at a place, over what is there.
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

/// Draws the world and the agent, as large as the area allows.
pub(super) fn draw_plane(
    look: &Look,
    scenery: &Scenery,
    scene: &Scene<'_>,
    area: Rect,
    buffer: &mut Buffer,
) {
    let area = in_proportion(area, scenery.extent);
    let mut canvas = Canvas::new(look, area, [0.0, 0.0], scenery.extent);
    if let Some(snapshot) = scene.snapshot {
        shade_field_of_view(look, &canvas, scenery, snapshot, area, buffer);
        for (from, to) in scene.trail.iter().zip(scene.trail.iter().skip(1)) {
            canvas.line(*from, *to, Layer::Trail, Paint::Trail);
        }
        for [from, to] in &snapshot.rays {
            canvas.line(*from, *to, Layer::Ray, Paint::Ray);
        }
    }
    draw_walls(&mut canvas, scenery);
    canvas.finish(buffer);
    for mark in scene.marks(scenery) {
        draw_mark(look, &canvas, mark, area, buffer);
    }
    if let Some(snapshot) = scene.snapshot {
        if let Some(place) = snapshot.remembers {
            let sign = (look.signs.remembered, look.style(Paint::Remembered));
            put_at(&canvas, place, sign, area, buffer);
        }
        put_at(&canvas, snapshot.at, agent(look, snapshot), area, buffer);
    }
}
