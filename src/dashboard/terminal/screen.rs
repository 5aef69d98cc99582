//! The screen of the terminal: how it is taken, and how it is restored.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use super::tty::{Tty, detach};

/// Enters the alternate screen without a cursor, with bracketed paste so that pasted text is
/// not taken for keys. The pen is reset first, because the alternate screen restores the pen
/// that it found.
const ENTER: &[u8] = b"\x1b[0m\x1b[?1049h\x1b[?25l\x1b[?2004h";
/// Enables presses, wheel and drags of the mouse, in the encoding without a column limit.
const MOUSE: &[u8] = b"\x1b[?1000h\x1b[?1002h\x1b[?1006h";
/// Undoes everything, and ends a synchronised update that was cut off.
const LEAVE: &[u8] =
    b"\x1b[?2026l\x1b[?1006l\x1b[?1002l\x1b[?1000l\x1b[?2004l\x1b[0m\x1b[?25h\x1b[?1049l\x1b[0m";

/// Longest wait for a terminal that accepts no bytes, on entering and on leaving the screen.
const PATIENCE: Duration = Duration::from_millis(500);

/// The screen that must be restored if the program ends now.
static CURRENT: Mutex<Option<Arc<Screen>>> = Mutex::new(None);

/// The screen of the terminal, shared by the thread that writes and the threads that may have
/// to restore it.
#[derive(Debug)]
pub(super) struct Screen {
    pub(super) tty: Tty,
    mouse: bool,
    /// Whether the program has the screen.
    entered: AtomicBool,
    /// Whether the screen was restored for good.
    closed: AtomicBool,
    /// Held while a frame is written.
    writing: Mutex<()>,
    /// Held while the screen is restored, so that another thread that wants to restore it
    /// cannot end the program before that is done.
    leaving: Mutex<()>,
    /// Bytes of frames written so far.
    written: AtomicU64,
}

/// Restores the terminal now and for good, whatever other threads are doing.
///
/// If another thread is restoring it, returns when that is done. Does nothing if there is
/// nothing to restore.
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

    /// Takes the screen, even if the program already has it, because another program may have
    /// written to it.
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

    /// Restores the screen; returns whether the terminal accepted everything.
    ///
    /// A terminal that is gone or stuck is given up after a moment.
    pub(super) fn leave(&self) -> bool {
        let _leaving = lock_within(&self.leaving, 3 * PATIENCE);
        if !self.entered.swap(false, Ordering::SeqCst) {
            return true;
        }
        // The writer gives up a frame in progress within a slice of time. If the writer is this
        // thread, which has panicked, the lock is never released.
        let _writing = lock_within(&self.writing, PATIENCE);
        let taken = self.tty.write_within(LEAVE, PATIENCE);
        if self.mouse {
            // Pending mouse reports must not reach the shell.
            let _gone = self.tty.forget_input();
        }
        let _gone = self.tty.restore();
        taken.unwrap_or(false)
    }

    /// Records that the shell already has the screen and its modes.
    pub(super) fn lose(&self) {
        self.entered.store(false, Ordering::SeqCst);
    }

    /// Restores the screen for good. A terminal that does not accept this is detached, because
    /// it would block later messages too.
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

    /// Returns the bytes of frames written so far.
    pub(super) fn written(&self) -> u64 {
        self.written.load(Ordering::Relaxed)
    }

    /// Writes a frame, while the program has the screen.
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

/// Waits for a lock up to a time, because its holder may be stuck, or be this thread, which has
/// panicked.
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
