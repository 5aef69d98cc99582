//! A thread that reads keys and mouse events.

use std::io::{self, Write};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded};
use ratatui::crossterm::event::Event;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

use super::decoder::Decoder;
use super::screen::Screen;

/// Capacity of the queue; further keys stay in the terminal's own queue.
const CAPACITY: usize = 1024;

/// Longest wait for the reader to stop reading.
const PATIENCE: Duration = Duration::from_millis(200);

/// The reader of the terminal, which reads only while it listens.
#[derive(Debug)]
pub(super) struct Keyboard {
    state: Arc<State>,
    wake: UnixStream,
}

#[derive(Debug)]
struct State {
    listening: AtomicBool,
    ended: AtomicBool,
    /// Whether the reader has stopped reading.
    silent: Mutex<bool>,
    changed: Condvar,
}

impl Keyboard {
    /// Starts the reader; the receiver of its events disconnects when the terminal is gone. The
    /// first events are those that were `typed` before.
    pub(super) fn start(
        screen: Arc<Screen>,
        typed: Vec<Event>,
    ) -> io::Result<(Self, Receiver<Event>)> {
        let (sender, events) = bounded(CAPACITY);
        for event in typed {
            // More keys than there is room for have no effect.
            let _full = sender.try_send(event);
        }
        let (wake, woken) = UnixStream::pair()?;
        wake.set_nonblocking(true)?;
        woken.set_nonblocking(true)?;
        let state = Arc::new(State {
            listening: AtomicBool::new(false),
            ended: AtomicBool::new(false),
            silent: Mutex::new(true),
            changed: Condvar::new(),
        });
        let mut reader = Reader {
            screen,
            state: Arc::clone(&state),
            woken,
            sender,
            decoder: Decoder::default(),
        };
        thread::Builder::new()
            .name(String::from("terminal input"))
            .spawn(move || reader.run())?;
        Ok((Self { state, wake }, events))
    }

    /// Starts or resumes reading.
    pub(super) fn listen(&self) {
        self.state.listening.store(true, Ordering::SeqCst);
        self.wake();
    }

    /// Pauses reading, so that other programs get the keys; returns when reading has stopped.
    pub(super) fn hush(&self) {
        self.state.listening.store(false, Ordering::SeqCst);
        self.wake();
        let silent = self.state.silent.lock();
        let silent = silent.unwrap_or_else(PoisonError::into_inner);
        // A reader that does not answer has ended, or its queue is full.
        let _waited = self
            .state
            .changed
            .wait_timeout_while(silent, PATIENCE, |silent| !*silent);
    }

    fn wake(&self) {
        // A full pipe wakes the reader just as well.
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
    decoder: Decoder,
}

impl Reader {
    /// Reads until the keyboard is dropped or the terminal is gone.
    ///
    /// Every wait blocks in the operating system, so that a terminal that is gone is not polled
    /// in a busy loop.
    fn run(&mut self) {
        while !self.state.ended.load(Ordering::SeqCst) {
            let listening = self.state.listening.load(Ordering::SeqCst);
            if !listening {
                // What follows was sent to another program.
                self.decoder = Decoder::default();
            }
            self.set_silent(!listening);
            if self.wait(listening).is_err() || (listening && self.read().is_err()) {
                break;
            }
        }
        self.set_silent(true);
    }

    /// Waits until the reader is woken or, while it listens, there is something to read or
    /// nothing has come for too long.
    fn wait(&mut self, listening: bool) -> io::Result<()> {
        let mut descriptors = [
            PollFd::new(&self.woken, PollFlags::IN),
            PollFd::from_borrowed_fd(self.screen.tty.descriptor(), PollFlags::IN),
        ];
        let waited_for = if listening { 2 } else { 1 };
        let patience = self.decoder.patience();
        let patience = patience.and_then(|time| Timespec::try_from(time).ok());
        let ready = match poll(&mut descriptors[..waited_for], patience.as_ref()) {
            Ok(ready) => Some(ready),
            Err(Errno::INTR) => None,
            Err(error) => return Err(error.into()),
        };
        let gone = PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL;
        if listening && descriptors[1].revents().intersects(gone) {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        if ready == Some(0) {
            let event = self.decoder.give_up();
            self.send(event)?;
        }
        let mut bytes = [0; 64];
        while matches!(io::Read::read(&mut &self.woken, &mut bytes), Ok(count) if count > 0) {}
        Ok(())
    }

    /// Reads what is there.
    fn read(&mut self) -> io::Result<()> {
        let mut bytes = [0; 1024];
        while self.state.listening.load(Ordering::SeqCst) {
            match rustix::io::read(self.screen.tty.descriptor(), &mut bytes) {
                Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
                Ok(count) => self.decode(&bytes[..count])?,
                Err(Errno::AGAIN) => return Ok(()),
                Err(Errno::INTR) => {}
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    fn decode(&mut self, bytes: &[u8]) -> io::Result<()> {
        for &byte in bytes {
            let event = self.decoder.take(byte);
            self.send(event)?;
        }
        Ok(())
    }

    fn send(&self, event: Option<Event>) -> io::Result<()> {
        let sent = event.map_or(Ok(()), |event| self.sender.send(event));
        sent.map_err(|_| io::ErrorKind::BrokenPipe.into())
    }

    fn set_silent(&self, is: bool) {
        let silent = self.state.silent.lock();
        *silent.unwrap_or_else(PoisonError::into_inner) = is;
        self.state.changed.notify_all();
    }
}
