//! Where ratatui paints: bytes for a terminal, as few as possible, collected until the
//! frame is whole.
//!
//! Half of what a frame would cost in reading order are changes of colour, so that everything
//! of one look is painted in one go ([`StyleRuns`]); moves of the cursor are shorter than they.

use std::io;

use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect, Size};
use unicode_width::UnicodeWidthStr;

use super::cursor::shortest_way;
use super::pen::Pen;
use super::style_runs::StyleRuns;

/// Tells the terminal to show what follows at once, when it is whole; the pen is new.
const BEGIN_FRAME: &[u8] = b"\x1b[?2026h\x1b[m";
/// Tells the terminal that the frame is whole.
const END_FRAME: &[u8] = b"\x1b[?2026l";

/// Collects the bytes of one frame. The cursor is hidden as long as there are frames, so a
/// frame in which nothing has changed has no bytes at all.
#[derive(Debug)]
pub(super) struct Painter {
    bytes: Vec<u8>,
    pub(super) size: Size,
    /// What the terminal shows.
    shown: Buffer,
    pen: Pen,
    /// Where the next character goes, if that is known.
    cursor: Option<Position>,
}

impl Painter {
    pub(super) fn new(size: Size) -> Self {
        Self {
            bytes: Vec::new(),
            size,
            shown: Buffer::default(),
            pen: Pen::default(),
            cursor: None,
        }
    }

    /// The frame since the last call, wrapped so that it appears at once.
    pub(super) fn take_frame(&mut self) -> Option<Vec<u8>> {
        if self.bytes.is_empty() {
            return None;
        }
        let frame = [BEGIN_FRAME, &self.bytes, END_FRAME].concat();
        self.bytes.clear();
        self.pen = Pen::default();
        self.cursor = None;
        Some(frame)
    }

    /// Brings the cursor to a place: by printing again what stands on the way, where that is
    /// not longer than a move.
    fn go_to(&mut self, to: Position) {
        if self.cursor == Some(to) {
            return;
        }
        let way = shortest_way(self.cursor, to);
        let way = self.printed_way(to, way.len()).unwrap_or(way);
        self.bytes.extend_from_slice(way.as_bytes());
        self.cursor = Some(to);
    }

    /// What stands between the cursor and a place further on in its line, if it is not longer
    /// than this and can be printed again without another pen.
    fn printed_way(&self, to: Position, longest: usize) -> Option<String> {
        let from = self.cursor.filter(|from| from.y == to.y && from.x < to.x)?;
        let mut text = String::new();
        for x in from.x..to.x {
            let cell = self.shown.cell((x, from.y))?;
            text.push_str(cell.symbol());
            let same = self.pen.for_cell(cell) == self.pen && cell.symbol().width() == 1;
            if !same || text.len() > longest {
                return None;
            }
        }
        Some(text)
    }

    /// Takes wide characters away that are about to be overwritten: terminals do not agree
    /// on what is left of one of which half is.
    fn wipe_wide(&mut self, content: &[(u16, u16, &Cell)]) {
        let blank = Cell::EMPTY;
        for &(x, y, cell) in content {
            for x in x..x.saturating_add(columns(cell)) {
                if self.shown.cell((x, y)).is_some_and(|old| columns(old) > 1) {
                    self.change_pen(Pen::default());
                    self.print(Position::new(x, y), &blank);
                    self.print(Position::new(x.saturating_add(1), y), &blank);
                }
            }
        }
    }

    fn change_pen(&mut self, to: Pen) {
        self.bytes.extend_from_slice(self.pen.way_to(to).as_bytes());
        self.pen = to;
    }

    /// Prints a cell with the pen that is in force.
    fn print(&mut self, at: Position, cell: &Cell) {
        self.go_to(at);
        self.bytes.extend_from_slice(cell.symbol().as_bytes());
        let next = at.x.saturating_add(columns(cell));
        // Behind the last column terminals differ.
        self.cursor = (next < self.size.width).then_some(Position::new(next, at.y));
        if let Some(shown) = self.shown.cell_mut(at) {
            shown.clone_from(cell);
        }
    }
}

/// Columns that a cell takes.
fn columns(cell: &Cell) -> u16 {
    u16::try_from(cell.symbol().width().max(1)).unwrap_or(u16::MAX)
}

impl Backend for Painter {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        let content: Vec<_> = content.collect();
        self.wipe_wide(&content);
        let mut style_runs = StyleRuns::of(content.into_iter());
        while let Some((pen, cells)) = style_runs.take_nearest(self.pen) {
            self.change_pen(pen);
            for (at, cell) in cells {
                self.print(at, cell);
            }
        }
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn show_cursor(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(Position::ORIGIN)
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, _position: P) -> io::Result<()> {
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        self.bytes.extend_from_slice(b"\x1b[m\x1b[2J");
        self.pen = Pen::default();
        self.cursor = None;
        let area = Rect::from((Position::ORIGIN, self.size));
        self.shown = Buffer::empty(area);
        Ok(())
    }

    /// The dashboard has the whole screen, so whatever is cleared is cleared whole.
    fn clear_region(&mut self, _region: ClearType) -> io::Result<()> {
        self.clear()
    }

    fn size(&self) -> io::Result<Size> {
        Ok(self.size)
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize {
            columns_rows: self.size,
            pixels: Size::ZERO,
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use ratatui::style::{Color, Modifier, Style};

    const WIDTH: u16 = 12;
    const HEIGHT: u16 = 4;

    /// A text somewhere in some style.
    type Stroke = (u16, u16, &'static str, Style);

    fn style() -> impl Strategy<Value = Style> {
        let colours = [
            Color::Reset,
            Color::Red,
            Color::White,
            Color::Indexed(200),
            Color::Rgb(1, 2, 3),
        ];
        let looks = [
            Modifier::empty(),
            Modifier::BOLD,
            Modifier::DIM,
            Modifier::BOLD | Modifier::UNDERLINED,
            Modifier::REVERSED,
        ];
        let colour = || proptest::sample::select(colours.to_vec());
        let looks = proptest::sample::select(looks.to_vec());
        (colour(), colour(), looks).prop_map(|(front, back, looks)| {
            let style = Style::new().fg(front).bg(back).add_modifier(looks);
            // Bold and dim at once is another thing on every terminal.
            style.remove_modifier(looks.complement())
        })
    }

    fn stroke() -> impl Strategy<Value = Stroke> {
        let texts = vec!["a", "bc d", "   ", "⣿⣿", " e ", "宽", "f宽宽 ", "e\u{301}"];
        let texts = proptest::sample::select(texts);
        (0..WIDTH, 0..HEIGHT, texts, style())
    }

    /// Where a stroke covers the right half of a wide character, the left half goes too:
    /// ratatui wants nothing behind a wide character but a blank.
    fn without_halves(buffer: &mut Buffer) {
        for index in 1..buffer.content.len() {
            let [left, right] = [&buffer.content[index - 1], &buffer.content[index]];
            if left.symbol().width() > 1 && *right != Cell::EMPTY {
                buffer.content[index - 1].set_symbol(" ");
            }
        }
    }

    /// What a terminal shows, cell by cell, blanks without what is not seen of them.
    fn seen(screen: &vt100::Screen) -> Vec<String> {
        let mut cells = Vec::new();
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                let cell = screen.cell(row, column).unwrap();
                let blank = cell.contents().trim().is_empty();
                let plain = blank && !cell.inverse() && !cell.underline();
                let back = cell.bgcolor();
                cells.push(match plain {
                    true => format!("blank on {back:?}"),
                    false => format!(
                        "{:?} {:?} on {back:?} {} {} {} {}",
                        cell.contents().trim(),
                        cell.fgcolor(),
                        cell.bold(),
                        cell.dim(),
                        cell.underline(),
                        cell.inverse()
                    ),
                });
            }
        }
        cells
    }

    fn terminal() -> vt100::Parser {
        let nonzero = |number| std::num::NonZeroU16::new(number).unwrap();
        vt100::Parser::new(nonzero(HEIGHT), nonzero(WIDTH), 0)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Frame after frame the terminal shows what it would show had everything been
        /// drawn on an empty screen by the plain backend.
        #[test]
        fn the_terminal_shows_what_was_painted(
            frames in prop::collection::vec(prop::collection::vec(stroke(), 0..8), 1..6)
        ) {
            let size = Size::new(WIDTH, HEIGHT);
            let mut painter = ratatui::Terminal::new(Painter::new(size)).unwrap();
            painter.clear().unwrap();
            let mut short_way = terminal();
            let mut style_runs: Vec<Stroke> = Vec::new();
            for frame in frames {
                style_runs.extend(frame);
                let paint = |buffer: &mut Buffer| {
                    for &(x, y, text, style) in &style_runs {
                        buffer.set_string(x, y, text, style);
                    }
                    without_halves(buffer);
                };
                painter.draw(|frame| paint(frame.buffer_mut())).unwrap();
                short_way.process(&painter.backend_mut().take_frame().unwrap_or_default());

                let mut bytes = Vec::new();
                let mut whole = Buffer::empty(Rect::new(0, 0, WIDTH, HEIGHT));
                paint(&mut whole);
                let empty = Buffer::empty(whole.area);
                let mut plain = ratatui::backend::CrosstermBackend::new(&mut bytes);
                plain.draw(empty.diff(&whole).into_iter()).unwrap();
                let mut long_way = terminal();
                long_way.process(&bytes);
                prop_assert_eq!(seen(short_way.screen()), seen(long_way.screen()));
            }
        }
    }
}
