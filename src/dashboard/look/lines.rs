//! Lines of styled text, scrolled lists, and numbers in columns.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::Look;
use super::paint::Paint;
use super::text::{fitted, width};

/// A builder of a line: pieces of text, each with a paint.
pub(in crate::dashboard) struct Pen<'l> {
    look: &'l Look,
    spans: Vec<Span<'static>>,
    column: usize,
}

impl<'l> Pen<'l> {
    /// Creates an empty line.
    pub(in crate::dashboard) fn new(look: &'l Look) -> Self {
        Self {
            look,
            spans: Vec::new(),
            column: 0,
        }
    }

    /// Returns the number of columns used so far.
    pub(in crate::dashboard) fn column(&self) -> usize {
        self.column
    }

    /// Adds a text.
    pub(in crate::dashboard) fn text(mut self, text: impl Into<String>, paint: Paint) -> Self {
        let text = text.into();
        self.column += width(&text);
        self.spans.push(Span::styled(text, self.look.style(paint)));
        self
    }

    /// Adds blanks up to a column.
    pub(in crate::dashboard) fn to(self, column: usize) -> Self {
        let blanks = column.saturating_sub(self.column);
        match blanks {
            0 => self,
            _ => self.text(" ".repeat(blanks), Paint::Text),
        }
    }

    /// Adds a text, cut or padded to a number of columns.
    pub(in crate::dashboard) fn cell(self, text: &str, columns: usize, paint: Paint) -> Self {
        let end = self.column + columns;
        let text = fitted(text, columns, self.look.signs);
        self.text(text, paint).to(end)
    }

    /// Adds a text that is aligned to the right in a number of columns.
    pub(in crate::dashboard) fn right(self, text: &str, columns: usize, paint: Paint) -> Self {
        let start = self.column + columns.saturating_sub(width(text));
        self.to(start).text(text, paint)
    }

    /// Adds a horizontal bar that fills a share of a number of columns.
    pub(in crate::dashboard) fn bar(self, share: f64, columns: usize, paint: Paint) -> Self {
        let filled = (share.clamp(0.0, 1.0) * columns as f64).round() as usize;
        let sign = self.look.signs.filled;
        let end = self.column + columns;
        self.text(sign.repeat(filled), paint).to(end)
    }

    /// Returns the line.
    pub(in crate::dashboard) fn line(self) -> Line<'static> {
        Line::from(self.spans)
    }
}

/// Draws as many lines as there is room for, starting with line `from`, and marks what is left
/// out.
pub(in crate::dashboard) fn draw_lines(
    look: &Look,
    lines: &[Line<'_>],
    from: usize,
    area: Rect,
    buffer: &mut Buffer,
) {
    let area = area.intersection(buffer.area);
    let from = from.min(last_start(lines.len(), area.height));
    for (row, line) in lines.iter().skip(from).take(area.height.into()).enumerate() {
        let y = area.y + row as u16;
        buffer.set_line(area.x, y, line, area.width);
        if written(line) > usize::from(area.width) && area.width > 0 {
            let style = look.style(Paint::Dim);
            buffer.set_string(area.right() - 1, y, look.signs.ellipsis, style);
        }
    }
    let below = lines.len().saturating_sub(from + usize::from(area.height));
    mark_more(look, [from, below], area, buffer);
}

/// Returns the columns of a line without trailing blanks.
fn written(line: &Line<'_>) -> usize {
    let text: String = line
        .spans
        .iter()
        .map(|span| span.content.as_ref())
        .collect();
    width(text.trim_end())
}

/// Draws the number of lines above and below an area.
pub(in crate::dashboard) fn mark_more(
    look: &Look,
    [above, below]: [usize; 2],
    area: Rect,
    buffer: &mut Buffer,
) {
    let area = area.intersection(buffer.area);
    for (more, row, sign) in [
        (above, 0, look.signs.order[0]),
        (below, area.height.saturating_sub(1), look.signs.order[1]),
    ] {
        if more > 0 && area.width > 12 && area.height > 1 {
            let text = format!(" {sign} {more} more ");
            let at = area.right().saturating_sub(width(&text) as u16);
            buffer.set_string(at, area.y + row, &text, look.style(Paint::Key));
        }
    }
}

/// Returns the last start line from which a list still fills its rows.
pub(in crate::dashboard) fn last_start(lines: usize, rows: u16) -> usize {
    lines.saturating_sub(usize::from(rows))
}

/// Returns a value in at most eight columns.
pub(in crate::dashboard) fn number(value: f32) -> String {
    let size = value.abs();
    let text = match value {
        _ if !value.is_finite() => String::from("none"),
        _ if size < 99.9995 => format!("{value:.3}"),
        _ if size < 9999.95 => format!("{value:.1}"),
        _ => format!("{value:.1e}"),
    };
    unsigned_zero(text)
}

/// Returns the number of decimals that gives the largest of some values four digits, with no
/// more than eight columns.
pub(in crate::dashboard) fn decimals(values: impl IntoIterator<Item = f32>) -> usize {
    let sizes = values.into_iter().map(f32::abs);
    let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f32::max);
    match largest {
        size if size < 0.00995 => 5,
        size if size < 0.9995 => 4,
        size if size < 99.995 => 3,
        size if size < 999.95 => 2,
        _ => 1,
    }
}

/// Returns a value with a number of decimals, in at most eight columns.
pub(in crate::dashboard) fn fixed(value: f32, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if value.is_finite() && text.len() <= 8 {
        unsigned_zero(text)
    } else {
        number(value)
    }
}

/// Smaller values are negligible beside rewards: remains of values that have decayed for
/// hundreds of updates.
pub(in crate::dashboard) const TINY: f32 = 1e-9;

/// Returns whether a value is negligible beside rewards, but not zero.
pub(in crate::dashboard) fn is_tiny(value: f32) -> bool {
    value != 0.0 && value.abs() < TINY
}

/// Returns two values with enough digits to tell them apart; tiny ones as `nothing`.
pub(in crate::dashboard) fn told_apart(one: f32, other: f32, nothing: &str) -> [String; 2] {
    let values = [one, other];
    let text = |value: f32, decimals| {
        if is_tiny(value) {
            nothing.to_owned()
        } else {
            fixed(value, decimals)
        }
    };
    let texts = |decimals| values.map(|value| text(value, decimals));
    let mut some = (decimals(values)..=6).map(texts);
    let apart = some.find(|[one, other]| one != other);
    apart.unwrap_or_else(|| match one.abs().max(other.abs()) {
        size if size < TINY => texts(decimals([0.0])),
        size if size < 1e-6 => values.map(|value| format!("{value:.1e}")),
        _ => values.map(|value| format!("{value:e}")),
    })
}

/// Removes the sign of a number that rounds to zero.
fn unsigned_zero(text: String) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.to_owned(),
        _ => text,
    }
}

/// Returns a probability as a percentage in four columns.
pub(in crate::dashboard) fn percent(probability: f64) -> String {
    let percent = probability * 100.0;
    match percent {
        p if p > 0.0 && p < 1.0 => String::from("<1 %"),
        p if p < 100.0 && p > 99.0 => String::from("99 %"),
        p => format!("{p:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_have_no_idle_signs() {
        assert_eq!(number(-0.0001), "0.000");
        assert_eq!(number(-12.34567), "-12.346");
        assert_eq!(number(-1234.56), "-1234.6");
        assert_eq!(number(1.0e7), "1.0e7");
        assert_eq!(decimals([0.5, -12.0, f32::NAN]), 3);
        assert_eq!((decimals([0.0123]), decimals([])), (4, 5));
        assert_eq!(fixed(-0.00004, 4), "0.0000");
        let apart = |one, other| told_apart(one, other, "~0");
        assert_eq!(apart(-3.50001, -3.50002), ["-3.50001", "-3.50002"]);
        assert_eq!(apart(1.0, 2.0), ["1.000", "2.000"]);
        assert_eq!(apart(2.5e-8, 2.4e-8), ["2.5e-8", "2.4e-8"]);
        assert_eq!(apart(5.783e-39, -2.891e-39), ["~0", "~0"]);
        assert_eq!(apart(1e-42, -1.0), ["~0", "-1.000"]);
        for value in [f32::MAX, f32::MIN, f32::NAN, f32::MIN_POSITIVE] {
            assert!(number(value).len() <= 8);
        }
        assert_eq!(
            (percent(0.001), percent(0.9999)),
            ("<1 %".into(), "99 %".into())
        );
        assert_eq!((percent(0.0), percent(1.0)), ("0 %".into(), "100 %".into()));
    }
}
