//! A backend of ratatui that encodes a frame in as few bytes as possible.
//!
//! In reading order, changes of colour would take half of the bytes. All cells of one style are
//! therefore painted together ([`StyleRuns`]): cursor moves are shorter than changes of colour.

use std::io;

use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect, Size};
use unicode_width::UnicodeWidthStr;

use super::cursor::shortest_way;
use super::pen::Pen;
use super::style_runs::StyleRuns;

/// Begins a synchronised update, and resets the pen.
const BEGIN_FRAME: &[u8] = b"\x1b[?2026h\x1b[m";
/// Ends the synchronised update.
const END_FRAME: &[u8] = b"\x1b[?2026l";

/// The painter, which collects the bytes of one frame.
///
/// The cursor is hidden all the time, so that a frame without changes has no bytes at all.
#[derive(Debug)]
pub(super) struct Painter {
    bytes: Vec<u8>,
    pub(super) size: Size,
    /// The contents of the terminal.
    shown: Buffer,
    pen: Pen,
    /// The position of the cursor, if it is known.
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

    /// Returns the frame since the last call, wrapped in a synchronised update; `None` if it is
    /// empty.
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

    /// Moves the cursor, or reprints the cells on the way if that is not longer than a move.
    fn go_to(&mut self, to: Position) {
        if self.cursor == Some(to) {
            return;
        }
        let way = shortest_way(self.cursor, to);
        let way = self.printed_way(to, way.len()).unwrap_or(way);
        self.bytes.extend_from_slice(way.as_bytes());
        self.cursor = Some(to);
    }

    /// Returns the text between the cursor and a position to the right, if it is not longer
    /// than `longest` and needs no other pen.
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

    /// Blanks wide characters that are about to be overwritten, because terminals differ in
    /// what is left of half a character.
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

    /// Prints a cell with the current pen.
    fn print(&mut self, at: Position, cell: &Cell) {
        self.go_to(at);
        self.bytes.extend_from_slice(cell.symbol().as_bytes());
        let next = at.x.saturating_add(columns(cell));
        // Terminals differ in where the cursor is after the last column.
        self.cursor = (next < self.size.width).then_some(Position::new(next, at.y));
        if let Some(shown) = self.shown.cell_mut(at) {
            shown.clone_from(cell);
        }
    }
}

/// Returns the columns that a cell takes.
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

    /// Clears the whole screen, because the dashboard always owns all of it.
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

    /// A text at a position in a style.
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
            // Terminals differ in bold and dim together.
            style.remove_modifier(looks.complement())
        })
    }

    fn stroke() -> impl Strategy<Value = Stroke> {
        let texts = vec!["a", "bc d", "   ", "⣿⣿", " e ", "宽", "f宽宽 ", "e\u{301}"];
        let texts = proptest::sample::select(texts);
        (0..WIDTH, 0..HEIGHT, texts, style())
    }

    /// Removes the left half of a wide character whose right half is covered: ratatui expects a
    /// blank behind a wide character.
    fn without_halves(buffer: &mut Buffer) {
        for index in 1..buffer.content.len() {
            let [left, right] = [&buffer.content[index - 1], &buffer.content[index]];
            if left.symbol().width() > 1 && *right != Cell::EMPTY {
                buffer.content[index - 1].set_symbol(" ");
            }
        }
    }

    /// Returns the visible contents of a terminal, cell by cell.
    fn seen(screen: &vt100::Screen) -> Vec<String> {
        let mut cells = Vec::new();
        for row in 0..HEIGHT {
            for column in 0..WIDTH {
                let cell = screen.cell(row, column).unwrap();
                let blank = cell.contents().trim().is_empty();
                let plain = blank && !cell.inverse() && !cell.underline();
                let back = cell.bgcolor();
                cells.push(if plain {
                    format!("blank on {back:?}")
                } else {
                    format!(
                        "{:?} {:?} on {back:?} {} {} {} {}",
                        cell.contents().trim(),
                        cell.fgcolor(),
                        cell.bold(),
                        cell.dim(),
                        cell.underline(),
                        cell.inverse()
                    )
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

        /// After every frame the terminal shows the same as if everything had been drawn on an
        /// empty screen by the plain backend.
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
