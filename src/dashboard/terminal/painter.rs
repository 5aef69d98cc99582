//! Where ratatui paints: bytes for a terminal, collected until the frame is whole.

use std::io;

use ratatui::backend::{Backend, ClearType, CrosstermBackend, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};

/// Tells the terminal to show what follows at once, when it is whole.
const BEGIN_FRAME: &[u8] = b"\x1b[?2026h";
/// Tells the terminal that the frame is whole.
const END_FRAME: &[u8] = b"\x1b[?2026l";

/// Collects the bytes of one frame. The cursor is hidden as long as there are frames, so a
/// frame in which nothing has changed has no bytes at all.
#[derive(Debug)]
pub(super) struct Painter {
    bytes: Vec<u8>,
    pub(super) size: Size,
}

impl Painter {
    pub(super) fn new(size: Size) -> Self {
        Self {
            bytes: Vec::new(),
            size,
        }
    }

    /// The frame since the last call, wrapped so that it appears at once.
    pub(super) fn take_frame(&mut self) -> Option<Vec<u8>> {
        if self.bytes.is_empty() {
            return None;
        }
        let frame = [BEGIN_FRAME, &self.bytes, END_FRAME].concat();
        self.bytes.clear();
        Some(frame)
    }

    fn crossterm(&mut self) -> CrosstermBackend<&mut Vec<u8>> {
        CrosstermBackend::new(&mut self.bytes)
    }
}

impl Backend for Painter {
    type Error = io::Error;

    fn draw<'a, I>(&mut self, content: I) -> io::Result<()>
    where
        I: Iterator<Item = (u16, u16, &'a Cell)>,
    {
        let mut content = content.peekable();
        match content.peek() {
            Some(_) => self.crossterm().draw(content),
            None => Ok(()),
        }
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
        self.crossterm().clear()
    }

    fn clear_region(&mut self, clear_type: ClearType) -> io::Result<()> {
        self.crossterm().clear_region(clear_type)
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
