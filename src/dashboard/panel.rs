//! The border around a panel.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::{Block, Widget};

use super::look::{Look, Paint, fitted_parts, put, width};

/// Draws border, title and caption of a panel, and returns the area inside.
///
/// ```text
/// ╭ Title  caption ─────────╮
/// │                         │
/// ╰─────────────────────────╯
/// ```
pub(super) fn panel(
    look: &Look,
    area: Rect,
    focused: bool,
    (title, caption): (&str, &str),
    buffer: &mut Buffer,
) -> Rect {
    let area = area.intersection(buffer.area);
    let (border, name) = match focused {
        true => (Paint::Focus, Paint::Focus),
        false => (Paint::Border, Paint::Title),
    };
    let block = Block::bordered()
        .border_set(look.signs.border)
        .border_style(look.style(border));
    let inside = inside(area);
    block.render(area, buffer);
    let room = Rect {
        width: area.width.saturating_sub(1),
        height: area.height.min(1),
        ..area
    };
    // Not by colour alone: a title in focus has a pointer.
    let title = match focused {
        true => format!("{} {title} ", look.signs.pointer),
        false => format!(" {title} "),
    };
    let after = put(buffer, room, (1, 0), &title, look.style(name));
    let left = usize::from(room.width.saturating_sub(after));
    if !caption.is_empty() && left > 6 {
        let caption = format!("{} ", fitted_parts(caption, left - 2, look.signs));
        put(buffer, room, (after, 0), &caption, look.style(Paint::Dim));
        debug_assert!(width(&caption) < left);
    }
    inside
}

/// The area inside the border of a panel.
pub(super) fn inside(area: Rect) -> Rect {
    Block::bordered().inner(area)
}
