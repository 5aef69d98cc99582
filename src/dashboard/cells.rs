//! A world of cells: what is in each, what it is worth, where the agent would go from it.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::desk::Desk;
use super::lattice::Lattice;
use super::look::{Look, Paint, put, width};
use super::scene::{Scene, agent, sign};
use super::views::letters;
use crate::lab::specimen::{PolicyCell, PolicyMap};
use crate::worlds::SubtaskId;
use crate::worlds::scene::{Role, Scenery};

/// A sign with its style.
type Sign<'s> = (&'s str, Style);

/// Draws walls and cells. A cell has room for more, the larger it is:
///
/// ```text
/// ┏━━━━━━━·      ┏━━━━━━      ┏━━
/// ┃ R▮            ┃R▮  ↓       ┃▮↓     who is there, the greedy action, as an arrow or as
/// ┃   ↓          ┃   8.0                the letter of its subtask, and V(root), in its
/// ┃  8.0                                place a digit from 0, the lowest, to 9
/// ```
pub(super) fn draw_cells(desk: &Desk, scene: &Scene<'_>, area: Rect, buffer: &mut Buffer) {
    let (look, scenery) = (&desk.look, desk.scenery());
    let lattice = scenery.grid.and_then(|grid| Lattice::fitting(area, grid));
    let Some(lattice) = lattice else {
        put(buffer, area, (0, 0), "no room", look.style(Paint::Dim));
        return;
    };
    let values = scene.cells.and_then(PolicyMap::values);
    for (column, row) in lattice.cells() {
        let place = lattice.inside(column, row);
        let cell = scene.cells.and_then(|map| map.cell(column, row));
        let share = cell
            .zip(values)
            .map(|(cell, [low, high])| (cell.value - low) / (high - low).max(f32::MIN_POSITIVE));
        if let Some(share) = share {
            buffer.set_style(
                place.intersection(buffer.area),
                look.style(Paint::shade(share)),
            );
        }
        let centre = lattice.centre(column, row);
        let content = Content {
            signs: signs(look, scenery, scene, centre),
            action: cell.and_then(|cell| action(desk, cell)),
            value: cell.map(|cell| cell.value),
            share: share.unwrap_or(0.0),
        };
        match is_hazard(scenery, centre) {
            true => fill(look, place, buffer),
            false => content.draw(look, place, buffer),
        }
    }
    lattice.draw_walls(look, &scenery.walls, buffer);
    lattice.draw_trail(look, &scene.trail, buffer);
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

/// What is in a cell, what matters most last.
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

/// The greedy action of a cell: an arrow where it moves the agent, else the letter of its
/// subtask.
fn action(desk: &Desk, cell: &PolicyCell) -> Option<String> {
    let (subtask, _) = cell.greedy?;
    let mut moves = desk.scenery().moves.iter();
    Some(match moves.find(|known| known.subtask == subtask) {
        Some(known) => desk.look.signs.heading(known.heading).to_owned(),
        None => letter(desk, subtask).to_string(),
    })
}

fn letter(desk: &Desk, subtask: SubtaskId) -> char {
    let catalogue = desk.catalogue();
    let mut named = catalogue.primitives().zip(letters(catalogue));
    let found = named.find(|(primitive, _)| *primitive == subtask);
    found.map_or('?', |(_, letter)| letter)
}

/// What stands in a cell.
struct Content<'s> {
    signs: Vec<Sign<'s>>,
    action: Option<String>,
    value: Option<f32>,
    /// The value's place between the lowest and the highest.
    share: f32,
}

impl Content<'_> {
    fn draw(&self, look: &Look, place: Rect, buffer: &mut Buffer) {
        let (columns, rows) = (usize::from(place.width), place.height);
        let (bold, plain) = (look.style(Paint::Title), look.style(Paint::Text));
        let action = self.action.as_deref().unwrap_or("");
        let number = self.number(columns).unwrap_or_else(|| self.level());
        // From the right edge; in high cells everything is centred.
        let at = |text: &str, row: u16| {
            let free = columns.saturating_sub(width(text));
            let left = if rows > 2 { free.div_ceil(2) } else { free };
            (left as u16, row)
        };
        if rows > 1 {
            let middle = if rows > 2 { (rows - 1) / 2 } else { 0 };
            put(buffer, place, at(action, middle), action, bold);
            put(buffer, place, at(&number, middle + 1), &number, plain);
            return self.draw_signs(place, buffer);
        }
        let signs = self.signs.len().min(columns.saturating_sub(1).max(1));
        let number = match columns.saturating_sub(signs + width(action)) {
            0 => String::new(),
            room => match self.number(room.saturating_sub(1)) {
                Some(number) => format!(" {number}"),
                None => self.level(),
            },
        };
        if signs < columns {
            let start = at(&format!("{action}{number}"), 0);
            let (column, row) = start;
            let after = put(buffer, place, start, action, bold);
            put(buffer, place, (after.max(column), row), &number, plain);
        }
        self.draw_signs(place, buffer);
    }

    /// Writes what is here, what matters most where there is not room for all.
    fn draw_signs(&self, place: Rect, buffer: &mut Buffer) {
        let room = usize::from(place.width.saturating_sub(1).max(1));
        let skipped = self.signs.len().saturating_sub(room);
        let mut column = 0;
        for (sign, style) in &self.signs[skipped..] {
            column = put(buffer, place, (column, 0), sign, *style);
        }
    }

    /// The value with as many digits as there are columns; `None` if there is no room.
    fn number(&self, columns: usize) -> Option<String> {
        let value = self.value?;
        let texts = [format!("{value:.1}"), format!("{value:.0}")];
        texts.into_iter().find(|text| width(text) <= columns)
    }

    /// The value as a digit.
    fn level(&self) -> String {
        let level = (self.share * 10.0).clamp(0.0, 9.0) as u32;
        self.value.map_or(String::new(), |_| level.to_string())
    }
}
