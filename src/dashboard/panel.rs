//! The parts of every screen that do not depend on a view: panel borders, the body between
//! header and hint bar, and the message for a terminal that is too small.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::{Block, Widget};

use super::look::{Look, Paint, fitted_parts, put, width};

/// Smallest size in columns and rows at which the dashboard is drawn.
pub const SMALLEST: (u16, u16) = (40, 12);

/// Draws the border, title and caption of a panel, and returns the area inside.
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
    let (border, name) = if focused {
        (Paint::Focus, Paint::Focus)
    } else {
        (Paint::Border, Paint::Title)
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
    // Focus must show without colours too, so a focused title has a pointer.
    let title = if focused {
        format!("{} {title} ", look.signs.pointer)
    } else {
        format!(" {title} ")
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

/// Returns the area inside the border of a panel.
pub(super) fn inside(area: Rect) -> Rect {
    Block::bordered().inner(area)
}

/// Returns the area between header and hint bar.
pub(super) fn body(area: Rect) -> Rect {
    Rect {
        y: area.y + area.height.min(1),
        height: area.height.saturating_sub(2),
        ..area
    }
}

/// Draws the message for a terminal that is too small.
pub(super) fn too_small(look: &Look, area: Rect, buffer: &mut Buffer) {
    let style = look.style(Paint::Notice);
    let (columns, rows) = SMALLEST;
    let word = match area.width {
        0..9 => "small",
        _ => "too small",
    };
    let lines = [
        String::from(word),
        format!("{}x{}", area.width, area.height),
        format!("needs {columns}x{rows}"),
    ];
    for (row, line) in lines.iter().enumerate() {
        put(buffer, area, (0, row as u16), line, style);
    }
}
