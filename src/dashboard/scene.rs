//! A world and the agent in it, drawn in its true proportions.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Rect};
use ratatui::style::{Modifier, Style};

use super::desk::Desk;
use super::look::{Canvas, Layer, Look, Paint, put};
use super::sight::Sight;
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

/// Draws the world and, if there is one, the agent in it.
pub(super) fn draw_scene(
    desk: &Desk,
    scenery: &Scenery,
    snapshot: Option<&Snapshot>,
    area: Rect,
    buffer: &mut Buffer,
) {
    let look = &desk.look;
    let mut canvas = Canvas::new(look, area, [0.0, 0.0], scenery.extent);
    draw_grid(look, &canvas, scenery, area, buffer);
    if let Some(snapshot) = snapshot {
        shade_sight(look, &canvas, scenery, snapshot, area, buffer);
        if let Some(rollout) = desk.stage.rollout() {
            let trail = &rollout.status().trail;
            for (from, to) in trail.iter().zip(trail.iter().skip(1)) {
                canvas.line(*from, *to, Layer::Trail, Paint::Trail);
            }
        }
        for [from, to] in &snapshot.rays {
            canvas.line(*from, *to, Layer::Ray, Paint::Ray);
        }
    }
    for [from, to] in &scenery.walls {
        canvas.line(*from, *to, Layer::Wall, Paint::Wall);
    }
    canvas.finish(buffer);
    let moving = snapshot.map_or(&[][..], |snapshot| &snapshot.marks);
    for mark in scenery.places.iter().chain(moving) {
        draw_mark(look, &canvas, mark, area, buffer);
    }
    if let Some(snapshot) = snapshot {
        draw_agent(look, &canvas, snapshot, area, buffer);
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
    let signs = look.signs;
    let (sign, paint) = match mark.role {
        Role::Goal => (signs.goal, Paint::Goal),
        Role::Object => (signs.object, Paint::Object),
        Role::Hazard => (signs.hazard, Paint::Hazard),
        Role::Landmark => (mark.label.as_str(), Paint::Landmark),
    };
    let style = look.style(paint);
    put_at(canvas, mark.at, (sign, style), area, buffer);
}

fn draw_agent(
    look: &Look,
    canvas: &Canvas<'_>,
    snapshot: &Snapshot,
    area: Rect,
    buffer: &mut Buffer,
) {
    let signs = look.signs;
    let sign = match snapshot.heading {
        Some(heading) => {
            let eighth = (heading / std::f64::consts::FRAC_PI_4)
                .round()
                .rem_euclid(8.0);
            signs.headings[eighth as usize % 8]
        }
        None => signs.agent,
    };
    // A robot that carries something looks like what it carries.
    let style = match snapshot.carries {
        Some(_) => look.style(Paint::Object).add_modifier(Modifier::REVERSED),
        None => look.style(Paint::Agent),
    };
    put_at(canvas, snapshot.at, (sign, style), area, buffer);
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

/// Shows where the cells of a world of cells are, and fills those that are hazards.
fn draw_grid(look: &Look, canvas: &Canvas<'_>, scenery: &Scenery, area: Rect, buffer: &mut Buffer) {
    let Some([columns, rows]) = scenery.grid else {
        return;
    };
    for (column, row) in (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))) {
        let centre = [column as f64 + 0.5, row as f64 + 0.5];
        if let Some(cell) = canvas.cell(centre) {
            put(
                buffer,
                area,
                cell,
                look.signs.trail,
                look.style(Paint::Border),
            );
        }
    }
    let mut hazards = vec![false; columns * rows];
    let index = |[x, y]: [f64; 2]| y as usize * columns + x as usize;
    let places = scenery.places.iter();
    for mark in places.filter(|mark| mark.role == Role::Hazard) {
        if let Some(hazard) = hazards.get_mut(index(mark.at)) {
            *hazard = true;
        }
    }
    let (sign, style) = (look.signs.hazard, look.style(Paint::Hazard));
    for position in area.intersection(buffer.area).positions() {
        let cell = (position.x - area.x, position.y - area.y);
        if hazards.get(index(canvas.place(cell.0, cell.1))) == Some(&true) {
            put(buffer, area, cell, sign, style);
        }
    }
}
