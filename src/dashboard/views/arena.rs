//! The arena view: the world, with a rollout in it.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::shared::{below, no_individual, pace, right_of, row, variant_name};
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Look, Paint, fitted, put, width, wrapped};
use crate::dashboard::scene::{Scene, draw_scene};
use crate::lab::inspection::{Rollout, RolloutStatus};
use crate::worlds::StateType;
use crate::worlds::scene::Snapshot;

/// A rollout of the selected individual, drawn in its world.
///
/// ```text
///  ╭ Arena  id 27, gen 12 · 10x ───╮
///  │ ⡏⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⠉⢹             │
///  │ ⡇   ▮      ⡇    ⢸             │   walls, batteries ▮, nest ⌂; the robot with
///  │ ⡇  ↗·      ⡇ ⌂  ⢸             │   heading, trail, rays and field of view
///  │ ⣇⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣀⣸             │
///  │ 2 empty-handed, a battery ... │   the state type
///  │ trial 3 step 41  earlier 92   │   time steps of this trial and of earlier ones
///  ╰───────────────────────────────╯
/// ```
pub(super) struct Arena;

/// Most rows that describe the state below the arena.
const STATE_ROWS: usize = 3;

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
        let foot = right_of(below(area, above.height), 1);
        draw_foot(context, snapshot.as_ref(), foot, buffer);
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
        "A rollout: a copy of the selected individual acts and learns in the arena, trial after\n\
         trial, as it did in its generation. The rollout does not affect evolution. The shaded\n\
         area is the robot's field of view; thin lines are its proximity rays. Dotted walls (= in\n\
         ASCII) are transparent: the robot sees through them. The diamond (? in ASCII) is the place\n\
         where the robot remembers its target while it does not see it. A battery that is\n\
         carried is not drawn. The state type decides which subtasks can be active (Thesis\n\
         Table 4.1). At 1x the robot moves in real time. The last line shows the time steps of\n\
         this trial and of earlier ones, the latest first; ! marks a trial that was truncated.\n\
         \n\
         In worlds of cells, each cell shows what the individual has learned to do there, without\n\
         exploration and with the rest of the state as it is now: an arrow for a move, or the\n\
         letter of a subtask that does not move it. Below it stands V(root), the expected return;\n\
         small cells show it as a digit from 0 (lowest) to 9 (highest)."
    }
}

fn trail(rollout: &dyn Rollout) -> Vec<[f64; 2]> {
    rollout.status().trail.iter().copied().collect()
}

/// Returns the rows for the state: enough for the longest description, so that the arena keeps
/// its size when the state changes.
fn state_rows(context: &ViewContext, area: Rect) -> u16 {
    let variants = context.experiment.variants();
    let names: Vec<_> = if context.scenery().grid.is_some() && variants.len() > 1 {
        variants.iter().map(|name| Some(name.as_str())).collect()
    } else {
        vec![None]
    };
    let types = context.catalogue().types();
    let texts = types.flat_map(|state_type| {
        let names = names.iter();
        names.map(move |name| describe_state(context, state_type, *name))
    });
    let columns = usize::from(area.width.saturating_sub(1));
    let rows = texts.map(|text| wrapped(&text, columns, "").len());
    rows.max().unwrap_or(1).min(STATE_ROWS) as u16
}

/// Draws state type, time step, and the time steps of earlier trials.
fn draw_foot(context: &ViewContext, snapshot: Option<&Snapshot>, area: Rect, buffer: &mut Buffer) {
    let look = &context.look;
    let (Some(rollout), Some(snapshot)) = (context.player.rollout(), snapshot) else {
        let why = no_individual(context);
        return put_wrapped(look, (why, Paint::Dim), area, buffer);
    };
    let status = rollout.status();
    let (text, paint) = match status.ended {
        Some(record) if record.delivered => (String::from("done"), Paint::Good),
        Some(_) => (String::from("truncated at the step limit"), Paint::Bad),
        None => {
            let variant = variant_name(context, snapshot);
            let text = describe_state(context, snapshot.state_type, variant);
            (text, Paint::Notice)
        }
    };
    let last = area.height.saturating_sub(1);
    let above = Rect {
        height: last.max(area.height.min(1)),
        ..area
    };
    put_wrapped(look, (&text, paint), above, buffer);
    if last > 0 {
        draw_trials(context, status, row(area, last), buffer);
    }
}

/// Draws the time steps of this trial and, as far as they fit, of earlier ones.
fn draw_trials(context: &ViewContext, status: &RolloutStatus, line: Rect, buffer: &mut Buffer) {
    let mut put =
        |column, text: &str, paint| put(buffer, line, (column, 0), text, context.look.style(paint));
    let step = format!("trial {} step {:<4} ", status.trial, status.steps);
    let mut column = put(0, &step, Paint::Text);
    if context.player.halted() {
        column = put(column, "halted ", Paint::Notice);
    }
    let mut label = "earlier ";
    for record in status.history.iter().rev() {
        let (text, paint) = if record.delivered {
            (format!("{} ", record.steps), Paint::Text)
        } else {
            (format!("{}! ", record.steps), Paint::Bad)
        };
        // A clipped number would read as another number.
        let end = usize::from(column) + width(label) + width(text.trim_end());
        if end > usize::from(line.width) {
            break;
        }
        column = put(column, label, Paint::Dim);
        column = put(column, &text, paint);
        label = "";
    }
}

/// Wraps a text into the rows of an area; the last row takes the rest, cut to fit.
fn put_wrapped(look: &Look, (text, paint): (&str, Paint), area: Rect, buffer: &mut Buffer) {
    let columns = usize::from(area.width);
    let mut lines = wrapped(text, columns, "");
    let last = usize::from(area.height).saturating_sub(1);
    if lines.len() > last {
        let rest = lines.split_off(last).join(" ");
        lines.push(rest);
    }
    for (row, line) in (0..area.height).zip(&lines) {
        let line = fitted(line, columns, look.signs);
        put(buffer, area, (0, row), &line, look.style(paint));
    }
}

/// Puts a state into words: the name of its variant, if any, and number and description of its
/// type.
fn describe_state(context: &ViewContext, state_type: StateType, variant: Option<&str>) -> String {
    let number = state_type.number();
    let Some(info) = context.catalogue().state_types.get(number - 1) else {
        return String::from("done");
    };
    let description = &info.description;
    match variant {
        Some(name) => format!("{name}: {number} {description}"),
        None => format!("{number} {description}"),
    }
}
