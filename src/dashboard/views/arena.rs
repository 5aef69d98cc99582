//! The arena.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Rect};
use ratatui::style::{Modifier, Style};

use super::View;
use crate::dashboard::desk::Desk;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Canvas, Layer, Look, Paint, fitted, put};
use crate::dashboard::sight::Sight;
use crate::worlds::scene::{Mark, Role, Scenery, Snapshot};

/// A rollout of the selected individual.
///
/// ```text
///  ╭ Arena  individual 27, 10x ─╮
///  │ ⡏⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⢹          │
///  │ ⡇   ▮      ⡇    ⢸          │   walls, batteries ▮, the nest ⌂; the robot,
///  │ ⡇  ↗·      ⡇ ⌂  ⢸          │   its heading, trail, rays and field of view
///  │ ⣇⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣸          │
///  │ step 41  2 a battery visible│   time step, state type; how trials ended
///  ╰─────────────────────────────╯
/// ```
pub(super) struct Arena;

/// Rows below the arena.
const FOOT: u16 = 2;

impl View for Arena {
    fn caption(&self, desk: &Desk) -> String {
        let stage = &desk.stage;
        let Some(subject) = stage.subject() else {
            return String::new();
        };
        let speed = match stage.halted() {
            true => String::from("halted"),
            false => format!("{}x", stage.speed()),
        };
        let separator = desk.look.signs.separator;
        let (id, generation) = (subject.id, subject.generation);
        format!("{speed} {separator} individual {id} of generation {generation}")
    }

    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let foot = FOOT.min(area.height / 4);
        let above = Rect {
            height: area.height - foot,
            ..area
        };
        let scenery = desk.scenery();
        let place = in_proportion(above, scenery.extent);
        let snapshot = desk.stage.rollout().map(|rollout| rollout.snapshot());
        draw_scene(desk, scenery, snapshot.as_ref(), place, buffer);
        let below = Rect {
            y: area.y + above.height,
            height: foot,
            ..area
        };
        draw_foot(desk, snapshot.as_ref(), below, buffer);
    }

    fn hints(&self) -> &'static [Action] {
        &[
            Action::Halt,
            Action::StepRollout,
            Action::Faster,
            Action::Slower,
            Action::Restart,
        ]
    }

    fn lesson(&self) -> &'static str {
        "A rollout: a copy of the individual acts and learns in the arena, trial after trial, as\n\
         in its generation; evolution knows nothing of it. Shaded is what the robot sees, fine\n\
         lines are its proximity rays. A carried battery is gone from the arena. The state type\n\
         says which subtasks can be active (Thesis Table 4.1). 1x is the robot's own time."
    }
}

/// The largest area in the middle that shows the extent in its true proportions, cells
/// being about twice as high as wide.
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
    let hazards = scenery
        .places
        .iter()
        .filter(|mark| mark.role == Role::Hazard);
    let hazards: Vec<_> = hazards.map(|mark| mark.at).collect();
    for (column, row) in
        (0..area.width).flat_map(|column| (0..area.height).map(move |row| (column, row)))
    {
        let [x, y] = canvas.place(column, row);
        let inside = |at: &[f64; 2]| (at[0] - x).abs() <= 0.5 && (at[1] - y).abs() <= 0.5;
        if hazards.iter().any(inside) {
            put(
                buffer,
                area,
                (column, row),
                look.signs.hazard,
                look.style(Paint::Hazard),
            );
        }
    }
}

/// Time step, state type, and how the latest trials ended.
fn draw_foot(desk: &Desk, snapshot: Option<&Snapshot>, area: Rect, buffer: &mut Buffer) {
    let look = &desk.look;
    let (Some(rollout), Some(snapshot)) = (desk.stage.rollout(), snapshot) else {
        let why = match desk.stage.refused() {
            Some(why) => why,
            None if desk.shown().is_none() => "no individual has lived yet",
            None => "the individual is being fetched",
        };
        let text = fitted(why, usize::from(area.width), look.signs);
        put(buffer, area, (0, 0), &text, look.style(Paint::Dim));
        return;
    };
    let status = rollout.status();
    let step = match area.width >= 36 {
        true => format!("trial {} step {:<4} ", status.trial, status.steps),
        false => format!("{:<4} ", status.steps),
    };
    let column = put(buffer, area, (0, 0), &step, look.style(Paint::Text));
    let (text, paint) = match status.ended {
        Some(record) if record.delivered => (String::from("done"), Paint::Good),
        Some(_) => (String::from("gave up at the limit"), Paint::Bad),
        None => (state_type(desk, snapshot), Paint::Notice),
    };
    let room = usize::from(area.width.saturating_sub(column));
    let text = fitted(&text, room, look.signs);
    put(buffer, area, (column, 0), &text, look.style(paint));
    let before = match status.history.is_empty() {
        true => "no trial has ended yet",
        false => "trials ",
    };
    let mut column = put(buffer, area, (0, 1), before, look.style(Paint::Dim));
    for record in status.history.iter().rev() {
        let (text, paint) = match record.delivered {
            true => (format!("{} ", record.steps), Paint::Text),
            false => (format!("{}! ", record.steps), Paint::Bad),
        };
        column = put(buffer, area, (column, 1), &text, look.style(paint));
    }
}

/// The state type's number and what is the case in it.
fn state_type(desk: &Desk, snapshot: &Snapshot) -> String {
    let number = snapshot.state_type.number();
    let types = &desk.catalogue().state_types;
    match types.get(number - 1) {
        Some(info) => format!("{number} {}", info.description),
        None => String::from("done"),
    }
}
