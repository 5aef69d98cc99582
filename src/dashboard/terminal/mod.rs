//! The terminal: it is taken, drawn to, read from, lent to the shell, and restored.
//!
//! Three rules hold throughout. The terminal is restored on every exit. Only two threads ever
//! wait for it: one that writes and one that reads. A terminal that is gone is never used
//! again.

mod abilities;
mod background;
mod cursor;
mod decoder;
mod jobs;
mod keyboard;
mod painter;
mod pen;
mod screen;
mod sequences;
mod style_runs;
mod tty;
mod writer;

use std::io;
use std::panic;
use std::sync::{Arc, Once};

use crossbeam_channel::Receiver;
use ratatui::Frame;
use ratatui::crossterm::event::Event;
use ratatui::layout::Size;
use rustix::process::{Signal, kill_current_process_group};

pub use abilities::Abilities;
pub use background::Background;
pub use jobs::Job;
pub use screen::restore;
pub use tty::{LARGEST_SIDE, detach, is_attached, is_terminal};

use jobs::Jobs;
use keyboard::Keyboard;
use painter::Painter;
use screen::Screen;
use tty::Tty;
use writer::Writer;

/// The terminal of this process.
#[derive(Debug)]
pub struct Terminal {
    /// Keys and mouse events; disconnected when the terminal is gone.
    pub keys: Receiver<Event>,
    /// Signals of job control and of the window.
    pub jobs: Receiver<Job>,
    /// Notified when a frame has been written and the next one can be drawn; an error when the
    /// terminal is gone.
    pub drawn: Receiver<io::Result<()>>,
    /// The background, if the terminal was asked for it and has answered.
    pub background: Option<Background>,
    screen: Arc<Screen>,
    painter: ratatui::Terminal<Painter>,
    writer: Writer,
    keyboard: Keyboard,
    _jobs: Jobs,
}

impl Terminal {
    /// Opens the terminal of standard input, without any visible effect yet. If `asks`, asks it for
    /// its background, and waits a moment for the answer.
    ///
    /// From now on a panic of any thread restores the terminal before it is reported.
    ///
    /// # Errors
    /// When standard input is not a terminal, or the operating system refuses.
    pub fn open(mouse: bool, asks: bool) -> io::Result<Self> {
        let screen = Screen::new(Tty::open()?, mouse);
        give_back_on_panic();
        let (background, typed) = if asks {
            background::ask(&screen.tty)
        } else {
            (None, Vec::new())
        };
        let (keyboard, keys) = Keyboard::start(Arc::clone(&screen), typed)?;
        let (writer, drawn) = Writer::start(Arc::clone(&screen))?;
        let (jobs, told) = Jobs::start()?;
        let size = screen.tty.size().unwrap_or(Size::new(80, 24));
        Ok(Self {
            keys,
            jobs: told,
            drawn,
            background,
            screen,
            painter: ratatui::Terminal::new(Painter::new(size))?,
            writer,
            keyboard,
            _jobs: jobs,
        })
    }

    /// Takes the screen and reads keys; the next frame is drawn completely.
    ///
    /// Does nothing while the program is in the background.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub fn show(&mut self) -> io::Result<()> {
        if !self.screen.tty.is_foreground() {
            return Ok(());
        }
        self.screen.enter()?;
        self.resize();
        self.painter.clear()?;
        self.keyboard.listen();
        Ok(())
    }

    /// Lends the screen to the shell.
    pub fn hide(&mut self) {
        self.keyboard.hush();
        self.screen.leave();
    }

    /// Returns whether the program has the screen.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.screen.is_entered()
    }

    /// Returns whether the terminal was restored for good because a thread has panicked.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.screen.is_closed()
    }

    /// Returns whether a frame can be drawn now: the program has the screen, and the previous
    /// frame has been written.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.is_shown() && self.writer.is_free()
    }

    /// Draws a frame; only changes are sent.
    ///
    /// # Errors
    /// When the frame cannot be encoded.
    pub fn draw(&mut self, render: impl FnOnce(&mut Frame<'_>)) -> io::Result<()> {
        self.painter.draw(render)?;
        if let Some(frame) = self.painter.backend_mut().take_frame() {
            self.writer.send(frame);
        }
        Ok(())
    }

    /// Reads and returns the current size of the window.
    pub fn resize(&mut self) -> Size {
        let painter = self.painter.backend_mut();
        if let Some(size) = self.screen.tty.size() {
            painter.size = size;
        }
        painter.size
    }

    /// Returns the bytes of frames sent so far.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.screen.written()
    }

    /// Asks the whole job to stop, as Ctrl-Z does outside of raw mode.
    ///
    /// Returns `false` if no shell could continue it.
    #[must_use]
    pub fn ask_to_suspend(&self) -> bool {
        tty::can_be_continued() && kill_current_process_group(Signal::TSTP).is_ok()
    }

    /// Restores the screen and stops this process until it is continued; the caller then
    /// receives [`Job::Continue`].
    pub fn suspend(&mut self) {
        if tty::can_be_continued() {
            self.hide();
            // If the process cannot be stopped, it simply keeps running.
            let _ = signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP);
        }
    }

    /// Resumes after a stop: takes and redraws the screen in the foreground, leaves it alone in
    /// the background.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub fn go_on(&mut self) -> io::Result<()> {
        if self.screen.tty.is_foreground() {
            return self.show();
        }
        self.keyboard.hush();
        self.screen.lose();
        Ok(())
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        self.hide();
        restore();
    }
}

fn give_back_on_panic() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let report = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            restore();
            report(panic);
        }));
    });
}
