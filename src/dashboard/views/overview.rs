//! Everything at a glance.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};

use super::policy;
use super::view::View;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::width;
use crate::dashboard::view_id::ViewId;

/// Everything at a glance: the panels, as many as there is room for.
pub(super) struct Overview;

/// Columns below which there is room for four panels only.
const WIDE: u16 = 110;
/// Least columns of the arena.
const ARENA: u16 = 30;
/// Least columns of the population.
const POPULATION: u16 = 44;
/// Columns of the status panel.
const STATUS: u16 = 36;

/// The panels on an area, in the order of the Tab key.
///
/// ```text
///   from 110 columns on:                   below:
///  ╭ Arena ──╮╭ Hierarchy ─╮╭ Status ─╮    ╭ Arena ──────╮╭ Hierarchy ─╮
///  │         ││            ││         │    │             ││            │
///  ╰─────────╯╰────────────╯╰─────────╯    ╰─────────────╯╰────────────╯
///  ╭ Fitness ╮╭ Policy ────╮╭ Popul. ─╮    ╭ Fitness ────╮╭ Population ╮
///  ╰─────────╯╰────────────╯╰─────────╯    ╰─────────────╯╰────────────╯
/// ```
pub(in crate::dashboard) fn panels(area: Rect, context: &ViewContext) -> Vec<(ViewId, Rect)> {
    let upper = area.height * 14 / 25;
    let rows = Layout::vertical([Constraint::Length(upper), Constraint::Fill(1)]).areas(area);
    let [above, below]: [Rect; 2] = rows;
    // As wide as the world is for its height, cells being about twice as high as wide.
    let [width, height] = context.scenery().extent;
    let arena = f64::from(upper.saturating_sub(2)) * 2.0 * width / height;
    let most = match area.width < WIDE {
        true => area.width / 2,
        false => area.width * 2 / 5,
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

/// Columns of the policy panel: a share of all, and those of the longest name of a state type.
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

    fn draw(&self, _desk: &ViewContext, _area: Rect, _buffer: &mut Buffer) {}

    fn hints(&self) -> &'static [Action] {
        &[]
    }

    fn help_text(&self) -> &'static str {
        "A population of MAXQ task hierarchies lives in one world. In every generation each\n\
         learns while it acts in the same trials; the fewest time steps win. The best live on,\n\
         typed crossover of the good replaces the rest, and offspring inherit what their\n\
         parents have learned. Watch fitness fall, structures become alike, and policies settle.\n\
         \n\
         Tab moves the focus from panel to panel, Enter opens one, ? explains it."
    }
}
