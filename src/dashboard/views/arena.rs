//! The arena.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::View;
use crate::dashboard::desk::Desk;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, put};
use crate::dashboard::scene::{draw_scene, in_proportion};
use crate::worlds::scene::Snapshot;

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
        format!("{speed} {separator} id {id}, generation {generation}")
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
