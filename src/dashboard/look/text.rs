//! Lines of text that fit, and that cannot steer a terminal.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use super::signs::Signs;

/// Columns that a text takes.
#[must_use]
pub fn width(text: &str) -> usize {
    text.width()
}

/// A text as one line: control characters, line breaks and characters that cannot be
/// seen are made visible.
#[must_use]
pub fn one_line(text: &str) -> String {
    let shown = |c: char| match c.width() {
        Some(columns) if columns > 0 => vec![c],
        _ => c.escape_unicode().collect(),
    };
    text.chars().flat_map(shown).collect()
}

/// A text cut to a number of columns; an ellipsis says so.
#[must_use]
pub fn fitted(text: &str, columns: usize, signs: &Signs) -> String {
    if text.width() <= columns {
        return text.to_owned();
    }
    let room = columns.saturating_sub(signs.ellipsis.width());
    let mut used = 0;
    let mut cut: String = text
        .chars()
        .take_while(|c| {
            used += c.width().unwrap_or(0);
            used <= room
        })
        .collect();
    if columns > 0 {
        cut.push_str(signs.ellipsis);
    }
    cut
}

/// Writes a text into a row of an area from a column on, as far as there is room.
/// Returns the column after it.
pub fn put(buffer: &mut Buffer, area: Rect, at: (u16, u16), text: &str, style: Style) -> u16 {
    let area = area.intersection(buffer.area);
    let (column, row) = at;
    if row >= area.height || column >= area.width {
        return column;
    }
    let room = usize::from(area.width - column);
    let (x, _) = buffer.set_stringn(area.x + column, area.y + row, text, room, style);
    x - area.x
}

#[cfg(test)]
mod tests {
    use super::super::signs::{ASCII, UNICODE};
    use super::*;

    #[test]
    fn nothing_unseen_is_left() {
        assert_eq!(
            one_line("a\u{1b}[2J\n\u{202e}b"),
            "a\\u{1b}[2J\\u{a}\\u{202e}b"
        );
    }

    #[test]
    fn a_cut_text_has_its_width() {
        assert_eq!(fitted("ApproachNest", 8, &UNICODE), "Approac…");
        assert_eq!(fitted("ApproachNest", 8, &ASCII), "Approac~");
        assert_eq!(fitted("abc", 3, &ASCII), "abc");
        assert_eq!(fitted("abc", 0, &ASCII), "");
        assert_eq!(width(&fitted("日本語日本語", 5, &UNICODE)), 5);
    }
}
