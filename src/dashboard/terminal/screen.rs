//! The screen while the program has it: what turns it on, and what gives it back.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use super::tty::{Tty, detach};

/// Alternate screen, no cursor; pasted text is marked, so that it is not taken for keys. The
/// pen is cleared first: the alternate screen gives back the pen that it found.
const ENTER: &[u8] = b"\x1b[0m\x1b[?1049h\x1b[?25l\x1b[?2004h";
/// Presses, wheel and drags of the mouse, in the form that has no limit of columns.
const MOUSE: &[u8] = b"\x1b[?1000h\x1b[?1002h\x1b[?1006h";
/// Everything back, and the end of a frame that was cut off.
const LEAVE: &[u8] =
    b"\x1b[?2026l\x1b[?1006l\x1b[?1002l\x1b[?1000l\x1b[?2004l\x1b[0m\x1b[?25h\x1b[?1049l\x1b[0m";

/// Longest wait for a terminal that takes nothing, on entering and on leaving it.
const PATIENCE: Duration = Duration::from_millis(500);

/// The screen that has to be given back if the program ends now.
static CURRENT: Mutex<Option<Arc<Screen>>> = Mutex::new(None);

/// The terminal's screen, shared by the threads that write to it and those that may
/// have to give it back.
#[derive(Debug)]
pub(super) struct Screen {
    pub(super) tty: Tty,
    mouse: bool,
    /// Whether the screen is ours.
    entered: AtomicBool,
    /// Whether it was given back for good.
    closed: AtomicBool,
    /// Held while a frame is written.
    writing: Mutex<()>,
    /// Held while the screen is given back: who wants the same must not go on, and end the
    /// program, before it is.
    leaving: Mutex<()>,
    /// Bytes of frames so far.
    written: AtomicU64,
}

/// Gives the terminal back, now and for good, whatever other threads are doing; if one is
/// doing the same, returns when it is done. Does nothing if there is nothing to give back.
pub fn restore() {
    let current = || lock_within(&CURRENT, PATIENCE);
    let screen = current().and_then(|current| current.clone());
    if let Some(screen) = screen {
        screen.close();
        if let Some(mut current) = current() {
            *current = None;
        }
    }
}

impl Screen {
    pub(super) fn new(tty: Tty, mouse: bool) -> Arc<Self> {
        let screen = Arc::new(Self {
            tty,
            mouse,
            entered: AtomicBool::new(false),
            closed: AtomicBool::new(false),
            writing: Mutex::new(()),
            leaving: Mutex::new(()),
            written: AtomicU64::new(0),
        });
        *CURRENT.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::clone(&screen));
        screen
    }

    /// Takes the screen; again, if somebody else has written to it.
    pub(super) fn enter(&self) -> io::Result<()> {
        if self.is_closed() {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        let _writing = lock_within(&self.writing, PATIENCE);
        self.tty.make_raw()?;
        self.entered.store(true, Ordering::SeqCst);
        self.tty.write_within(ENTER, PATIENCE)?;
        if self.mouse {
            self.tty.write_within(MOUSE, PATIENCE)?;
        }
        Ok(())
    }

    /// Gives the screen back. A terminal that is gone or stuck is no obstacle: what it
    /// does not take within a moment is given up. Returns whether it took everything.
    pub(super) fn leave(&self) -> bool {
        let _leaving = lock_within(&self.leaving, 3 * PATIENCE);
        if !self.entered.swap(false, Ordering::SeqCst) {
            return true;
        }
        // The frame that is being written is not wanted any more; its writer gives up within
        // a slice of time. If it is this thread, which panicked, it never does.
        let _writing = lock_within(&self.writing, PATIENCE);
        let taken = self.tty.write_within(LEAVE, PATIENCE);
        if self.mouse {
            // What the mouse has said meanwhile is not for the shell.
            let _gone = self.tty.forget_input();
        }
        let _gone = self.tty.restore();
        taken.unwrap_or(false)
    }

    /// The screen is somebody else's already: the shell has it, and its modes.
    pub(super) fn lose(&self) {
        self.entered.store(false, Ordering::SeqCst);
    }

    /// Gives the screen back, and there will be no other frame. A terminal that does not take
    /// this will not take what is printed afterwards either, and must not hold it up.
    pub(super) fn close(&self) {
        self.closed.store(true, Ordering::SeqCst);
        if !self.leave() {
            let _detached = detach();
        }
    }

    pub(super) fn is_closed(&self) -> bool {
        self.closed.load(Ordering::SeqCst)
    }

    pub(super) fn is_entered(&self) -> bool {
        self.entered.load(Ordering::SeqCst)
    }

    /// Bytes of frames written so far.
    pub(super) fn written(&self) -> u64 {
        self.written.load(Ordering::Relaxed)
    }

    /// Writes a frame, as long as the screen is ours.
    pub(super) fn write(&self, frame: &[u8]) -> io::Result<()> {
        let _writing = self.writing();
        let count = |bytes: usize| {
            self.written.fetch_add(bytes as u64, Ordering::Relaxed);
        };
        self.tty.write(frame, || self.is_entered(), count)?;
        Ok(())
    }

    fn writing(&self) -> MutexGuard<'_, ()> {
        self.writing.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Waits for a lock, and gives up after a time: the thread that has it may be stuck, or be
/// this one, which panicked.
fn lock_within<T>(mutex: &Mutex<T>, time: Duration) -> Option<MutexGuard<'_, T>> {
    let begun = Instant::now();
    loop {
        match mutex.try_lock() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(error)) => return Some(error.into_inner()),
            Err(TryLockError::WouldBlock) if begun.elapsed() >= time => return None,
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(1)),
        }
    }
}
