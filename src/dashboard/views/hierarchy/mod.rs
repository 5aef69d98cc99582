//! The hierarchy view: the task hierarchy of an individual.

mod details;
mod table;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::shared::{self, click_node, csv_line, draw_no_generation, pace};
use super::view::View;
use crate::dashboard::context::Clicked;
use crate::dashboard::context::Effect;
use crate::dashboard::context::ViewContext;
use crate::dashboard::keys::Action;
use crate::dashboard::look::lines::{last_start, mark_more};
use crate::dashboard::look::{Paint, fitted, one_line, put};
use crate::dashboard::view_id::ViewId;
use crate::hierarchy::to_dot;
use table::Table;

/// The task hierarchy of an individual, with the active path of the rollout highlighted. Below it
/// stand the selected subtask, and how the individual was made and scored.
///
/// ```text
///  ╭ Hierarchy  id 362, gen 26 · rank 1 ─────────────────╮
///  │   subtask              types     T  invoked         │
///  │ •Root                  1234  0.050       12         │   • active in the rollout
///  │▸ ├─ FindBattery        1     0.050       12         │   ▸ selected
///  │  │  └─ Avoid           1234            1201         │
///  │ •└─ ApproachBattery     2               310         │
///  │                                                     │
///  │  FindBattery: find a battery                        │
///  │  composite, active in state types 1; goal: 2 3 4    │
///  │  340 with its Wander replaced by Avoid of 351       │
///  ╰─────────────────────────────────────────────────────╯
/// ```
pub(super) struct Hierarchy;

impl View for Hierarchy {
    fn name(&self) -> &'static str {
        "hierarchy"
    }

    fn title(&self) -> &'static str {
        "Hierarchy"
    }

    fn needs_rollout(&self) -> bool {
        true
    }

    fn opens(&self) -> Option<ViewId> {
        Some(ViewId::Inspector)
    }

    fn caption(&self, context: &ViewContext) -> String {
        let Some((generation, individual)) = context.inspected() else {
            return String::new();
        };
        let separator = context.look.signs.separator;
        let (id, rank) = (individual.id, individual.rank);
        let pace = match context.player.rollout() {
            Some(_) => format!(" {separator} {}", pace(context)),
            None => String::new(),
        };
        format!("id {id}, gen {generation} {separator} rank {rank}{pace}")
    }

    fn draw(&self, context: &ViewContext, area: Rect, buffer: &mut Buffer) {
        let Some((_, individual)) = context.inspected() else {
            return draw_no_generation(context, area, buffer);
        };
        let look = &context.look;
        let Some(tree) = context.tree(individual) else {
            let text = one_line(&individual.tree);
            let text = fitted(&text, usize::from(area.width), look.signs);
            put(buffer, area, (1, 0), &text, look.style(Paint::Bad));
            return;
        };
        let table = Table::of(context, individual, &tree, area);
        table.draw_head(context, area, buffer);
        let (place, skipped) = place_of_tree(&table, area);
        let shown = table.lines.iter().skip(skipped).take(place.height.into());
        for (row, line) in (0..).zip(shown) {
            table.draw_line(context, &tree, line, shared::row(place, row), buffer);
        }
        let lines = table.lines.len();
        let below = lines.saturating_sub(skipped + usize::from(place.height));
        mark_more(look, [skipped, below], place, buffer);
        let rest = shared::below(area, (lines as u16).saturating_add(2));
        details::draw(context, &tree, individual, rest, buffer);
    }

    fn hints(&self) -> &'static [Action] {
        &[
            Action::Down,
            Action::Open,
            Action::Halt,
            Action::StepRollout,
            Action::Best,
        ]
    }

    fn can(&self, context: &ViewContext, action: Action) -> bool {
        let nodes = context
            .inspected_tree()
            .map_or(0, |tree| tree.nodes().len());
        match action {
            Action::Down => nodes > 1,
            Action::Open => nodes > 0,
            _ => true,
        }
    }

    fn act(&mut self, context: &mut ViewContext, action: Action) -> Option<Vec<Effect>> {
        let tree = context.inspected_tree()?;
        let last = tree.nodes().len().saturating_sub(1);
        let page = usize::from(context.size.1 / 2);
        let here = context.node_in(&tree);
        let there = match action {
            Action::Up => here.saturating_sub(1),
            Action::Down => here + 1,
            Action::PageUp => here.saturating_sub(page),
            Action::PageDown => here + page,
            Action::Top => 0,
            Action::Bottom => last,
            _ => return None,
        };
        context.node = there.min(last);
        Some(Vec::new())
    }

    fn click(&mut self, context: &mut ViewContext, area: Rect, at: Position) -> Clicked {
        let Some(table) = context.inspected().and_then(|(_, individual)| {
            let tree = context.tree(individual)?;
            Some(Table::of(context, individual, &tree, area))
        }) else {
            return Clicked::Nothing;
        };
        let place = place_of_tree(&table, area);
        click_node(context, &table.lines, place, at)
    }

    fn csv(&self, context: &ViewContext) -> Option<String> {
        let (_, individual) = context.inspected()?;
        let tree = context.tree(individual)?;
        let everything = Rect::new(0, 0, u16::MAX, u16::MAX);
        let table = Table::of(context, individual, &tree, everything);
        let mut csv = String::from("node,parent,subtask,state_types,temperature,invoked\n");
        for (index, node) in tree.nodes().iter().enumerate() {
            let parent = node.parent;
            let parent = parent.map_or(String::new(), |parent| parent.to_string());
            let subtask = context.catalogue().subtask(node.subtask);
            let types = subtask.active.to_string().replace(',', " ");
            let [temperature, visits] = table.numbers(index);
            let name = &subtask.name;
            csv_line(
                &mut csv,
                &[&index, &parent, name, &types, &temperature, &visits],
            );
        }
        Some(csv)
    }

    fn dot(&self, context: &ViewContext) -> Option<String> {
        Some(to_dot(&context.inspected_tree()?, context.catalogue()))
    }

    fn help_text(&self) -> &'static str {
        "The task hierarchy of an individual: its genome. Root and the other composite subtasks\n\
         (bold) choose among their children until they terminate; primitive subtasks act. The\n\
         highlighted path leads from the root to the current action of the rollout. types: the\n\
         state types in which a subtask can be active (Thesis Tables 4.2 and 4.3). T: the\n\
         temperature of a composite's softmax; it falls whenever the subtask terminates, so that\n\
         its choices become greedy. invoked: how often the rollout has invoked the subtask.\n\
         Where there is little room, primitive siblings share a line, each with this number.\n\
         Below stand the time steps of the scored trials; ! marks a truncated one."
    }
}

/// Returns the area of the tree below the head, and the number of lines scrolled out above it.
///
/// The selected line is always visible.
fn place_of_tree(table: &Table, area: Rect) -> (Rect, usize) {
    let place = shared::below(area, 1);
    let selected = shared::line_of(&table.lines, table.selected);
    let skipped = selected.saturating_sub(usize::from(place.height / 2));
    (
        place,
        skipped.min(last_start(table.lines.len(), place.height)),
    )
}
