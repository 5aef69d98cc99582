//! What a person does at the terminal, read by a thread of its own.

use std::io::{self, Write};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded};
use crossterm::event::{self, Event};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::io::Errno;

use super::screen::Screen;

/// Keys that wait to be acted upon before the terminal keeps them.
const CAPACITY: usize = 1024;

/// Time that crossterm is given to make an event of bytes that are there.
const MOMENT: Duration = Duration::from_millis(1);

/// Longest wait for the reader to be silent.
const PATIENCE: Duration = Duration::from_millis(200);

/// Reads the terminal while it listens.
#[derive(Debug)]
pub(super) struct Keyboard {
    state: Arc<State>,
    wake: UnixStream,
}

#[derive(Debug)]
struct State {
    listening: AtomicBool,
    ended: AtomicBool,
    /// Whether the reader keeps its hands off the terminal.
    silent: Mutex<bool>,
    changed: Condvar,
}

impl Keyboard {
    /// Also returns what is read; it ends when the terminal is gone.
    pub(super) fn start(screen: Arc<Screen>) -> io::Result<(Self, Receiver<Event>)> {
        let (sender, events) = bounded(CAPACITY);
        let (wake, woken) = UnixStream::pair()?;
        wake.set_nonblocking(true)?;
        woken.set_nonblocking(true)?;
        let state = Arc::new(State {
            listening: AtomicBool::new(false),
            ended: AtomicBool::new(false),
            silent: Mutex::new(true),
            changed: Condvar::new(),
        });
        let reader = Reader {
            screen,
            state: Arc::clone(&state),
            woken,
            sender,
        };
        thread::Builder::new()
            .name(String::from("terminal input"))
            .spawn(move || reader.run())?;
        Ok((Self { state, wake }, events))
    }

    /// Begins to read, or to read again.
    pub(super) fn listen(&self) {
        self.state.listening.store(true, Ordering::SeqCst);
        self.wake();
    }

    /// Stops reading, so that what is typed reaches others; returns when it is so.
    pub(super) fn hush(&self) {
        self.state.listening.store(false, Ordering::SeqCst);
        self.wake();
        let silent = self.state.silent.lock();
        let silent = silent.unwrap_or_else(PoisonError::into_inner);
        // A reader that does not answer has ended, or waits for its events to be taken.
        let _waited = self
            .state
            .changed
            .wait_timeout_while(silent, PATIENCE, |silent| !*silent);
    }

    fn wake(&self) {
        // A full pipe wakes as well as one more byte.
        let _full = (&self.wake).write(&[0]);
    }
}

impl Drop for Keyboard {
    fn drop(&mut self) {
        self.state.ended.store(true, Ordering::SeqCst);
        self.hush();
    }
}

struct Reader {
    screen: Arc<Screen>,
    state: Arc<State>,
    woken: UnixStream,
    sender: Sender<Event>,
}

impl Reader {
    /// Reads until nobody listens any more or the terminal is gone. Every wait is for the
    /// operating system: a terminal that is gone must not be asked again and again.
    fn run(self) {
        while !self.state.ended.load(Ordering::SeqCst) {
            let listening = self.state.listening.load(Ordering::SeqCst);
            self.say_silent(!listening);
            if self.wait(listening).is_err() || (listening && self.read().is_err()) {
                break;
            }
        }
        self.say_silent(true);
    }

    /// Waits for something to read, if the reader listens, or to be woken.
    fn wait(&self, listening: bool) -> io::Result<()> {
        let mut descriptors = [
            PollFd::new(&self.woken, PollFlags::IN),
            PollFd::from_borrowed_fd(self.screen.tty.descriptor(), PollFlags::IN),
        ];
        let waited_for = if listening { 2 } else { 1 };
        match poll(&mut descriptors[..waited_for], None) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        let gone = PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL;
        if listening && descriptors[1].revents().intersects(gone) {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        let mut bytes = [0; 64];
        while matches!(io::Read::read(&mut &self.woken, &mut bytes), Ok(count) if count > 0) {}
        Ok(())
    }

    fn read(&self) -> io::Result<()> {
        while self.state.listening.load(Ordering::SeqCst) && event::poll(MOMENT)? {
            let read = event::read()?;
            // Sizes come with their signal.
            let told = match read {
                Event::Resize(..) => Ok(()),
                event => self.sender.send(event),
            };
            told.map_err(|_| io::Error::from(io::ErrorKind::BrokenPipe))?;
        }
        Ok(())
    }

    fn say_silent(&self, is: bool) {
        let silent = self.state.silent.lock();
        *silent.unwrap_or_else(PoisonError::into_inner) = is;
        self.state.changed.notify_all();
    }
}
