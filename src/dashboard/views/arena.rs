//! The arena.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::View;
use crate::dashboard::desk::Desk;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Canvas, Layer, Paint, put};
use crate::worlds::scene::{Mark, Role};

/// A rollout of the selected individual.
///
/// ```text
///  ╭ Arena ────────────╮
///  │ ⡏⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⢹ │
///  │ ⡇   ▮      ⡇    ⢸ │   walls, batteries ▮, the nest ⌂
///  │ ⡇  ↗·      ⡇ ⌂  ⢸ │   the robot, its heading and trail
///  │ ⣇⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣸ │
///  ╰───────────────────╯
/// ```
pub(super) struct Arena;

impl View for Arena {
    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let scenery = desk.scenery();
        let place = square(area, scenery.extent);
        let mut canvas = Canvas::new(&desk.look, place, [0.0, 0.0], scenery.extent);
        for [from, to] in &scenery.walls {
            canvas.line(*from, *to, Layer::Wall, Paint::Wall);
        }
        canvas.finish(buffer);
        for mark in &scenery.places {
            draw_mark(desk, &canvas, mark, place, buffer);
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[
            Action::Halt,
            Action::Faster,
            Action::Slower,
            Action::Restart,
        ]
    }

    fn lesson(&self) -> &'static str {
        "The world with its walls. A rollout shows the selected individual at work."
    }
}

fn draw_mark(desk: &Desk, canvas: &Canvas<'_>, mark: &Mark, area: Rect, buffer: &mut Buffer) {
    let signs = desk.look.signs;
    let (sign, paint) = match mark.role {
        Role::Goal => (signs.goal, Paint::Goal),
        Role::Object => (signs.object, Paint::Object),
        Role::Hazard => (signs.hazard, Paint::Hazard),
        Role::Landmark => (mark.label.as_str(), Paint::Landmark),
    };
    if let Some(cell) = canvas.cell(mark.at) {
        put(buffer, area, cell, sign, desk.look.style(paint));
    }
}

/// The largest area in the middle that shows the extent in its true proportions, cells
/// being about twice as high as wide.
fn square(area: Rect, extent: [f64; 2]) -> Rect {
    let ratio = 2.0 * extent[0] / extent[1];
    let (width, height) = (f64::from(area.width), f64::from(area.height));
    let height = height.min(width / ratio);
    let width = width.min(height * ratio);
    area.centered(
        ratatui::layout::Constraint::Length(width.round() as u16),
        ratatui::layout::Constraint::Length(height.round() as u16),
    )
}
