//! The trial stepper: one time step, taken apart.

mod before;
mod csv;
mod outcome;
mod readings;
mod stack;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::shared::{nobody, pace};
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, last_start};
use crate::dashboard::look::{Look, Paint, fitted, put};
use crate::dashboard::scene::{Scene, draw_scene};
use crate::hierarchy::{Tree, to_dot};
use crate::lab::inspection::StepTrace;
use crate::worlds::{Catalogue, Kind};

/// One time step of the rollout, from the root's choice to the last update.
///
/// ```text
///  ╭ Trial stepper  trial 3 · step 41 · halted, 10x · individual 362 ────────╮
///  │ ⡏⠉⠉⠉⠉⠉⠉⠉⢹                        C~+V       V      C~       C     p    │
///  │ ⡇   ▮   ⡇    ⢸  Root  chooses by softmax, τ 0.812                         │
///  │ ⡇  ↗·   ⡇ ⌂  ⢸  ▸ FindBattery   -3.612  -3.212  -0.400  -0.400  88 % ━━━ │
///  │ ⣇⣀⣀⣀⣀⣀⣀⣀⣸    Wander        -5.401  -0.300  -5.101  -5.101  12 % ━   │
///  │ readings   after ─ what came of it ───────────────────────────────────── │
///  │ proximity    350  state type 1 → 2   reward -0.120                         │
///  ╰──────────────────────────────────────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct Stepper {
    /// How many recorded steps the person has gone back.
    back: usize,
    /// First line of the stack that is shown.
    scroll: usize,
    /// The step that was last when the view was prepared.
    last: Option<(u64, u32)>,
}

/// What a time step is explained with.
struct Shown<'s> {
    trace: &'s StepTrace,
    tree: &'s Tree,
    catalogue: &'s Catalogue,
    look: &'s Look,
}

impl Shown<'_> {
    /// The subtask of a node.
    fn name(&self, node: usize) -> &str {
        self.tree.subtask(node).name(self.catalogue)
    }

    /// The actions of a primitive node.
    fn actions(&self, node: usize) -> &[String] {
        match &self.catalogue.subtask(self.tree.subtask(node)).kind {
            Kind::Primitive { actions } => actions,
            Kind::Composite { .. } => &[],
        }
    }
}

/// Says how a rollout that is halted before its first time step goes on.
fn no_step_yet(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    let look = &context.look;
    let key = context.keys.hint(Action::StepRollout, look.signs);
    let text = match key {
        Some((key, _)) => format!("no time step of this rollout yet: {key} takes one"),
        None => String::from("no time step of this rollout yet"),
    };
    let text = fitted(&text, usize::from(area.width.saturating_sub(1)), look.signs);
    put(buffer, area, (1, 0), &text, look.style(Paint::Dim));
}

/// How much is said.
#[derive(Clone, Copy)]
struct Detail {
    /// The choices of nodes that did not choose in this step.
    standing: bool,
    /// The actions that were not chosen.
    actions: bool,
    /// Updates of a lesson that are listed before the last.
    updates: usize,
}

/// Least rows that are used for the steps before.
const LEAST_BEFORE: usize = 3;

/// From everything to what is needed; the first that fits is shown.
const DETAILS: [Detail; 4] = [
    Detail {
        standing: true,
        actions: true,
        updates: 6,
    },
    Detail {
        standing: true,
        actions: true,
        updates: 1,
    },
    Detail {
        standing: false,
        actions: true,
        updates: 1,
    },
    Detail {
        standing: false,
        actions: false,
        updates: 1,
    },
];

/// Where things are.
struct Areas {
    arena: Rect,
    readings: Rect,
    stack: Rect,
}

impl Areas {
    fn of(area: Rect, readings: u16) -> Self {
        let room = area.height.saturating_sub(readings);
        // Cells are about twice as high as wide: a square arena.
        // Names and numbers need their columns first.
        let widest = match area.width {
            width if width < 100 => width / 3,
            width => width * 2 / 5,
        };
        let left = (2 * room).clamp(24, 24.max(widest)).min(area.width);
        let arena = Rect {
            width: left,
            height: room.min(left.div_ceil(2)),
            ..area
        };
        let readings = Rect {
            y: arena.bottom(),
            height: area.bottom().saturating_sub(arena.bottom()),
            ..arena
        };
        let gap = 1 + u16::from(area.width >= 100);
        let stack = Rect {
            x: arena.right() + gap,
            width: area.width.saturating_sub(left + gap),
            ..area
        };
        Self {
            arena,
            readings,
            stack,
        }
    }
}

impl Stepper {
    fn shown<'d>(&self, context: &'d ViewContext) -> Option<Shown<'d>> {
        Some(Shown {
            trace: context.player.trace(self.back)?,
            tree: context.player.tree()?,
            catalogue: context.catalogue(),
            look: &context.look,
        })
    }

    /// The call stack, what came of it, and what was before, in as much detail as fits.
    fn lines(&self, context: &ViewContext, shown: &Shown<'_>, area: Rect) -> Vec<Line<'static>> {
        let columns = usize::from(area.width);
        let all = |detail| {
            let mut lines = stack::lines(shown, columns, detail);
            lines.push(rule(shown.look, "what came of it", columns));
            lines.extend(outcome::lines(shown, columns, detail));
            lines
        };
        let rows = usize::from(area.height);
        let mut details = DETAILS.iter().copied().map(all);
        let mut lines = details.next().unwrap_or_default();
        while lines.len() > rows {
            match details.next() {
                Some(shorter) => lines = shorter,
                None => return lines,
            }
        }
        let room = rows - lines.len();
        if room >= LEAST_BEFORE && context.player.recorded_steps() > self.back + 1 {
            lines.push(rule(shown.look, "the steps before", columns));
            lines.extend(before::lines(context, shown, self.back, room - 1));
        }
        lines
    }
}

/// A line across with a title in it.
fn rule(look: &Look, title: &str, columns: usize) -> Line<'static> {
    let sign = look.signs.border.horizontal_top;
    let pen = Pen::new(look)
        .text(sign, Paint::Border)
        .text(format!(" {title} "), Paint::Dim);
    let rest = columns.saturating_sub(pen.column());
    pen.text(sign.repeat(rest), Paint::Border).line()
}

impl View for Stepper {
    fn name(&self) -> &'static str {
        "stepper"
    }

    fn title(&self) -> &'static str {
        "Trial stepper"
    }

    fn needs_rollout(&self) -> bool {
        true
    }

    fn caption(&self, context: &ViewContext) -> String {
        let separator = context.look.signs.separator;
        let Some((rollout, subject)) = context.player.rollout().zip(context.player.subject())
        else {
            return String::new();
        };
        let Some(trace) = context.player.trace(self.back) else {
            let (trial, pace) = (rollout.status().trial, pace(context));
            return format!("trial {trial} {separator} {pace} {separator} {subject}");
        };
        let state = match self.back {
            0 => pace(context),
            1 => String::from("1 step back"),
            back => format!("{back} steps back"),
        };
        format!(
            "trial {} {separator} step {} {separator} {state} {separator} {subject}",
            trace.trial, trace.step
        )
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let look = &context.look;
        let Some(shown) = self.shown(context) else {
            return match context.player.rollout() {
                Some(_) => no_step_yet(context, area, buffer),
                None => nobody(context, area, buffer),
            };
        };
        let grid = context.scenery().grid.is_some();
        let rows = shown.trace.after.readings.len() + 2 + usize::from(grid);
        let areas = Areas::of(area, u16::try_from(rows).unwrap_or(u16::MAX));
        let scene = Scene {
            snapshot: Some(&shown.trace.after),
            trail: context.player.trail(self.back),
            cells: context.player.cells(self.back),
            ..Scene::default()
        };
        draw_scene(context, &scene, areas.arena, buffer);
        let readings = readings::lines(context, &shown, usize::from(areas.readings.width));
        draw_lines(look, &readings, 0, areas.readings, buffer);
        let lines = self.lines(context, &shown, areas.stack);
        draw_lines(look, &lines, self.scroll, areas.stack, buffer);
    }

    fn hints(&self) -> &'static [Action] {
        &[
            Action::StepRollout,
            Action::StepBack,
            Action::Halt,
            Action::NextTrial,
            Action::Slower,
            Action::Faster,
        ]
    }

    fn can(&self, context: &ViewContext, action: Action) -> bool {
        action != Action::StepBack || self.back + 1 < context.player.recorded_steps()
    }

    fn act(&mut self, context: &mut ViewContext, action: Action) -> Option<Vec<Effect>> {
        match action {
            Action::StepRollout | Action::Right if self.back > 0 => self.back -= 1,
            Action::Right => context.player.step(),
            Action::StepBack | Action::Left => {
                let most = context.player.recorded_steps().saturating_sub(1);
                self.back = (self.back + 1).min(most);
                context.player.halt();
            }
            Action::Up => self.scroll = self.scroll.saturating_sub(1),
            Action::Down => self.scroll = self.scroll.saturating_add(1),
            Action::Top => self.scroll = 0,
            Action::Bottom => self.scroll = usize::MAX,
            _ => return None,
        }
        Some(Vec::new())
    }

    fn prepare(&mut self, context: &ViewContext) {
        let last = context
            .player
            .trace(0)
            .map(|trace| (trace.trial, trace.step));
        if last != self.last {
            self.last = last;
            self.back = 0;
        }
        let Some(shown) = self.shown(context) else {
            return;
        };
        let (width, height) = context.size;
        let inside = Rect::new(0, 0, width.saturating_sub(2), height.saturating_sub(4));
        let stack = Areas::of(inside, 0).stack;
        let lines = self.lines(context, &shown, stack).len();
        self.scroll = self.scroll.min(last_start(lines, stack.height));
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        Some(csv::csv(&self.shown(context)?))
    }

    fn dot(&self, context: &ViewContext) -> Option<String> {
        Some(to_dot(context.player.tree()?, context.catalogue()))
    }

    fn help_text(&self) -> &'static str {
        "One time step, taken apart. From the root down, every active subtask with the children\n\
         that can act: V is what a child is worth itself, C what is expected after it, C~ the\n\
         same with pseudo-rewards. A subtask chooses by C~+V at its own temperature; a\n\
         primitive subtask acts by Q. Below it, what came of it, from the innermost subtask\n\
         outwards: the pseudo-reward, C~ and C of the child that returned, and the errors of\n\
         the updates, N time steps back (Thesis Algorithm 2.4, Equations 3.4 and 3.5).\n\
         In worlds of cells the cells show V(root) and the greedy actions after the step.\n\
         \n\
         The rollout learns on a copy: nothing here touches evolution."
    }
}
