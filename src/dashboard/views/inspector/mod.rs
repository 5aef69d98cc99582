//! The inspector: the selected individual in detail.

mod ancestry;
mod chart;
mod selection;
mod values;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::text::Line;

use super::shared::{below, click_node, draw_no_individual, right_of, subject};
use super::view::View;
use crate::dashboard::context::Clicked;
use crate::dashboard::context::Effect;
use crate::dashboard::context::Subject;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, last_start, number};
use crate::dashboard::look::{Paint, put, width};
use crate::hierarchy::{draw, to_dot};
use crate::lab::inspection::{Lineage, Profile, lineage};
use crate::learning::SelectionProbabilities;
use values::ProfileChoice;

/// From this size on, all pages are shown at once.
const ROOMY: (u16, u16) = (110, 32);

/// Columns reserved for a page beside the tree.
const PAGE: u16 = 34;

/// The selected individual: its tree, and as pages beside it the learned values of the selected
/// subtask, the selection probabilities, and the lineage.
///
/// ```text
///  ╭ Inspector  individual 362, generation 26 ──────────────────────────╮
///  │ ▸ Root      τ 0.41 12× │ ▸Values   Selection   Lineage              │
///  │   ├─ FindBattery τ ... │ C~+V over surroundings, state type 1 (1/4) │
///  │   │  └─ Avoid          │                 FindBattery   Wander       │
///  │   └─ ApproachBattery   │ open               ▸ -3.21    -5.40        │
///  ╰─────────────────────────────────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct Inspector {
    page: Page,
    scroll: usize,
    choice: ProfileChoice,
    computed: Option<Computed>,
}

/// A page beside the tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Values,
    Selection,
    Lineage,
}

impl Page {
    const ALL: [Self; 3] = [Self::Values, Self::Selection, Self::Lineage];

    fn title(self) -> &'static str {
        match self {
            Self::Values => "Values",
            Self::Selection => "Selection",
            Self::Lineage => "Lineage",
        }
    }

    fn turned(self, by: usize) -> Self {
        let here = Self::ALL.iter().position(|&page| page == self);
        Self::ALL[(here.unwrap_or(0) + by) % Self::ALL.len()]
    }
}

/// What has been computed, and for which individual and node.
struct Computed {
    subject: Subject,
    node: usize,
    profiles: Vec<Profile>,
    selection: SelectionProbabilities,
    lineage: Option<Lineage>,
}

impl Inspector {
    fn tree_lines(&self, context: &ViewContext) -> Vec<Line<'static>> {
        let look = &context.look;
        let Some(inspected) = context.player.individual() else {
            return Vec::new();
        };
        let hierarchy = &inspected.individual.hierarchy;
        let drawn = draw(hierarchy.tree(), context.catalogue(), look.signs.tree);
        let room = drawn.iter().map(|line| width(line)).max().unwrap_or(0) + 1;
        let rollout = context.player.rollout();
        let visits = rollout.map(|rollout| &rollout.status().visits);
        let selected = context.node_in(hierarchy.tree());
        let lines = drawn.into_iter().zip(hierarchy.values()).enumerate();
        let lines = lines.map(|(node, (line, values))| {
            let (sign, paint) = match (node == selected, values.is_some()) {
                (true, _) => (look.signs.pointer, Paint::Selected),
                (false, true) => (" ", Paint::Title),
                (false, false) => (" ", Paint::Text),
            };
            let tau = values.as_ref().map(|values| number(values.temperature));
            let tau = tau.map_or(String::new(), |tau| format!("{} {tau}", look.signs.tau));
            let count = visits.and_then(|visits| visits.get(node));
            let count = count.map(|count| format!("{count}{}", look.signs.times));
            Pen::new(look)
                .text(format!("{sign} "), paint)
                .cell(&line, room, paint)
                .cell(&tau, 7, Paint::Dim)
                .right(&count.unwrap_or_default(), 6, Paint::Text)
                .line()
        });
        lines.collect()
    }

    fn page_lines(&self, context: &ViewContext, page: Page, columns: usize) -> Vec<Line<'static>> {
        let Some(computed) = &self.computed else {
            return Vec::new();
        };
        match page {
            Page::Values => Vec::new(),
            Page::Selection => selection::lines(context, &computed.selection, columns),
            Page::Lineage => match &computed.lineage {
                Some(lineage) => ancestry::lines(context, lineage, columns),
                None => Vec::new(),
            },
        }
    }

    /// Draws a page, leaving the first row of the area for its title.
    fn draw_page(&self, context: &ViewContext, page: Page, area: Rect, buffer: &mut Buffer) {
        let Some(computed) = &self.computed else {
            return;
        };
        let inside = below(area, 1);
        match page {
            Page::Values => self
                .choice
                .draw(context, &computed.profiles, inside, buffer),
            _ => {
                let lines = self.page_lines(context, page, inside.width.into());
                let scroll = if page == self.page { self.scroll } else { 0 };
                draw_lines(&context.look, &lines, scroll, inside, buffer);
            }
        }
    }

    /// Returns the area of the tree, and the number of lines scrolled out above it.
    fn place_of_tree(&self, context: &ViewContext, area: Rect) -> (Rect, usize) {
        let lines = self.tree_lines(context);
        let count = |lines: usize| u16::try_from(lines).unwrap_or(u16::MAX);
        if Self::is_roomy(area) {
            let [left, _] = columns(area, 2 * area.width / 5);
            let [above, _] = rows(left, (count(lines.len()) + 1).min(left.height / 2));
            return (above, 0);
        }
        let widest = lines.iter().map(Line::width).max().unwrap_or(0);
        let most = area.width.saturating_sub(PAGE).max(area.width / 2);
        let [left, _] = columns(area, count(widest).min(most));
        let skipped = context.node.saturating_sub(usize::from(left.height / 2));
        (left, skipped.min(last_start(lines.len(), left.height)))
    }

    /// Draws the tree and all pages.
    fn draw_roomy(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let [left, right] = columns(area, 2 * area.width / 5);
        let (above, _) = self.place_of_tree(context, area);
        let [_, selection] = rows(left, above.height);
        let [values, lineage] = rows(right, right.height * 3 / 5);
        draw_lines(&context.look, &self.tree_lines(context), 0, above, buffer);
        for (page, area) in [
            (Page::Values, values),
            (Page::Selection, selection),
            (Page::Lineage, lineage),
        ] {
            title(context, page, page == self.page, area, buffer);
            self.draw_page(context, page, area, buffer);
        }
    }

    /// Draws the tree and one page.
    fn draw_narrow(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let lines = self.tree_lines(context);
        let (left, skipped) = self.place_of_tree(context, area);
        let [_, right] = columns(area, left.width);
        draw_lines(&context.look, &lines, skipped, left, buffer);
        let mut column = 0;
        for page in Page::ALL {
            let area = right_of(right, column);
            column += title(context, page, page == self.page, area, buffer) + 1;
        }
        self.draw_page(context, self.page, right, buffer);
    }

    fn is_roomy(area: Rect) -> bool {
        area.width >= ROOMY.0 - 2 && area.height >= ROOMY.1 - 4
    }
}

/// Writes the title of a page; returns the columns used.
fn title(
    context: &ViewContext,
    page: Page,
    has_focus: bool,
    area: Rect,
    buffer: &mut Buffer,
) -> u16 {
    let (sign, paint) = if has_focus {
        (context.look.signs.pointer, Paint::Focus)
    } else {
        (" ", Paint::Title)
    };
    let text = format!("{sign}{}", page.title());
    put(buffer, area, (0, 0), &text, context.look.style(paint))
}

/// Splits an area into two columns with a gap; `left` is the width of the first.
fn columns(area: Rect, left: u16) -> [Rect; 2] {
    let left = Constraint::Length(left.min(area.width));
    let columns = Layout::horizontal([left, Constraint::Fill(1)]);
    columns.spacing(2).areas(area)
}

/// Splits an area into two rows with a gap; `above` is the height of the first.
fn rows(area: Rect, above: u16) -> [Rect; 2] {
    let above = Constraint::Length(above.min(area.height));
    let rows = Layout::vertical([above, Constraint::Fill(1)]);
    rows.spacing(1).areas(area)
}

impl View for Inspector {
    fn name(&self) -> &'static str {
        "inspector"
    }

    fn title(&self) -> &'static str {
        "Inspector"
    }

    fn needs_rollout(&self) -> bool {
        true
    }

    fn caption(&self, context: &ViewContext) -> String {
        subject(context)
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        if self.computed.is_none() {
            draw_no_individual(context, area, buffer);
        } else if Self::is_roomy(area) {
            self.draw_roomy(context, area, buffer);
        } else {
            self.draw_narrow(context, area, buffer);
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[
            Action::Down,
            Action::Mode,
            Action::NextPanel,
            Action::ViewCompare,
        ]
    }

    fn can(&self, context: &ViewContext, action: Action) -> bool {
        let nodes = context.player.tree().map_or(0, |tree| tree.nodes().len());
        let computed = self.computed.is_some();
        match action {
            Action::Down => nodes > 1,
            Action::NextPanel => computed,
            Action::Mode => computed && self.choice.has_quantities(),
            _ => true,
        }
    }

    fn act(&mut self, context: &mut ViewContext, action: Action) -> Option<Vec<Effect>> {
        let scrolls = self.page == Page::Lineage;
        let nodes = context.player.tree().map_or(1, |tree| tree.nodes().len());
        match action {
            Action::NextPanel => self.page = self.page.turned(1),
            Action::PreviousPanel => self.page = self.page.turned(Page::ALL.len() - 1),
            Action::Up if scrolls => self.scroll = self.scroll.saturating_sub(1),
            Action::Down if scrolls => self.scroll += 1,
            Action::PageUp => self.scroll = self.scroll.saturating_sub(10),
            Action::PageDown => self.scroll += 10,
            Action::Up => context.node = context.node.min(nodes - 1).saturating_sub(1),
            Action::Down => context.node = (context.node + 1).min(nodes - 1),
            Action::Top => context.node = 0,
            Action::Bottom => context.node = nodes - 1,
            Action::Mode => self.choice.next_quantity(),
            Action::Left => self.choice.turn(-1),
            Action::Right => self.choice.turn(1),
            _ => return None,
        }
        Some(Vec::new())
    }

    fn click(&mut self, context: &mut ViewContext, area: Rect, at: Position) -> Clicked {
        let nodes = context.player.tree().map_or(0, |tree| tree.nodes().len());
        click_node(context, nodes, self.place_of_tree(context, area), at)
    }

    fn prepare(&mut self, context: &ViewContext) {
        let Some((inspected, subject)) = context.player.individual().zip(context.player.subject())
        else {
            self.computed = None;
            return;
        };
        let node = context.node_in(inspected.individual.hierarchy.tree());
        let lines = self.page_lines(context, self.page, context.size.0.into());
        self.scroll = self.scroll.min(last_start(lines.len(), 3));
        let current = self.computed.as_ref();
        if current.is_some_and(|of| of.subject == subject && of.node == node) {
            return;
        }
        let profiles = context.experiment.profiles(inspected, node);
        self.choice.fit(&profiles);
        if let Some(computed) = self.computed.as_mut().filter(|of| of.subject == subject) {
            computed.profiles = profiles;
            computed.node = node;
            return;
        }
        let records = context.history().generations();
        let until = records
            .iter()
            .take_while(|record| record.generation <= subject.generation);
        self.computed = Some(Computed {
            subject,
            node,
            profiles,
            selection: context.experiment.selection(inspected),
            lineage: lineage(until.map(|record| &**record), subject.id),
        });
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let computed = self.computed.as_ref()?;
        Some(match self.page {
            Page::Values => values::csv(&computed.profiles),
            Page::Selection => selection::csv(context, &computed.selection),
            Page::Lineage => ancestry::csv(computed.lineage.as_ref()?),
        })
    }

    fn dot(&self, context: &ViewContext) -> Option<String> {
        match self.page {
            Page::Lineage => Some(ancestry::dot(self.computed.as_ref()?.lineage.as_ref()?)),
            _ => Some(to_dot(context.player.tree()?, context.catalogue())),
        }
    }

    fn help_text(&self) -> &'static str {
        "An individual in detail. Beside its tree stand the temperatures that it starts the\n\
         rollout with, and how often the rollout has invoked each subtask. Values: what the\n\
         selected subtask has learned, over the inputs that it observes: Q of the actions of a\n\
         primitive subtask (Thesis Figure 4.3); C~, C and V of the children of a composite\n\
         subtask, and C~+V, by which it chooses. Selection: the primitive subtasks that the\n\
         policy ends in, for each state type. Lineage: how the individual was made, back to the\n\
         first generation: what it inherited from whom, and what was reset because it stood\n\
         above the crossover site (Thesis 3.2)."
    }
}
