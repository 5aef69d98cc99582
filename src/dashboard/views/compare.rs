//! The comparison view: two individuals side by side.

use std::collections::{BTreeMap, BTreeSet};

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::policy::SMALL;
use super::shared::{csv_line, draw_note, keys, line};
use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::{Chosen, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, last_start, percent};
use crate::dashboard::look::{Paint, put, width, wrapped};
use crate::dashboard::view_id::ViewId;
use crate::evolution::RankedRecord;
use crate::hierarchy::{Tree, draw, structural_difference, to_dot};
use crate::lab::inspection::InspectedIndividual;
use crate::learning::SelectionProbabilities;
use crate::worlds::SubtaskId;

/// Selection probabilities that differ by at least this much are marked.
const MARKED: f64 = 0.1;

/// The selected individual beside the marked one, with their differences marked.
///
/// ```text
///  ╭ Comparison  structural difference -3 ────────────────────────────────╮
///  │ individual 362, generation 26      individual 340, generation 26      │
///  │ selected: rank 1, 128.6 steps      marked: rank 4, 141.2 steps        │
///  │   Root                               Root                             │
///  │   ├─ FindBattery                     ├─ FindBattery                   │
///  │ + │  └─ Avoid                      + │  └─ Wander                     │
///  │ selects, by state type             selects, by state type            │
///  │ 1 +Avoid 61 %  Wander 39 %         1 +Wander 100 %                   │
///  ╰───────────────────────────────────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct Compare {
    /// Selection probabilities of the two, once computed.
    selection: Option<Selections>,
    /// Lines scrolled out at the top.
    scroll: usize,
}

struct Selections {
    generation: u64,
    ids: [u64; 2],
    of: [SelectionProbabilities; 2],
}

/// One of the two individuals.
struct Side<'c> {
    record: &'c RankedRecord,
    tree: Tree,
    /// For each node, whether the other tree lacks its counterpart.
    lacking: Vec<bool>,
    selection: Option<&'c SelectionProbabilities>,
}

impl Compare {
    fn sides<'c>(&'c self, context: &'c ViewContext) -> Option<[Side<'c>; 2]> {
        let records = context.rivals()?;
        let [one, other] = [context.tree(records[0])?, context.tree(records[1])?];
        let lacking = [lacking(&one, &other), lacking(&other, &one)];
        let ids = records.map(|record| record.id);
        let known = self.selection.as_ref().filter(|known| known.ids == ids);
        let [first, second] = lacking;
        let side = |index: usize, tree, lacking| Side {
            record: records[index],
            tree,
            lacking,
            selection: known.map(|known| &known.of[index]),
        };
        Some([side(0, one, first), side(1, other, second)])
    }
}

/// Returns for each node of a tree whether the other tree lacks its counterpart.
///
/// It lacks a composite subtask that occurs nowhere in it, and a primitive child that occurs
/// less often under the same composite. These are the terms of the structural difference
/// (Thesis 4.5.2).
fn lacking(tree: &Tree, other: &Tree) -> Vec<bool> {
    let parent = |tree: &Tree, node: usize| tree.nodes()[node].parent.map(|p| tree.subtask(p));
    let mut children: BTreeMap<(Option<SubtaskId>, SubtaskId), usize> = BTreeMap::new();
    let mut subtasks: BTreeSet<SubtaskId> = BTreeSet::new();
    for node in 0..other.nodes().len() {
        let subtask = other.subtask(node);
        *children.entry((parent(other, node), subtask)).or_default() += 1;
        subtasks.insert(subtask);
    }
    let mut is_lacking = |node: usize| {
        let subtask = tree.subtask(node);
        if tree.children(node).next().is_some() {
            return !subtasks.contains(&subtask);
        }
        let left = children.entry((parent(tree, node), subtask)).or_default();
        let is_lacking = *left == 0;
        *left = left.saturating_sub(1);
        is_lacking
    };
    (0..tree.nodes().len()).map(&mut is_lacking).collect()
}

impl Compare {
    fn scroll(&mut self, context: &ViewContext, action: Action) -> Option<Vec<Effect>> {
        let page = usize::from(context.size.1 / 2);
        self.scroll = match action {
            Action::PageUp => self.scroll.saturating_sub(page),
            Action::PageDown => self.scroll + page,
            Action::Top => 0,
            Action::Bottom => usize::MAX,
            _ => return None,
        };
        let longest = self.longest(context);
        self.scroll = self.scroll.min(last_start(longest, rows(context)));
        Some(Vec::new())
    }

    /// Returns the number of lines of the longer side.
    fn longest(&self, context: &ViewContext) -> usize {
        let columns = usize::from((context.size.0 / 2).saturating_sub(3));
        self.sides(context).map_or(0, |[one, other]| {
            let lines = [(&one, &other), (&other, &one)]
                .map(|(side, against)| side.lines(context, "", against, columns).len());
            lines.into_iter().max().unwrap_or(0)
        })
    }
}

/// Returns the rows for a side, without header, hint bar, border and note.
fn rows(context: &ViewContext) -> u16 {
    context.size.1.saturating_sub(5)
}

impl Side<'_> {
    fn lines(
        &self,
        context: &ViewContext,
        role: &str,
        other: &Self,
        columns: usize,
    ) -> Vec<Line<'static>> {
        let look = &context.look;
        let record = self.record;
        let generation = context.inspected().map_or(0, |(generation, _)| generation);
        let (delivered, trials) = (record.delivered(), record.scored());
        let (rank, steps) = (record.rank, record.mean_steps());
        let (composites, primitives) = (record.composites, record.primitives.len());
        let head = format!("individual {}, generation {generation}", record.id);
        let facts = [
            format!("{role}: rank {rank}, {steps:.1} steps"),
            format!("{delivered} of {trials} scored trials done"),
            format!("{composites} composite, {primitives} primitive subtasks"),
        ];
        let mut lines = vec![line(look, head, Paint::Title)];
        lines.extend(facts.map(|fact| line(look, fact, Paint::Text)));
        lines.push(Line::default());
        let drawn = draw(&self.tree, context.catalogue(), look.signs.tree);
        for (text, lacking) in drawn.into_iter().zip(&self.lacking) {
            let (sign, paint) = if *lacking {
                ("+ ", Paint::Notice)
            } else {
                ("  ", Paint::Text)
            };
            lines.push(Pen::new(look).text(sign, paint).text(text, paint).line());
        }
        lines.push(Line::default());
        lines.extend(self.selection_lines(context, other, columns));
        lines
    }

    /// Lists the selection probabilities, marked where they differ from the other's.
    fn selection_lines(
        &self,
        context: &ViewContext,
        other: &Self,
        columns: usize,
    ) -> Vec<Line<'static>> {
        let look = &context.look;
        let Some(selection) = self.selection else {
            let error = context.player.load_error();
            let why = error.unwrap_or("computing selection probabilities");
            let lines = wrapped(why, columns, "").into_iter();
            return lines.map(|text| line(look, text, Paint::Dim)).collect();
        };
        let mut lines = vec![line(look, "selects, by state type", Paint::Dim)];
        for (index, of) in selection.iter().enumerate() {
            let Some(of) = of else { continue };
            let theirs = other.selection.and_then(|all| all.get(index)?.as_ref());
            let mut pen = Pen::new(look).text(format!("{} ", index + 1), Paint::Title);
            for (place, primitive) in context.catalogue().primitives().enumerate() {
                let name = primitive.name(context.catalogue());
                let share = of[place];
                let sign = match theirs {
                    Some(theirs) if (theirs[place] - share).abs() >= MARKED => "+",
                    _ if share >= SMALL => " ",
                    _ => continue,
                };
                let paint = if sign == "+" {
                    Paint::Notice
                } else {
                    Paint::Text
                };
                let text = format!("{sign}{name} {}", percent(share));
                if pen.column() + width(&text) > columns {
                    lines.push(pen.line());
                    pen = Pen::new(look).to(2);
                }
                pen = pen.text(text, paint).text("  ", Paint::Text);
            }
            lines.push(pen.line());
        }
        lines
    }
}

impl View for Compare {
    fn name(&self) -> &'static str {
        "compare"
    }

    fn title(&self) -> &'static str {
        "Comparison"
    }

    fn needs_rollout(&self) -> bool {
        true
    }

    fn opens(&self) -> Option<ViewId> {
        Some(ViewId::Inspector)
    }

    fn caption(&self, context: &ViewContext) -> String {
        let Some([one, other]) = self.sides(context) else {
            return String::new();
        };
        let difference = structural_difference(&one.tree, &other.tree, context.catalogue());
        match difference {
            0 => String::from("same structure"),
            _ => format!("structural difference {difference}"),
        }
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let look = &context.look;
        let Some([one, other]) = self.sides(context) else {
            return draw_note(context, "no two individuals evaluated yet", area, buffer);
        };
        let role = if context.marked == Some(other.record.id) {
            "marked"
        } else {
            "best other"
        };
        let half = area.width / 2;
        let columns = usize::from(half.saturating_sub(2));
        let sides = [
            (0, one.lines(context, "selected", &other, columns)),
            (half, other.lines(context, role, &one, columns)),
        ];
        for (x, lines) in sides {
            let side = Rect {
                x: area.x + x + 1,
                width: half.saturating_sub(2),
                height: area.height.saturating_sub(1),
                ..area
            };
            draw_lines(look, &lines, self.scroll, side, buffer);
        }
        let key = keys(context, Action::Mark);
        let note = format!(
            "+ differs from the other   {key} marks the selected individual for comparison"
        );
        let row = area.height.saturating_sub(1);
        if area.height > 3 && width(&note) < usize::from(area.width) {
            put(buffer, area, (1, row), &note, look.style(Paint::Dim));
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[
            Action::Down,
            Action::PageDown,
            Action::Mark,
            Action::Best,
            Action::ViewInspector,
        ]
    }

    fn can(&self, context: &ViewContext, action: Action) -> bool {
        match action {
            Action::Down => context.rivals().is_some(),
            Action::PageDown => self.longest(context) > usize::from(rows(context)),
            _ => true,
        }
    }

    /// Up and down select by rank; paging scrolls both sides.
    fn act(&mut self, context: &mut ViewContext, action: Action) -> Option<Vec<Effect>> {
        let by = match action {
            Action::Up => -1,
            Action::Down => 1,
            scrolls => return self.scroll(context, scrolls),
        };
        let record = context.shown()?;
        let here = context.selected()?.rank.saturating_sub(1);
        let next = here.saturating_add_signed(by);
        if let Some(individual) = record.individuals.get(next) {
            context.chosen = Chosen::Id(individual.id);
        }
        Some(Vec::new())
    }

    fn prepare(&mut self, context: &ViewContext) {
        let Some([one, other]) = context.rivals() else {
            return;
        };
        let Some(state) = context.player.population() else {
            return;
        };
        let ids = [one.id, other.id];
        let known = self.selection.as_ref();
        let is_current =
            |known: &Selections| known.generation == state.generation && known.ids == ids;
        if known.is_some_and(is_current) {
            return;
        }
        let individuals = ids.map(|id| InspectedIndividual::with_id(state, id));
        let [Some(one), Some(other)] = individuals else {
            self.selection = None;
            return;
        };
        self.selection = Some(Selections {
            generation: state.generation,
            ids,
            of: [one, other].map(|individual| context.experiment.selection(individual)),
        });
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let sides = self.sides(context)?;
        let mut csv = String::from("individual,rank,node,parent,subtask,only_here\n");
        for side in &sides {
            for (node, lacking) in side.lacking.iter().enumerate() {
                let parent = side.tree.nodes()[node].parent;
                let parent = parent.map_or(String::new(), |parent| parent.to_string());
                let name = side.tree.subtask(node).name(context.catalogue());
                let (id, rank) = (&side.record.id, &side.record.rank);
                csv_line(
                    &mut csv,
                    &[id, rank, &node, &parent, &name, &u8::from(*lacking)],
                );
            }
        }
        Some(csv)
    }

    fn dot(&self, context: &ViewContext) -> Option<String> {
        Some(to_dot(
            &context.tree(context.selected()?)?,
            context.catalogue(),
        ))
    }

    fn help_text(&self) -> &'static str {
        "The selected individual beside another: the marked one, or the best of the others.\n\
         + marks what the other lacks: a composite subtask, or a primitive child that occurs\n\
         more often under the same composite. These are the terms of the structural difference\n\
         (Thesis 4.5.2). + also marks selection probabilities that differ by 0.1 or more."
    }
}
