//! The task hierarchy.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::View;
use crate::dashboard::desk::Desk;
use crate::dashboard::keys::Action;
use crate::dashboard::look::{Paint, fitted, put, width};
use crate::hierarchy::{draw, to_dot};

/// The selected individual's task hierarchy.
///
/// ```text
///  ╭ Hierarchy  individual 362, the best ╮
///  │ Root                      1 2 3 4   │
///  │ ├─ FindBattery            1         │   the state types in which each
///  │ │  └─ Avoid               1 2 3 4   │   subtask can be active
///  │ └─ ApproachBattery          2       │
///  ╰─────────────────────────────────────╯
/// ```
pub(super) struct Hierarchy;

impl View for Hierarchy {
    fn caption(&self, desk: &Desk) -> String {
        let Some(selected) = desk.selected() else {
            return String::new();
        };
        format!("individual {}, rank {}", selected.id, selected.rank)
    }

    fn draw(&self, desk: &Desk, area: Rect, buffer: &mut Buffer) {
        let look = &desk.look;
        let catalogue = desk.catalogue();
        let Some(tree) = desk.selected().and_then(|selected| desk.tree(selected)) else {
            let text = fitted(
                "no individual has lived yet",
                usize::from(area.width),
                look.signs,
            );
            put(buffer, area, (1, 0), &text, look.style(Paint::Dim));
            return;
        };
        let lines = draw(&tree, catalogue, look.signs.tree);
        let column = lines.iter().map(|line| width(line)).max().unwrap_or(0) + 2;
        for (row, (line, node)) in lines.iter().zip(tree.nodes()).enumerate() {
            let Ok(row) = u16::try_from(row) else { return };
            let subtask = catalogue.subtask(node.subtask);
            let paint = match subtask.is_composite() {
                true => Paint::Title,
                false => Paint::Text,
            };
            put(buffer, area, (1, row), line, look.style(paint));
            let types =
                catalogue
                    .types()
                    .map(|state_type| match subtask.active.contains(state_type) {
                        true => format!("{} ", state_type.number()),
                        false => String::from("  "),
                    });
            let at = u16::try_from(column + 1).unwrap_or(u16::MAX);
            put(
                buffer,
                area,
                (at, row),
                &types.collect::<String>(),
                look.style(Paint::Dim),
            );
        }
    }

    fn hints(&self) -> &'static [Action] {
        &[Action::Best, Action::Up, Action::Down]
    }

    fn dot(&self, desk: &Desk) -> Option<String> {
        let tree = desk.tree(desk.selected()?)?;
        Some(to_dot(&tree, desk.catalogue()))
    }

    fn lesson(&self) -> &'static str {
        "The task hierarchy of the selected individual, its genome. Root and the other\n\
         composite subtasks (bold) choose among their children until they terminate; primitive\n\
         subtasks act. The numbers are the state types in which a subtask can be active\n\
         (Thesis Tables 4.2, 4.3)."
    }
}
