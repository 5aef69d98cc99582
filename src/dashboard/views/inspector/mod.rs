//! The inspector: the selected individual in detail.

mod ancestry;
mod chart;
mod curve;
mod selection;
mod values;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::text::Line;

use super::shared::{
    BEFORE_TREE, below, click_node, draw_no_individual, line_of, right_of, subject,
};
use super::view::View;
use crate::dashboard::context::Clicked;
use crate::dashboard::context::Effect;
use crate::dashboard::context::Subject;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, last_start, number};
use crate::dashboard::look::{Paint, put};
use crate::hierarchy::{TreeLine, folded_lines, lines, to_dot};
use crate::lab::inspection::{Lineage, Profile, lineage};
use crate::learning::SelectionProbabilities;
use values::ProfileChoice;

/// From this size on, all pages are shown at once.
const ROOMY: (u16, u16) = (110, 32);

/// From this many columns on, lineage and curve stand side by side.
const SIDE_BY_SIDE: u16 = 90;
/// Columns of a folded tree.
const FOLDED: usize = 34;
/// Columns reserved for a page beside the tree.
const PAGE: u16 = 34;

/// The selected individual: its tree, and as pages beside it the learned values of the selected
/// subtask, the selection probabilities, the lineage, and learning curves.
///
/// ```text
///  ╭ Inspector  individual 362, generation 26 ──────────────────────────╮
///  │ ▸ Root      τ 0.41 12× │ ▸Values Selection Lineage Curve            │
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
    Curve,
}

impl Page {
    const ALL: [Self; 4] = [Self::Values, Self::Selection, Self::Lineage, Self::Curve];

    fn title(self) -> &'static str {
        match self {
            Self::Values => "Values",
            Self::Selection => "Selection",
            Self::Lineage => "Lineage",
            Self::Curve => "Curve",
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
    /// Mean time steps per trial of the line of descent, generation by generation.
    course: Vec<(u64, f64)>,
}

impl Inspector {
    /// Returns the lines of the tree, folded if there are more than `rows`, each with what is
    /// written of it.
    fn tree_lines(&self, context: &ViewContext, rows: u16) -> Vec<(TreeLine, Line<'static>)> {
        let look = &context.look;
        let Some(inspected) = context.player.individual() else {
            return Vec::new();
        };
        let hierarchy = &inspected.individual.hierarchy;
        let tree = hierarchy.tree();
        let rollout = context.player.rollout();
        let visits = rollout.map(|rollout| &rollout.status().visits);
        let count = |node: usize| {
            let count = visits.and_then(|visits| visits.get(node));
            count.map_or(String::new(), |count| {
                format!("{count}{}", look.signs.times)
            })
        };
        let (catalogue, glyphs) = (context.catalogue(), look.signs.tree);
        let lines = if tree.nodes().len() <= usize::from(rows) {
            lines(tree, catalogue, glyphs)
        } else {
            folded_lines(tree, catalogue, glyphs, FOLDED, |node| {
                tree.subtask(node).name(catalogue).to_owned()
            })
        };
        let alone = lines.iter().filter(|line| line.nodes.len() == 1);
        let room = alone.map(TreeLine::width).max().unwrap_or(0) + 1;
        let selected = context.node_in(tree);
        let written = lines.into_iter().map(|line| {
            let sign = if line.has(selected) {
                Pen::new(look).text(look.signs.pointer, Paint::Selected)
            } else {
                Pen::new(look).text(" ", Paint::Text)
            };
            let [only] = line.nodes.as_slice() else {
                let pen = several(sign.text(" ", Paint::Text), &line, selected);
                return (line, pen.line());
            };
            let values = hierarchy.values().get(only.node).and_then(Option::as_ref);
            let paint = match (only.node == selected, values.is_some()) {
                (true, _) => Paint::Selected,
                (false, true) => Paint::Title,
                (false, false) => Paint::Text,
            };
            let text = format!("{}{}", line.branches, only.text);
            let tau = values.map(|values| number(values.temperature));
            let tau = tau.map_or(String::new(), |tau| format!("{} {tau}", look.signs.tau));
            let pen = sign
                .text(" ", paint)
                .cell(&text, room, paint)
                .cell(&tau, 7, Paint::Dim)
                .right(&count(only.node), 6, Paint::Text);
            (line, pen.line())
        });
        written.collect()
    }

    fn page_lines(&self, context: &ViewContext, page: Page, columns: usize) -> Vec<Line<'static>> {
        let Some(computed) = &self.computed else {
            return Vec::new();
        };
        match page {
            Page::Values | Page::Curve => Vec::new(),
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
            Page::Curve => curve::draw(context, &computed.course, inside, buffer),
            Page::Selection | Page::Lineage => {
                let lines = self.page_lines(context, page, inside.width.into());
                let scroll = if page == self.page { self.scroll } else { 0 };
                draw_lines(&context.look, &lines, scroll, inside, buffer);
            }
        }
    }

    /// Returns the lines of the tree, their area, and the number of lines scrolled out above it.
    fn place_of_tree(&self, context: &ViewContext, area: Rect) -> PlacedTree {
        let count = |lines: usize| u16::try_from(lines).unwrap_or(u16::MAX);
        let is_roomy = Self::is_roomy(area);
        let rows = if is_roomy {
            (area.height / 2).saturating_sub(1)
        } else {
            area.height
        };
        let lines = self.tree_lines(context, rows);
        let place = if is_roomy {
            let [left, _] = columns(area, 2 * area.width / 5);
            let [above, _] = self::rows(left, (count(lines.len()) + 1).min(left.height / 2));
            above
        } else {
            let widest = lines.iter().map(|(_, line)| line.width()).max();
            let most = area.width.saturating_sub(PAGE).max(area.width / 2);
            let [left, _] = columns(area, count(widest.unwrap_or(0)).min(most));
            left
        };
        let (lines, written): (Vec<_>, Vec<_>) = lines.into_iter().unzip();
        let selected = context
            .player
            .tree()
            .map_or(0, |tree| context.node_in(tree));
        let skipped = line_of(&lines, selected).saturating_sub(usize::from(place.height / 2));
        PlacedTree {
            skipped: skipped.min(last_start(lines.len(), place.height)),
            lines,
            written,
            place,
        }
    }

    /// Draws the tree and all pages.
    fn draw_roomy(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let [left, right] = columns(area, 2 * area.width / 5);
        let tree = self.place_of_tree(context, area);
        let [_, selection] = rows(left, tree.place.height);
        let [values, others] = rows(right, right.height * 3 / 5);
        tree.draw(context, buffer);
        for (page, area) in [(Page::Values, values), (Page::Selection, selection)] {
            title(context, page, page == self.page, area, buffer);
            self.draw_page(context, page, area, buffer);
        }
        self.draw_history(context, others, buffer);
    }

    /// Draws lineage and curve side by side, or where there is little room one of them.
    fn draw_history(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let pages = [Page::Lineage, Page::Curve];
        if area.width >= SIDE_BY_SIDE {
            let sides = columns(area, area.width / 2);
            for (page, area) in pages.into_iter().zip(sides) {
                title(context, page, page == self.page, area, buffer);
                self.draw_page(context, page, area, buffer);
            }
            return;
        }
        let mut column = 0;
        for page in pages {
            let place = right_of(area, column);
            column += title(context, page, page == self.page, place, buffer);
        }
        let shown = usize::from(self.page == Page::Curve);
        self.draw_page(context, pages[shown], area, buffer);
    }

    /// Draws the tree and one page.
    fn draw_narrow(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let tree = self.place_of_tree(context, area);
        let [_, right] = columns(area, tree.place.width);
        tree.draw(context, buffer);
        let mut column = 0;
        for page in Page::ALL {
            let area = right_of(right, column);
            column += title(context, page, page == self.page, area, buffer);
        }
        self.draw_page(context, self.page, right, buffer);
    }

    fn is_roomy(area: Rect) -> bool {
        area.width >= ROOMY.0 - 2 && area.height >= ROOMY.1 - 4
    }
}

/// The tree, and where it stands.
struct PlacedTree {
    lines: Vec<TreeLine>,
    /// What is written of each line.
    written: Vec<Line<'static>>,
    place: Rect,
    /// Lines scrolled out above.
    skipped: usize,
}

impl PlacedTree {
    fn draw(&self, context: &ViewContext, buffer: &mut Buffer) {
        let (look, place) = (&context.look, self.place);
        draw_lines(look, &self.written, self.skipped, place, buffer);
    }
}

/// Writes several nodes of a line.
fn several<'l>(mut pen: Pen<'l>, line: &TreeLine, selected: usize) -> Pen<'l> {
    pen = pen.text(line.branches.clone(), Paint::Text);
    for text in &line.nodes {
        let paint = if text.node == selected {
            Paint::Selected
        } else {
            Paint::Text
        };
        pen = pen.to(usize::from(BEFORE_TREE) + text.column);
        pen = pen.text(text.text.clone(), paint);
    }
    pen
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
        let PlacedTree {
            lines,
            place,
            skipped,
            ..
        } = self.place_of_tree(context, area);
        click_node(context, &lines, (place, skipped), at)
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
            .take_while(|record| record.generation <= subject.generation)
            .map(|record| &**record);
        let lineage = lineage(until.clone(), subject.id);
        let course = lineage.as_ref().map(|lineage| lineage.course(until));
        self.computed = Some(Computed {
            subject,
            node,
            profiles,
            selection: context.experiment.selection(inspected),
            lineage,
            course: course.unwrap_or_default(),
        });
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let computed = self.computed.as_ref()?;
        Some(match self.page {
            Page::Values => values::csv(&computed.profiles),
            Page::Selection => selection::csv(context, &computed.selection),
            Page::Lineage => ancestry::csv(computed.lineage.as_ref()?),
            Page::Curve => curve::csv(context, &computed.course),
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
         first generation: what it inherited from whom, and what was reset: what stood above the\n\
         crossover site (Thesis 3.2), or with reset: child what the site's parent knew of the\n\
         new subtask. Curve: mean time steps per trial, of the rollout\n\
         trial after trial as the individual learns while it lives, and of its line of descent\n\
         from generation to generation, as it inherits what its ancestors have learned."
    }
}
