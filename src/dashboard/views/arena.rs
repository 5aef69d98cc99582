//! The arena.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::shared::{case, pace};
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Look, Paint, fitted, put, width, wrapped};
use crate::dashboard::scene::{Scene, draw_scene};
use crate::lab::inspection::Rollout;
use crate::worlds::StateType;
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

/// Most rows of the state below the arena.
const STATE: usize = 3;

impl View for Arena {
    fn name(&self) -> &'static str {
        "arena"
    }

    fn title(&self) -> &'static str {
        "Arena"
    }

    fn needs_rollout(&self) -> bool {
        true
    }

    fn caption(&self, context: &ViewContext) -> String {
        let Some(subject) = context.player.subject() else {
            return String::new();
        };
        let (separator, pace) = (context.look.signs.separator, pace(context));
        let (id, generation) = (subject.id, subject.generation);
        format!("id {id}, gen {generation} {separator} {pace}")
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let foot = (state_rows(context, area) + 1).min(area.height / 3);
        let above = Rect {
            height: area.height - foot,
            ..area
        };
        let rollout = context.player.rollout();
        let snapshot = rollout.map(|rollout| rollout.snapshot());
        let cells = rollout.and_then(|rollout| rollout.cells());
        let scene = Scene {
            snapshot: snapshot.as_ref(),
            trail: rollout.map_or(Vec::new(), trail),
            cells: cells.as_ref(),
            ..Scene::default()
        };
        draw_scene(context, &scene, above, buffer);
        let below = Rect {
            x: area.x + 1,
            y: area.y + above.height,
            width: area.width.saturating_sub(1),
            height: foot,
        };
        draw_foot(context, snapshot.as_ref(), below, buffer);
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

    fn help_text(&self) -> &'static str {
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

/// Rows that the state takes: as many as that with the longest name, so that the arena keeps
/// its size.
fn state_rows(context: &ViewContext, area: Rect) -> u16 {
    let variants = context.experiment.variants();
    let cases: Vec<_> = match context.scenery().grid.is_some() && variants.len() > 1 {
        true => variants.iter().map(|case| Some(case.as_str())).collect(),
        false => vec![None],
    };
    let types = context.catalogue().types();
    let texts = types.flat_map(|state_type| {
        let texts = cases.iter();
        texts.map(move |case| state(context, state_type, *case))
    });
    let columns = usize::from(area.width.saturating_sub(1));
    let rows = texts.map(|text| wrapped(&text, columns, "").len());
    rows.max().unwrap_or(1).min(STATE) as u16
}

/// State type, time step, and how the latest trials ended.
fn draw_foot(context: &ViewContext, snapshot: Option<&Snapshot>, area: Rect, buffer: &mut Buffer) {
    let look = &context.look;
    let columns = usize::from(area.width);
    let (Some(rollout), Some(snapshot)) = (context.player.rollout(), snapshot) else {
        let why = match context.player.load_error() {
            Some(why) => why,
            None if context.shown().is_none() => "no individual has lived yet",
            None => "the individual is being fetched",
        };
        put_wrapped(look, (why, Paint::Dim), area, buffer);
        return;
    };
    let status = rollout.status();
    let (text, paint) = match status.ended {
        Some(record) if record.delivered => (String::from("done"), Paint::Good),
        Some(_) => (String::from("gave up at the limit"), Paint::Bad),
        None => {
            let case = case(context, snapshot);
            (state(context, snapshot.state_type, case), Paint::Notice)
        }
    };
    let last = area.height.saturating_sub(1);
    let above = Rect {
        height: last.max(area.height.min(1)),
        ..area
    };
    put_wrapped(look, (&text, paint), above, buffer);
    if last == 0 {
        return;
    }
    let step = format!("trial {} step {:<4} ", status.trial, status.steps);
    let mut column = put(buffer, area, (0, last), &step, look.style(Paint::Text));
    if context.player.halted() {
        let halted = "halted ";
        column = put(
            buffer,
            area,
            (column, last),
            halted,
            look.style(Paint::Notice),
        );
    }
    let mut before = Some("before ");
    for record in status.history.iter().rev() {
        let (text, paint) = match record.delivered {
            true => (format!("{} ", record.steps), Paint::Text),
            false => (format!("{}! ", record.steps), Paint::Bad),
        };
        // A number that is cut would be another number.
        let label = before.unwrap_or("");
        if usize::from(column) + width(label) + width(text.trim_end()) > columns {
            break;
        }
        column = put(buffer, area, (column, last), label, look.style(Paint::Dim));
        column = put(buffer, area, (column, last), &text, look.style(paint));
        before = None;
    }
}

/// Writes a text in as many lines as there is room for.
fn put_wrapped(look: &Look, (text, paint): (&str, Paint), area: Rect, buffer: &mut Buffer) {
    let columns = usize::from(area.width);
    let mut lines = wrapped(text, columns, "");
    if let Some(rest) = lines.get(usize::from(area.height).saturating_sub(1)..) {
        let rest = rest.join(" ");
        lines.truncate(usize::from(area.height).saturating_sub(1));
        lines.push(rest);
    }
    for (row, line) in (0..area.height).zip(&lines) {
        let line = fitted(line, columns, look.signs);
        put(buffer, area, (0, row), &line, look.style(paint));
    }
}

/// The state type's number and what is the case in it.
fn state(context: &ViewContext, state_type: StateType, case: Option<&str>) -> String {
    let number = state_type.number();
    let types = &context.catalogue().state_types;
    let Some(info) = types.get(number - 1) else {
        return String::from("done");
    };
    let description = &info.description;
    match case {
        Some(case) => format!("{case}: {number} {description}"),
        None => format!("{number} {description}"),
    }
}
