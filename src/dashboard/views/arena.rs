//! The arena.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::{View, case};
use crate::dashboard::desk::Desk;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, put};
use crate::dashboard::scene::{Scene, draw_scene};
use crate::lab::specimen::Rollout;
use crate::worlds::scene::Snapshot;

/// A rollout of the selected individual.
///
/// ```text
///  ╭ Arena  id 27, gen 12 · 10x ╮
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
        format!("id {id}, gen {generation} {separator} {speed}")
    }

    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let foot = FOOT.min(area.height / 4);
        let above = Rect {
            height: area.height - foot,
            ..area
        };
        let rollout = desk.stage.rollout();
        let snapshot = rollout.map(|rollout| rollout.snapshot());
        let cells = rollout.and_then(|rollout| rollout.cells());
        let scene = Scene {
            snapshot: snapshot.as_ref(),
            trail: rollout.map_or(Vec::new(), trail),
            cells: cells.as_ref(),
            ..Scene::default()
        };
        draw_scene(desk, &scene, above, buffer);
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
         says which subtasks can be active (Thesis Table 4.1). 1x is the robot's own time.\n\
         \n\
         In worlds of cells each cell shows what the individual, as it has learned so far, would\n\
         do there without exploring, all else being as it is: an arrow, or the letter of a\n\
         subtask that does not move it; and V(root), or a digit from 0, the lowest, to 9."
    }
}

fn trail(rollout: &dyn Rollout) -> Vec<[f64; 2]> {
    rollout.status().trail.iter().copied().collect()
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
    let (text, paint) = match status.ended {
        Some(record) if record.delivered => (String::from("done"), Paint::Good),
        Some(_) => (String::from("gave up at the limit"), Paint::Bad),
        None => (state(desk, snapshot), Paint::Notice),
    };
    let text = fitted(&text, usize::from(area.width), look.signs);
    put(buffer, area, (0, 0), &text, look.style(paint));
    let step = format!("trial {} step {:<4} ", status.trial, status.steps);
    let mut column = put(buffer, area, (0, 1), &step, look.style(Paint::Text));
    if !status.history.is_empty() {
        column = put(buffer, area, (column, 1), "before ", look.style(Paint::Dim));
    }
    for record in status.history.iter().rev() {
        let (text, paint) = match record.delivered {
            true => (format!("{} ", record.steps), Paint::Text),
            false => (format!("{}! ", record.steps), Paint::Bad),
        };
        column = put(buffer, area, (column, 1), &text, look.style(paint));
    }
}

/// The state type's number and what is the case in it.
fn state(desk: &Desk, snapshot: &Snapshot) -> String {
    let number = snapshot.state_type.number();
    let types = &desk.catalogue().state_types;
    let Some(info) = types.get(number - 1) else {
        return String::from("done");
    };
    let description = info.description;
    match case(desk, snapshot) {
        Some(case) => format!("{case}: {number} {description}"),
        None => format!("{number} {description}"),
    }
}
