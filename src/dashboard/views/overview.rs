//! The overview: the panels of the other views, side by side.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};

use super::policy;
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::width;
use crate::dashboard::view_id::ViewId;

/// The overview of a run; the dashboard draws its [`panels`].
pub(super) struct Overview;

/// From this many columns on there are six panels, in fewer columns four.
const WIDE: u16 = 110;
/// Fewest columns of the arena panel.
const ARENA: u16 = 30;
/// Fewest columns of the population panel.
const POPULATION: u16 = 44;
/// Columns of the status panel.
const STATUS: u16 = 36;

/// Returns the panels of the overview with their areas, in the order of the Tab key.
///
/// ```text
///   110 columns and more:                  fewer columns:
///  ╭ Arena ──╮╭ Hierarchy ─╮╭ Status ─╮    ╭ Arena ──────╮╭ Hierarchy ─╮
///  │         ││            ││         │    │             ││            │
///  ╰─────────╯╰────────────╯╰─────────╯    ╰─────────────╯╰────────────╯
///  ╭ Fitness ╮╭ Policy ────╮╭ Popul. ─╮    ╭ Fitness ────╮╭ Population ╮
///  ╰─────────╯╰────────────╯╰─────────╯    ╰─────────────╯╰────────────╯
/// ```
pub(in crate::dashboard) fn panels(area: Rect, context: &ViewContext) -> Vec<(ViewId, Rect)> {
    let upper = area.height * 14 / 25;
    let rows = Layout::vertical([Constraint::Length(upper), Constraint::Fill(1)]);
    let [above, below] = rows.areas(area);
    // In the world's proportions: a terminal cell is about twice as high as wide.
    let [width, height] = context.scenery().extent;
    let arena = f64::from(upper.saturating_sub(2)) * 2.0 * width / height;
    let most = if area.width < WIDE {
        area.width / 2
    } else {
        area.width * 2 / 5
    };
    let arena = (arena as u16 + 2).max(ARENA).min(most);
    if area.width < WIDE {
        let upper = [Constraint::Length(arena), Constraint::Fill(1)];
        let [arena, hierarchy] = columns(above, upper);
        let [fitness, population] = columns(below, [Constraint::Fill(1), Constraint::Fill(1)]);
        return vec![
            (ViewId::Arena, arena),
            (ViewId::Hierarchy, hierarchy),
            (ViewId::Fitness, fitness),
            (ViewId::Population, population),
        ];
    }
    let upper = [
        Constraint::Length(arena),
        Constraint::Fill(1),
        Constraint::Length(STATUS),
    ];
    let [arena, hierarchy, status] = columns(above, upper);
    let lower = [
        Constraint::Fill(1),
        Constraint::Length(policy_columns(context, area.width)),
        Constraint::Length((area.width * 4 / 13).max(POPULATION)),
    ];
    let [fitness, policy, population] = columns(below, lower);
    vec![
        (ViewId::Arena, arena),
        (ViewId::Hierarchy, hierarchy),
        (ViewId::Status, status),
        (ViewId::Fitness, fitness),
        (ViewId::Policy, policy),
        (ViewId::Population, population),
    ]
}

/// Returns the columns of the policy panel: wide enough for the longest state type, within limits.
fn policy_columns(context: &ViewContext, all: u16) -> u16 {
    let types = context.catalogue().state_types.iter().enumerate();
    let longest = types.map(|(index, info)| width(&policy::title(index, &info.description)));
    let wanted = longest.max().unwrap_or(0) + 4;
    let wanted = u16::try_from(wanted).unwrap_or(u16::MAX);
    wanted.min(all * 3 / 8).max(all * 4 / 13)
}

fn columns<const N: usize>(area: Rect, widths: [Constraint; N]) -> [Rect; N] {
    Layout::horizontal(widths).areas(area)
}

impl View for Overview {
    fn name(&self) -> &'static str {
        "overview"
    }

    fn title(&self) -> &'static str {
        "Overview"
    }

    fn draw(&self, _context: &ViewContext, _area: Rect, _buffer: &mut Buffer) {}

    fn hints(&self) -> &'static [Action] {
        &[]
    }

    fn help_text(&self) -> &'static str {
        "A population of MAXQ task hierarchies evolves in one world. In every generation each\n\
         individual learns while it acts; all face the same trials, and fewer time steps are\n\
         better. The best survive, typed crossover of good individuals replaces the rest, and\n\
         offspring inherit what their parents have learned. Watch how the time steps fall, the\n\
         structures become alike, and the policies settle.\n\
         \n\
         Tab moves the focus from panel to panel, Enter opens the panel in focus, ? explains it."
    }
}
