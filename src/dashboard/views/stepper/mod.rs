//! The trial stepper: one time step in detail.

mod csv;
mod earlier;
mod outcome;
mod readings;
mod stack;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::shared::{below, draw_no_individual, draw_note, keys, pace, right_of};
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, last_start};
use crate::dashboard::look::{Look, Paint};
use crate::dashboard::scene::{Scene, draw_scene};
use crate::hierarchy::{Tree, to_dot};
use crate::lab::inspection::StepTrace;
use crate::learning::ActionChoice;
use crate::worlds::{Catalogue, Kind};

/// One time step of the rollout, from the root's choice to the last update.
///
/// ```text
///  ╭ Trial stepper  trial 3 · step 41 · halted, 10x · individual 362 ────────╮
///  │ ⡏⠉⠉⠉⠉⠉⠉⠉⢹                        C~+V       V      C~       C     p    │
///  │ ⡇   ▮   ⡇    ⢸  Root  chooses by softmax, τ 0.812                         │
///  │ ⡇  ↗·   ⡇ ⌂  ⢸  ▸ FindBattery   -3.612  -3.212  -0.400  -0.400  88 % ━━━ │
///  │ ⣇⣀⣀⣀⣀⣀⣀⣀⣸    Wander        -5.401  -0.300  -5.101  -5.101  12 % ━   │
///  │ readings   after ─ outcome ───────────────────────────────────────────── │
///  │ proximity    350  state type 1 → 2   reward -0.120                         │
///  ╰──────────────────────────────────────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct Stepper {
    /// How many recorded steps back the step shown is.
    back: usize,
    /// Lines of the stack scrolled out at the top.
    scroll: usize,
    /// Trial and number of the latest step when the view was last prepared.
    last: Option<(u64, u32)>,
}

/// The time step shown, with what its explanation needs.
struct ShownStep<'s> {
    trace: &'s StepTrace,
    tree: &'s Tree,
    catalogue: &'s Catalogue,
    look: &'s Look,
}

impl ShownStep<'_> {
    /// Returns the name of a node's subtask.
    fn name(&self, node: usize) -> &str {
        self.tree.subtask(node).name(self.catalogue)
    }

    /// Returns the actions that a primitive node chooses from.
    fn actions(&self, action: &ActionChoice) -> &[String] {
        match &self.catalogue.subtask(action.acts_as).kind {
            Kind::Primitive { actions, .. } => actions,
            Kind::Composite { .. } => &[],
        }
    }
}

/// Explains how to take the first time step of a halted rollout.
fn draw_no_step(context: &ViewContext, area: Rect, buffer: &mut Buffer) {
    let key = keys(context, Action::StepRollout);
    let note = if key.is_empty() {
        String::from("this rollout has no time step yet")
    } else {
        format!("this rollout has no time step yet: {key} takes one")
    };
    draw_note(context, &note, area, buffer);
}

/// How much of a time step is shown.
#[derive(Clone, Copy)]
struct Detail {
    /// The children of nodes that did not choose in this step.
    standing: bool,
    /// The actions that were not chosen.
    actions: bool,
    /// Updates per node that are listed before the last one.
    updates: usize,
    /// Children per node that are listed one by one.
    children: usize,
}

impl Detail {
    const fn new(standing: bool, actions: bool, updates: usize) -> Self {
        Self {
            standing,
            actions,
            updates,
            children: usize::MAX - 1,
        }
    }

    const fn with_children(self, children: usize) -> Self {
        Self { children, ..self }
    }
}

/// From full detail to the minimum; the first that fits is shown.
const DETAILS: [Detail; 6] = [
    Detail::new(true, true, 6),
    Detail::new(true, true, 1),
    Detail::new(false, true, 1),
    Detail::new(false, false, 1),
    Detail::new(false, false, 1).with_children(5),
    Detail::new(false, false, 0).with_children(3),
];

/// Fewest rows that are used for the earlier steps.
const EARLIER_ROWS: usize = 3;

/// The areas of the view.
struct Areas {
    arena: Rect,
    readings: Rect,
    stack: Rect,
}

impl Areas {
    fn of(area: Rect, readings: u16) -> Self {
        let room = area.height.saturating_sub(readings);
        // Terminal cells are about twice as high as wide, so this makes the arena square,
        // unless names and numbers need its columns.
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
        let readings = below(
            Rect {
                width: left,
                ..area
            },
            arena.height,
        );
        let gap = 1 + u16::from(area.width >= 100);
        let stack = right_of(area, left + gap);
        Self {
            arena,
            readings,
            stack,
        }
    }
}

impl Stepper {
    fn shown<'d>(&self, context: &'d ViewContext) -> Option<ShownStep<'d>> {
        Some(ShownStep {
            trace: context.player.trace(self.back)?,
            tree: context.player.tree()?,
            catalogue: context.catalogue(),
            look: &context.look,
        })
    }

    /// Returns the call stack, its outcome and the earlier steps, in as much detail as fits.
    fn lines(
        &self,
        context: &ViewContext,
        shown: &ShownStep<'_>,
        area: Rect,
    ) -> Vec<Line<'static>> {
        let columns = usize::from(area.width);
        let all = |detail| {
            let mut lines = stack::lines(shown, columns, detail);
            lines.push(rule(shown.look, "outcome", columns));
            lines.extend(outcome::lines(shown, columns, detail));
            lines
        };
        let rows = usize::from(area.height);
        let mut lines = Vec::new();
        for detail in DETAILS {
            lines = all(detail);
            if lines.len() <= rows {
                break;
            }
        }
        let room = rows.saturating_sub(lines.len());
        if room >= EARLIER_ROWS && context.player.recorded_steps() > self.back + 1 {
            lines.push(rule(shown.look, "earlier steps", columns));
            lines.extend(earlier::lines(context, shown, self.back, room - 1));
        }
        lines
    }
}

/// Returns a horizontal line with a title in it.
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
        let player = &context.player;
        let Some((rollout, subject)) = player.rollout().zip(player.subject()) else {
            return String::new();
        };
        let Some(trace) = player.trace(self.back) else {
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
                Some(_) => draw_no_step(context, area, buffer),
                None => draw_no_individual(context, area, buffer),
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
        let latest = context.player.trace(0);
        let last = latest.map(|trace| (trace.trial, trace.step));
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
        "One time step in detail. At the top stand the active subtasks, from the root down, with\n\
         the children that they can choose. V is the return expected while the child runs, C the\n\
         return expected after it until the subtask itself terminates, and C~ the same with\n\
         pseudo-rewards. A composite subtask chooses by C~+V at its own temperature; a primitive\n\
         subtask chooses its action by Q. The outcome follows, from the innermost subtask\n\
         outwards: the pseudo-reward, C~ and C of the child that returned before and after their\n\
         update, and the errors of the update for the state N time steps back (Thesis\n\
         Algorithm 2.4, Equations 3.4 and 3.5).\n\
         In worlds of cells, the cells show V(root) and the greedy actions after the step.\n\
         \n\
         The rollout learns on a copy and does not affect evolution."
    }
}
