//! Where ratatui paints: bytes for a terminal, as few as possible, collected until the
//! frame is whole.

use std::io::{self, Write};

use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect, Size};
use unicode_width::UnicodeWidthStr;

use super::pen::Pen;

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

    /// Brings the cursor to a place: by printing again what stands on the way, by a move
    /// within the line, or from anywhere.
    fn go_to(&mut self, to: Position) -> io::Result<()> {
        match self.cursor {
            Some(cursor) if cursor == to => {}
            Some(cursor) if cursor.y == to.y && cursor.x < to.x => {
                if !self.reprint(cursor, to) {
                    match to.x - cursor.x {
                        1 => self.bytes.extend_from_slice(b"\x1b[C"),
                        columns => write!(self.bytes, "\x1b[{columns}C")?,
                    }
                }
            }
            _ => match to.x {
                0 => write!(self.bytes, "\x1b[{}H", to.y + 1)?,
                x => write!(self.bytes, "\x1b[{};{}H", to.y + 1, x + 1)?,
            },
        }
        self.cursor = Some(to);
        Ok(())
    }

    /// Prints again what stands between two places of a line, if that is not longer than a
    /// move and the pen need not change. Returns whether it did.
    fn reprint(&mut self, from: Position, to: Position) -> bool {
        const MOVE: usize = "\x1b[2C".len();
        let mut text = String::new();
        for x in from.x..to.x {
            let Some(cell) = self.shown.cell((x, from.y)) else {
                return false;
            };
            text.push_str(cell.symbol());
            let same = self.pen.for_cell(cell) == self.pen && cell.symbol().width() == 1;
            if !same || text.len() > MOVE {
                return false;
            }
        }
        self.bytes.extend_from_slice(text.as_bytes());
        true
    }

    fn print(&mut self, at: Position, cell: &Cell) -> io::Result<()> {
        self.go_to(at)?;
        let pen = self.pen.for_cell(cell);
        self.pen.change(pen, &mut self.bytes);
        self.pen = pen;
        self.bytes.extend_from_slice(cell.symbol().as_bytes());
        let width = u16::try_from(cell.symbol().width().max(1)).unwrap_or(u16::MAX);
        let next = at.x.saturating_add(width);
        // Behind the last column terminals differ.
        self.cursor = (next < self.size.width).then_some(Position::new(next, at.y));
        if let Some(shown) = self.shown.cell_mut(at) {
            shown.clone_from(cell);
        }
        Ok(())
    }
}

impl Backend for Painter {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        for (x, y, cell) in content {
            self.print(Position::new(x, y), cell)?;
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
        // No wide characters: one of which half is overwritten differs between terminals.
        let texts = proptest::sample::select(vec!["a", "bc d", "   ", "⣿⣿", " e "]);
        (0..WIDTH, 0..HEIGHT, texts, style())
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
            let mut strokes: Vec<Stroke> = Vec::new();
            for frame in frames {
                strokes.extend(frame);
                let paint = |buffer: &mut Buffer| {
                    for &(x, y, text, style) in &strokes {
                        buffer.set_string(x, y, text, style);
                    }
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
