//! Text that fits its area and cannot send control codes to a terminal.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use super::signs::Signs;

/// Returns the columns that a text takes.
#[must_use]
pub fn width(text: &str) -> usize {
    text.width()
}

/// Returns a text as one line: control characters, line breaks and invisible characters are
/// escaped.
#[must_use]
pub fn one_line(text: &str) -> String {
    let shown = |c: char| match c.width() {
        Some(columns) if columns > 0 => vec![c],
        _ => c.escape_unicode().collect(),
    };
    text.chars().flat_map(shown).collect()
}

/// Returns a text cut to a number of columns, with an ellipsis at the cut.
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

/// Returns a name shortened to a number of columns: `NavToPass` for `NavigateToPassenger`.
///
/// The longest words are shortened first, so that each stays recognisable. A name of one word
/// is cut.
#[must_use]
pub fn shortened(name: &str, columns: usize, signs: &Signs) -> String {
    let mut words: Vec<String> = Vec::new();
    for letter in name.chars() {
        match words.last_mut() {
            Some(word) if !letter.is_uppercase() => word.push(letter),
            _ => words.push(String::from(letter)),
        }
    }
    let mut excess = name.width().saturating_sub(columns);
    if words.len() < 2 || columns < 2 * words.len() {
        return fitted(name, columns, signs);
    }
    while excess > 0 {
        // The first one of the longest words.
        let longest = words
            .iter_mut()
            .rev()
            .max_by_key(|word| word.chars().count());
        longest.and_then(String::pop);
        excess -= 1;
    }
    words.concat()
}

/// Returns the end of a text in a number of columns, with an ellipsis before it.
#[must_use]
pub fn fitted_end(text: &str, columns: usize, signs: &Signs) -> String {
    let turned = |text: &str| -> String { text.chars().rev().collect() };
    turned(&fitted(&turned(text), columns, signs))
}

/// Returns as many parts of a text as fit into a number of columns, from the first on.
///
/// Parts are separated by the separator sign between blanks.
#[must_use]
pub fn fitted_parts(text: &str, columns: usize, signs: &Signs) -> String {
    let separator = format!(" {} ", signs.separator);
    let mut parts = text.split(&separator);
    let mut fits = parts.next().unwrap_or("").to_owned();
    for part in parts {
        if fits.width() + separator.width() + part.width() > columns {
            break;
        }
        fits = fits + &separator + part;
    }
    fitted(&fits, columns, signs)
}

/// Returns a text in lines of at most `columns` columns, broken between words.
///
/// All lines but the first begin with `indent`.
#[must_use]
pub fn wrapped(text: &str, columns: usize, indent: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.width() + 1 + word.width() <= columns => {
                line.push(' ');
                line.push_str(word);
            }
            Some(_) => lines.push(format!("{indent}{word}")),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Draws a text at a column and row of an area, as far as there is room; returns the column
/// after it.
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
        assert_eq!(wrapped("scored 1 22 3", 9, "  "), ["scored 1", "  22 3"]);
        assert_eq!(shortened("FindNest", 8, &UNICODE), "FindNest");
        assert_eq!(shortened("NavigateToPassenger", 9, &UNICODE), "NavToPass");
        assert_eq!(shortened("ApproachBattery", 8, &ASCII), "ApprBatt");
        assert_eq!(shortened("Putdown", 5, &ASCII), "Putd~");
        assert_eq!(shortened("ApproachNest", 3, &ASCII), "Ap~");
        assert_eq!(fitted_end("runs/taxi", 5, &UNICODE), "…taxi");
        assert_eq!(fitted_parts("id 7 · halted", 12, &UNICODE), "id 7");
        assert_eq!(fitted_parts("id 7 · halted", 13, &UNICODE), "id 7 · halted");
        assert_eq!(width(&fitted("日本語日本語", 5, &UNICODE)), 5);
    }
}
