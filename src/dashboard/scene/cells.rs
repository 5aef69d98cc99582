//! Drawing of a world of cells: the contents, value and greedy action of each cell.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::lattice::Lattice;
use super::marks::{Scene, agent, sign};
use crate::dashboard::context::ViewContext;
use crate::dashboard::look::{Look, Paint, put, width};
use crate::lab::inspection::{PolicyCell, PolicyMap};
use crate::worlds::SubtaskId;
use crate::worlds::scene::{Role, Scenery};

/// A sign with its style.
type Sign<'s> = (&'s str, Style);

/// Draws walls and cells. A larger cell shows more:
///
/// ```text
/// ┏━━━━━━━·      ┏━━━━━━      ┏━━
/// ┃ R▮            ┃R▮  ↓       ┃▮↓     who is there, the greedy action, as an arrow or as
/// ┃   ↓          ┃   8.0                the letter of its subtask, and V(root), in its
/// ┃  8.0                                place a digit from 0, the lowest, to 9
/// ```
pub(super) fn draw_cells(
    context: &ViewContext,
    scene: &Scene<'_>,
    lattice: Lattice,
    buffer: &mut Buffer,
) {
    let (look, scenery) = (&context.look, context.scenery());
    let values = scene.cells.and_then(PolicyMap::values);
    let decimals = decimals(values, lattice.inside(0, 0));
    for (column, row) in lattice.cells() {
        let place = lattice.inside(column, row);
        let cell = scene.cells.and_then(|map| map.cell(column, row));
        let share = cell
            .zip(values)
            .map(|(cell, range)| share(cell.value, range));
        if let Some(share) = share {
            buffer.set_style(
                place.intersection(buffer.area),
                look.style(Paint::shade(share)),
            );
        }
        let centre = lattice.centre(column, row);
        let content = Content {
            signs: signs(look, scenery, scene, centre),
            action: cell.and_then(|cell| action(context, cell)),
            value: cell.zip(share).map(|(cell, share)| match decimals {
                Some(decimals) => format!("{:.decimals$}", cell.value),
                None => ((share * 10.0).clamp(0.0, 9.0) as u32).to_string(),
            }),
        };
        if is_hazard(scenery, centre) {
            fill(look, place, buffer)
        } else {
            content.draw(look, place, buffer)
        }
    }
    lattice.draw_walls(look, &scenery.walls, buffer);
    lattice.draw_trail(look, &scene.trail, buffer);
}

/// Returns the place of a value between the lowest, 0, and the highest, 1.
///
/// Returns 0.5 where lowest and highest differ by rounding alone.
pub(in crate::dashboard) fn share(value: f32, [low, high]: [f32; 2]) -> f32 {
    let noise = 8.0 * f32::EPSILON * low.abs().max(high.abs());
    if high - low > noise.max(f32::MIN_POSITIVE) {
        (value - low) / (high - low)
    } else {
        0.5
    }
}

/// Returns the number of decimals of the values, or `None` where a cell has room for one digit
/// only.
fn decimals(values: Option<[f32; 2]>, cell: Rect) -> Option<usize> {
    // A cell of one row also holds an action and some signs.
    let taken = if cell.height > 1 { 0 } else { 4 };
    let room = usize::from(cell.width).saturating_sub(taken);
    let fits = |decimals: &usize| {
        let widths = values?.map(|value| format!("{value:.decimals$}").len());
        Some(widths.into_iter().all(|width| width <= room))
    };
    [1, 0]
        .into_iter()
        .find(|decimals| fits(decimals) == Some(true))
}

fn same_cell(at: [f64; 2], centre: [f64; 2]) -> bool {
    (0..2).all(|axis| (at[axis] - centre[axis]).abs() <= 0.5)
}

fn is_hazard(scenery: &Scenery, centre: [f64; 2]) -> bool {
    let mut places = scenery.places.iter();
    places.any(|mark| mark.role == Role::Hazard && same_cell(mark.at, centre))
}

fn fill(look: &Look, place: Rect, buffer: &mut Buffer) {
    let text = look.signs.hazard.repeat(place.width.into());
    for row in 0..place.height {
        put(buffer, place, (0, row), &text, look.style(Paint::Hazard));
    }
}

/// Returns the signs in a cell, the most important last.
fn signs<'s>(
    look: &Look,
    scenery: &'s Scenery,
    scene: &'s Scene<'_>,
    centre: [f64; 2],
) -> Vec<Sign<'s>> {
    let marks = scene.marks(scenery);
    let here = marks.filter(|mark| same_cell(mark.at, centre));
    let mut here: Vec<_> = here.collect();
    here.sort_by_key(|mark| match mark.role {
        Role::Landmark | Role::Hazard => 0,
        Role::Goal => 1,
        Role::Object => 2,
    });
    let mut signs: Vec<_> = here.into_iter().map(|mark| sign(look, mark)).collect();
    let who = scene.snapshot.filter(|who| same_cell(who.at, centre));
    signs.extend(who.map(|who| agent(look, who)));
    signs
}

/// Returns the greedy action of a cell: an arrow if it moves the agent, else the letter of its
/// subtask.
fn action(context: &ViewContext, cell: &PolicyCell) -> Option<String> {
    let (subtask, _) = cell.greedy?;
    let mut moves = context.scenery().moves.iter();
    Some(match moves.find(|known| known.subtask == subtask) {
        Some(known) => context.look.signs.heading(known.heading).to_owned(),
        None => letter(context, subtask).to_string(),
    })
}

fn letter(context: &ViewContext, subtask: SubtaskId) -> char {
    let catalogue = context.catalogue();
    let mut named = catalogue.primitives().zip(catalogue.letters());
    let found = named.find(|(primitive, _)| *primitive == subtask);
    found.map_or('?', |(_, letter)| letter)
}

/// The contents of a cell.
struct Content<'s> {
    signs: Vec<Sign<'s>>,
    action: Option<String>,
    value: Option<String>,
}

impl Content<'_> {
    fn draw(&self, look: &Look, place: Rect, buffer: &mut Buffer) {
        let (columns, rows) = (usize::from(place.width), place.height);
        let (bold, plain) = (look.style(Paint::Title), look.style(Paint::Text));
        let action = self.action.as_deref().unwrap_or("");
        let value = self.value.as_deref().unwrap_or("");
        // Texts are aligned to the right edge, in high cells centred.
        let left = |text: &str| {
            let free = columns.saturating_sub(width(text));
            (if rows > 2 { free.div_ceil(2) } else { free }) as u16
        };
        if rows > 1 {
            let middle = if rows > 2 { (rows - 1) / 2 } else { 0 };
            put(buffer, place, (left(action), middle), action, bold);
            put(buffer, place, (left(value), middle + 1), value, plain);
        } else {
            let signs = self.signs.len().min(columns.saturating_sub(1).max(1));
            let room = columns.saturating_sub(signs + width(action));
            let value = match width(value) {
                digits if digits > 1 && digits < room => format!(" {value}"),
                1 if room > 0 => value.to_owned(),
                _ => String::new(),
            };
            let column = left(&format!("{action}{value}"));
            if signs < columns {
                let column = put(buffer, place, (column, 0), action, bold);
                put(buffer, place, (column, 0), &value, plain);
            }
        }
        self.draw_signs(place, buffer);
    }

    /// Draws the signs in the cell, the most important ones where room is short.
    fn draw_signs(&self, place: Rect, buffer: &mut Buffer) {
        let room = usize::from(place.width.saturating_sub(1).max(1));
        let skipped = self.signs.len().saturating_sub(room);
        let mut column = 0;
        for (sign, style) in &self.signs[skipped..] {
            column = put(buffer, place, (column, 0), sign, *style);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_the_same_but_for_noise_are_neither_low_nor_high() {
        assert_eq!(share(-1.0, [-2.0, 0.0]), 0.5);
        assert_eq!(
            (share(-2.0, [-2.0, 0.0]), share(0.0, [-2.0, 0.0])),
            (0.0, 1.0)
        );
        assert_eq!(share(0.0, [0.0, 1e-42]), 0.5);
        assert_eq!(share(7.0, [7.0, 7.0 + 7.0 * f32::EPSILON]), 0.5);
    }
}
