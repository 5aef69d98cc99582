//! Two individuals side by side.

use std::collections::BTreeMap;
use std::fmt::Write;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::view::View;
use crate::dashboard::context::Effect;
use crate::dashboard::context::{Chosen, ViewContext};
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{Pen, draw_lines, last_start, percent};
use crate::dashboard::look::{Paint, fitted, put, width, wrapped};
use crate::dashboard::view_id::ViewId;
use crate::evolution::RankedRecord;
use crate::hierarchy::{Tree, draw, structural_difference, to_dot};
use crate::lab::inspection::InspectedIndividual;
use crate::learning::SelectionProbabilities;
use crate::worlds::SubtaskId;

/// The selected individual beside the marked one, with what the one has and the other has
/// not.
///
/// ```text
///  ╭ Comparison  structural difference -3 ────────────────────────────────╮
///  │ individual 362, generation 26      individual 340, generation 26      │
///  │ selected: rank 1, 128.6 steps      marked: rank 4, 141.2 steps        │
///  │   Root                               Root                             │
///  │   ├─ FindBattery                     ├─ FindBattery                   │
///  │ + │  └─ Avoid                      + │  └─ Wander                     │
///  ╰───────────────────────────────────────────────────────────────────────╯
/// ```
#[derive(Default)]
pub(super) struct Compare {
    /// Selection probabilities of the two.
    selection: Option<Selections>,
    /// Lines above the screen.
    scroll: usize,
}

struct Selections {
    generation: u64,
    ids: [u64; 2],
    of: [SelectionProbabilities; 2],
}

/// One of the two.
struct Side<'d> {
    record: &'d RankedRecord,
    tree: Tree,
    /// For each node whether the other has not its like.
    unlike: Vec<bool>,
    selection: Option<&'d SelectionProbabilities>,
}

impl Compare {
    fn sides<'d>(&'d self, context: &'d ViewContext) -> Option<[Side<'d>; 2]> {
        let records = context.rivals()?;
        let [one, other] = [context.tree(records[0])?, context.tree(records[1])?];
        let unlike = [unlike(&one, &other), unlike(&other, &one)];
        let known = self
            .selection
            .as_ref()
            .filter(|known| known.ids == records.map(|r| r.id));
        let [first, second] = unlike;
        Some([
            Side {
                record: records[0],
                tree: one,
                unlike: first,
                selection: known.map(|known| &known.of[0]),
            },
            Side {
                record: records[1],
                tree: other,
                unlike: second,
                selection: known.map(|known| &known.of[1]),
            },
        ])
    }
}

/// For each node of a tree whether the other tree has not its like: a composite subtask
/// that is nowhere in it, a child more often than under the same composite there. These
/// are the terms of the structural difference (Thesis 4.5.2).
fn unlike(tree: &Tree, other: &Tree) -> Vec<bool> {
    let parent = |tree: &Tree, node: usize| tree.nodes()[node].parent.map(|p| tree.subtask(p));
    let mut left: BTreeMap<(Option<SubtaskId>, SubtaskId), usize> = BTreeMap::new();
    let mut anywhere: BTreeMap<SubtaskId, usize> = BTreeMap::new();
    for node in 0..other.nodes().len() {
        let subtask = other.subtask(node);
        *left.entry((parent(other, node), subtask)).or_default() += 1;
        *anywhere.entry(subtask).or_default() += 1;
    }
    (0..tree.nodes().len())
        .map(|node| {
            let subtask = tree.subtask(node);
            if tree.children(node).next().is_some() {
                return !anywhere.contains_key(&subtask);
            }
            match left.get_mut(&(parent(tree, node), subtask)) {
                Some(count) if *count > 0 => {
                    *count -= 1;
                    false
                }
                _ => true,
            }
        })
        .collect()
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

    /// Lines of the longer side.
    fn longest(&self, context: &ViewContext) -> usize {
        let columns = usize::from((context.size.0 / 2).saturating_sub(3));
        self.sides(context).map_or(0, |[one, other]| {
            let lines = [(&one, &other), (&other, &one)]
                .map(|(side, against)| side.lines(context, "", against, columns).len());
            lines.into_iter().max().unwrap_or(0)
        })
    }
}

/// Rows of a side: without header, hint bar, border and note.
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
        let steps = record.fitness_steps as f64 / record.trials.len().max(1) as f64;
        let generation = context.inspected().map_or(0, |(generation, _)| generation);
        let head = format!("individual {}, generation {generation}", record.id);
        let delivered = record.trials.iter().filter(|trial| trial.delivered).count();
        let facts = [
            format!("{role}: rank {}, {steps:.1} steps", record.rank),
            format!("{delivered} of {} trials done", record.trials.len()),
            format!(
                "{} composite, {} primitive subtasks",
                record.composites,
                record.primitives.len()
            ),
        ];
        let mut lines = vec![Pen::new(look).text(head, Paint::Title).line()];
        lines.extend(facts.map(|fact| Pen::new(look).text(fact, Paint::Text).line()));
        lines.push(Line::default());
        let drawn = draw(&self.tree, context.catalogue(), look.signs.tree);
        for (line, unlike) in drawn.into_iter().zip(&self.unlike) {
            let (sign, paint) = match unlike {
                true => ("+ ", Paint::Notice),
                false => ("  ", Paint::Text),
            };
            lines.push(Pen::new(look).text(sign, paint).text(line, paint).line());
        }
        lines.push(Line::default());
        lines.extend(self.selection_lines(context, other, columns));
        lines
    }

    /// Selection probabilities, marked where they are far from the other's.
    fn selection_lines(
        &self,
        context: &ViewContext,
        other: &Self,
        columns: usize,
    ) -> Vec<Line<'static>> {
        let look = &context.look;
        let Some(selection) = self.selection else {
            let why = context
                .player
                .load_error()
                .unwrap_or("what they select is being worked out");
            let lines = wrapped(why, columns, "").into_iter();
            return lines
                .map(|line| Pen::new(look).text(line, Paint::Dim).line())
                .collect();
        };
        let mut lines = vec![Pen::new(look).text("selects", Paint::Dim).line()];
        for (index, of) in selection.iter().enumerate() {
            let Some(of) = of else { continue };
            let theirs = other.selection.and_then(|all| all.get(index)?.as_ref());
            let mut pen = Pen::new(look).text(format!("{} ", index + 1), Paint::Title);
            for (place, primitive) in context.catalogue().primitives().enumerate() {
                let share = of[place];
                let far = theirs.is_some_and(|theirs| (theirs[place] - share).abs() >= 0.1);
                if share < 0.005 && !far {
                    continue;
                }
                let (sign, paint) = match far {
                    true => ("+", Paint::Notice),
                    false => (" ", Paint::Text),
                };
                let name = primitive.name(context.catalogue());
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
            0 => String::from("the same structure"),
            _ => format!("structural difference {difference}"),
        }
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let look = &context.look;
        let Some([one, other]) = self.sides(context) else {
            let text = fitted(
                "no two individuals have lived yet",
                area.width.into(),
                look.signs,
            );
            put(buffer, area, (1, 0), &text, look.style(Paint::Dim));
            return;
        };
        let role = match context.marked == Some(other.record.id) {
            true => "marked",
            false => "next best",
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
        let key = context
            .keys
            .hint(Action::Mark, look.signs)
            .map_or(String::new(), |(key, _)| key);
        let note =
            format!("+ has what the other has not   {key} marks the selected one for comparison");
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

    /// The selected individual changes by rank; pages are those of both sides.
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
        let fresh =
            known.is_some_and(|known| known.generation == state.generation && known.ids == ids);
        if fresh {
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
            for (node, unlike) in side.unlike.iter().enumerate() {
                let parent = side.tree.nodes()[node].parent;
                // Writing to a string cannot fail.
                let _ = writeln!(
                    csv,
                    "{},{},{node},{},{},{}",
                    side.record.id,
                    side.record.rank,
                    parent.map_or(String::new(), |parent| parent.to_string()),
                    context.catalogue().subtask(side.tree.subtask(node)).name,
                    u8::from(*unlike)
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
         What one has and the other has not is marked +: a composite subtask, or a primitive\n\
         child more often under the same composite. These are the terms of the structural\n\
         difference (Thesis 4.5.2). Selection probabilities are marked where they differ by\n\
         more than a tenth."
    }
}
