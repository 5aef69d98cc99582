//! The terminal's life: taken, drawn to, read from, lent to the shell, given back.
//!
//! Three rules hold throughout. The terminal is given back on every way out. Nobody waits
//! for it but the two threads that do nothing else: one writes, one reads. And a
//! terminal that is gone is never asked again.

mod cursor;
mod jobs;
mod keyboard;
mod painter;
mod pen;
mod screen;
mod style_runs;
mod tty;
mod writer;

use std::io;
use std::panic;
use std::sync::{Arc, Once};

use crossbeam_channel::Receiver;
use crossterm::event::Event;
use ratatui::Frame;
use ratatui::layout::Size;
use rustix::process::{Signal, kill_current_process_group};

pub use jobs::Job;
pub use screen::restore;
pub use tty::{detach, is_attached, is_terminal};

use jobs::Jobs;
use keyboard::Keyboard;
use painter::Painter;
use screen::Screen;
use tty::Tty;
use writer::Writer;

/// The terminal of this process.
#[derive(Debug)]
pub struct Terminal {
    /// What a person does; disconnected when the terminal is gone.
    pub keys: Receiver<Event>,
    /// What the shell and the window tell.
    pub jobs: Receiver<Job>,
    /// Told when a frame has gone and another can be drawn; an error when the
    /// terminal is gone.
    pub drawn: Receiver<io::Result<()>>,
    screen: Arc<Screen>,
    painter: ratatui::Terminal<Painter>,
    writer: Writer,
    keyboard: Keyboard,
    _jobs: Jobs,
}

impl Terminal {
    /// Opens the terminal of standard input; nothing is to be seen of that yet. From now on
    /// a panic of any thread gives the terminal back before it is reported.
    ///
    /// # Errors
    /// When standard input is no terminal, or the operating system refuses.
    pub fn open(mouse: bool) -> io::Result<Self> {
        let screen = Screen::new(Tty::open()?, mouse);
        give_back_on_panic();
        let (keyboard, keys) = Keyboard::start(Arc::clone(&screen))?;
        let (writer, drawn) = Writer::start(Arc::clone(&screen))?;
        let (jobs, told) = Jobs::start()?;
        let size = screen.tty.size().unwrap_or(Size::new(80, 24));
        Ok(Self {
            keys,
            jobs: told,
            drawn,
            screen,
            painter: ratatui::Terminal::new(Painter::new(size))?,
            writer,
            keyboard,
            _jobs: jobs,
        })
    }

    /// Takes the screen and reads keys; everything will be drawn anew. Does nothing while the
    /// program is in the background.
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

    /// Gives the screen back to the shell for a while.
    pub fn hide(&mut self) {
        self.keyboard.hush();
        self.screen.leave();
    }

    /// Whether the screen is ours.
    #[must_use]
    pub fn is_shown(&self) -> bool {
        self.screen.is_entered()
    }

    /// Whether the terminal was given back for good: a thread has panicked.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.screen.is_closed()
    }

    /// Whether a frame can be drawn now: the screen is ours and the last frame has gone.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.is_shown() && self.writer.is_free()
    }

    /// Draws a frame. Nothing is sent where nothing has changed.
    ///
    /// # Errors
    /// When bytes cannot be made of the frame.
    pub fn draw(&mut self, render: impl FnOnce(&mut Frame<'_>)) -> io::Result<()> {
        self.painter.draw(render)?;
        if let Some(frame) = self.painter.backend_mut().take_frame() {
            self.writer.send(frame);
        }
        Ok(())
    }

    /// The size of the window now.
    pub fn resize(&mut self) -> Size {
        let painter = self.painter.backend_mut();
        if let Some(size) = self.screen.tty.size() {
            painter.size = size;
        }
        painter.size
    }

    /// Bytes of frames sent so far.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.screen.written()
    }

    /// Asks the whole job, this program in it, to stop, as Ctrl-Z does outside of raw mode.
    /// Returns whether that is possible: somebody must be there to continue it.
    #[must_use]
    pub fn ask_to_suspend(&self) -> bool {
        tty::can_be_continued() && kill_current_process_group(Signal::TSTP).is_ok()
    }

    /// Gives the screen back and stops this process until it is continued; the caller is told
    /// [`Job::Continue`] then.
    pub fn suspend(&mut self) {
        if tty::can_be_continued() {
            self.hide();
            // Where stopping is not possible the program simply goes on.
            let _ = signal_hook::low_level::emulate_default_handler(signal_hook::consts::SIGTSTP);
        }
    }

    /// Goes on after the process was stopped: in the foreground the screen is taken and
    /// drawn anew, in the background it is left to others.
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
