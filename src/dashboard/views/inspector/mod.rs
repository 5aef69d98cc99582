//! The inspector: the selected individual, taken apart.

mod ancestry;
mod chart;
mod selection;
mod values;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::text::Line;

use super::shared::nobody;
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::Subject;
use crate::dashboard::context::ViewContext;
use crate::dashboard::context::{Clicked, line_at};
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, last_start, number};
use crate::dashboard::look::{Paint, put, width};
use crate::hierarchy::{draw, to_dot};
use crate::lab::inspection::{Lineage, Profile, lineage};
use crate::learning::SelectionProbabilities;
use values::Shelf;

/// Size from which on all pages are shown at once.
const ROOMY: (u16, u16) = (110, 32);

/// Columns that a page needs beside the tree.
const PAGE: u16 = 34;

/// The selected individual: its tree, the learned values of the subtask under the cursor,
/// its selection probabilities, and where it comes from.
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
    shelf: Shelf,
    known: Option<Known>,
}

/// What is shown beside the tree.
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

/// What has been worked out, and for whom.
struct Known {
    subject: Subject,
    node: usize,
    profiles: Vec<Profile>,
    selection: SelectionProbabilities,
    lineage: Option<Lineage>,
}

impl Inspector {
    fn tree_lines(&self, context: &ViewContext) -> Vec<Line<'static>> {
        let look = &context.look;
        let Some(individual) = context.player.individual() else {
            return Vec::new();
        };
        let hierarchy = &individual.individual.hierarchy;
        let drawn = draw(hierarchy.tree(), context.catalogue(), look.signs.tree);
        let room = drawn.iter().map(|line| width(line)).max().unwrap_or(0) + 1;
        let visits = context
            .player
            .rollout()
            .map(|rollout| &rollout.status().visits);
        let selected = context.node_in(hierarchy.tree());
        let values = drawn.into_iter().zip(hierarchy.values()).enumerate();
        values
            .map(|(node, (line, values))| {
                let here = node == selected;
                let (sign, paint) = match (here, values.is_some()) {
                    (true, _) => (look.signs.pointer, Paint::Selected),
                    (false, true) => (" ", Paint::Title),
                    (false, false) => (" ", Paint::Text),
                };
                let pen = Pen::new(look).text(format!("{sign} "), paint);
                let pen = pen.cell(&line, room, paint);
                let tau = values.as_ref().map_or(String::new(), |values| {
                    format!("{} {}", look.signs.tau, number(values.temperature))
                });
                let count = visits.and_then(|visits| visits.get(node));
                let count = count.map_or(String::new(), |count| {
                    format!("{count}{}", look.signs.times)
                });
                pen.cell(&tau, 7, Paint::Dim)
                    .right(&count, 6, Paint::Text)
                    .line()
            })
            .collect()
    }

    fn page_lines(&self, context: &ViewContext, page: Page, columns: usize) -> Vec<Line<'static>> {
        let Some(known) = &self.known else {
            return Vec::new();
        };
        match page {
            Page::Values => Vec::new(),
            Page::Selection => selection::lines(context, &known.selection, columns),
            Page::Lineage => match &known.lineage {
                Some(lineage) => ancestry::lines(context, lineage, columns),
                None => Vec::new(),
            },
        }
    }

    /// Draws a page below a line with its title.
    fn draw_page(&self, context: &ViewContext, page: Page, area: Rect, buffer: &mut Buffer) {
        let Some(known) = &self.known else { return };
        let inside = Rect {
            y: area.y + area.height.min(1),
            height: area.height.saturating_sub(1),
            ..area
        };
        match page {
            Page::Values => self.shelf.draw(context, &known.profiles, inside, buffer),
            _ => {
                let lines = self.page_lines(context, page, inside.width.into());
                let scroll = if page == self.page { self.scroll } else { 0 };
                draw_lines(&context.look, &lines, scroll, inside, buffer);
            }
        }
    }

    /// The area of the tree, and how many of its lines are above it.
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

    /// Everything at once.
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

    /// The tree and one page.
    fn draw_narrow(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let lines = self.tree_lines(context);
        let (left, skipped) = self.place_of_tree(context, area);
        let [_, right] = columns(area, left.width);
        draw_lines(&context.look, &lines, skipped, left, buffer);
        let mut column = 0;
        for page in Page::ALL {
            let area = Rect {
                x: right.x + column,
                width: right.width.saturating_sub(column),
                ..right
            };
            column += title(context, page, page == self.page, area, buffer) + 1;
        }
        self.draw_page(context, self.page, right, buffer);
    }

    fn is_roomy(area: Rect) -> bool {
        area.width >= ROOMY.0 - 2 && area.height >= ROOMY.1 - 4
    }
}

/// Writes the title of a page; returns its columns.
fn title(
    context: &ViewContext,
    page: Page,
    has_focus: bool,
    area: Rect,
    buffer: &mut Buffer,
) -> u16 {
    let (sign, paint) = match has_focus {
        true => (context.look.signs.pointer, Paint::Focus),
        false => (" ", Paint::Title),
    };
    let text = format!("{sign}{}", page.title());
    put(buffer, area, (0, 0), &text, context.look.style(paint))
}

/// Two columns with a gap, the left one so wide.
fn columns(area: Rect, left: u16) -> [Rect; 2] {
    let columns = [
        Constraint::Length(left.min(area.width)),
        Constraint::Fill(1),
    ];
    Layout::horizontal(columns).spacing(2).areas(area)
}

/// Two rows with a gap, the upper one so high.
fn rows(area: Rect, above: u16) -> [Rect; 2] {
    let rows = [
        Constraint::Length(above.min(area.height)),
        Constraint::Fill(1),
    ];
    Layout::vertical(rows).spacing(1).areas(area)
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
        let subject = context.player.subject();
        subject.map_or(String::new(), |subject| subject.to_string())
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        if self.known.is_none() {
            nobody(context, area, buffer);
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
        let known = self.known.is_some();
        match action {
            Action::Down => nodes > 1,
            Action::NextPanel => known,
            Action::Mode => known && self.shelf.has_quantities(),
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
            Action::Mode => self.shelf.next_quantity(),
            Action::Left => self.shelf.turn(-1),
            Action::Right => self.shelf.turn(1),
            _ => return None,
        }
        Some(Vec::new())
    }

    fn click(&mut self, context: &mut ViewContext, area: Rect, at: Position) -> Clicked {
        let (place, skipped) = self.place_of_tree(context, area);
        let Some(tree) = context.player.tree() else {
            return Clicked::Nothing;
        };
        let node = line_at(at, place, 0).map(|line| line + skipped);
        let node = node.filter(|node| *node < tree.nodes().len());
        Clicked::on(node, context.node_in(tree), |node| context.node = node)
    }

    fn prepare(&mut self, context: &ViewContext) {
        let Some((individual, subject)) = context.player.individual().zip(context.player.subject())
        else {
            self.known = None;
            return;
        };
        let node = context.node_in(individual.individual.hierarchy.tree());
        let lines = self
            .page_lines(context, self.page, context.size.0.into())
            .len();
        self.scroll = self.scroll.min(last_start(lines, 3));
        let same = self.known.as_ref().filter(|known| known.subject == subject);
        if same.is_some_and(|known| known.node == node) {
            return;
        }
        let profiles = context.experiment.profiles(individual, node);
        self.shelf.fit(&profiles);
        if let Some(known) = self.known.as_mut().filter(|known| known.subject == subject) {
            known.profiles = profiles;
            known.node = node;
            return;
        }
        let records = context.history().generations();
        let until = records
            .iter()
            .take_while(|record| record.generation <= subject.generation);
        self.known = Some(Known {
            subject,
            node,
            profiles,
            selection: context.experiment.selection(individual),
            lineage: lineage(until.map(|record| &**record), subject.id),
        });
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let known = self.known.as_ref()?;
        Some(match self.page {
            Page::Values => values::csv(&known.profiles),
            Page::Selection => selection::csv(context, &known.selection),
            Page::Lineage => ancestry::csv(known.lineage.as_ref()?),
        })
    }

    fn dot(&self, context: &ViewContext) -> Option<String> {
        match self.page {
            Page::Lineage => Some(ancestry::dot(self.known.as_ref()?.lineage.as_ref()?)),
            _ => Some(to_dot(context.player.tree()?, context.catalogue())),
        }
    }

    fn help_text(&self) -> &'static str {
        "An individual, taken apart. Move along its tree, beside it the temperatures that it came\n\
         with and how often each subtask was invoked in the rollout. Values: what the subtask under the\n\
         cursor has learned - Q of a primitive subtask's actions (Thesis Figure 4.3); C~, C, V\n\
         of a composite one's children, and C~+V, which it chooses by - over the inputs it\n\
         looks at. Selection: in which primitive subtask its policy ends, for each state type.\n\
         Lineage: how it was made, back to the start: inherited from whom, and what was reset,\n\
         because it stood above the crossover site (Thesis 3.2)."
    }
}
