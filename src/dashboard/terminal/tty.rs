//! The terminal device of the operating system.

use std::io;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use ratatui::layout::Size;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fd::{AsFd, BorrowedFd, OwnedFd};
use rustix::fs::{Mode, OFlags, open};
use rustix::io::Errno;
use rustix::process::{getpgrp, getppid, getsid};
use rustix::stdio::{dup2_stderr, dup2_stdin, dup2_stdout, stderr, stdin, stdout};
use rustix::termios::{
    OptionalActions, QueueSelector, Termios, isatty, tcflush, tcgetattr, tcgetpgrp, tcgetwinsize,
    tcsetattr, ttyname,
};

/// Longest wait for a terminal that accepts no bytes, before the writer checks again whether
/// the bytes are still wanted.
const SLICE: Duration = Duration::from_millis(20);

/// Largest number of columns, and of rows, of a frame.
///
/// A terminal may claim any size; a frame beyond this limit would only take memory.
pub const LARGEST_SIDE: u16 = 1000;

/// A terminal with its own open file description, so that non-blocking mode does not affect the
/// shell that started the program.
#[derive(Debug)]
pub(super) struct Tty {
    descriptor: OwnedFd,
    /// The modes to restore; `None` while they are in force.
    before: Mutex<Option<Termios>>,
}

/// Returns whether a dashboard can be shown: standard input and output are terminals.
#[must_use]
pub fn is_terminal() -> bool {
    isatty(stdin()) && isatty(stdout())
}

/// Returns whether any standard stream is a terminal, whose line can drop.
#[must_use]
pub fn is_attached() -> bool {
    isatty(stdin()) || isatty(stdout()) || isatty(stderr())
}

/// Detaches from the terminal: standard streams become `/dev/null`.
///
/// # Errors
/// When `/dev/null` cannot be opened.
pub fn detach() -> io::Result<()> {
    let null = open("/dev/null", OFlags::RDWR | OFlags::CLOEXEC, Mode::empty())?;
    dup2_stdin(&null)?;
    dup2_stdout(&null)?;
    dup2_stderr(&null)?;
    Ok(())
}

impl Tty {
    /// Opens the terminal of standard input and makes it the new standard input, so that
    /// reading does not block either.
    pub(super) fn open() -> io::Result<Self> {
        let flags = OFlags::RDWR | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
        let named = ttyname(stdin(), Vec::new())
            .and_then(|name| open(name.as_c_str(), flags, Mode::empty()));
        // Inside a container the name may not exist.
        let descriptor = named.or_else(|_| open("/dev/tty", flags, Mode::empty()))?;
        dup2_stdin(&descriptor)?;
        Ok(Self {
            descriptor,
            before: Mutex::new(None),
        })
    }

    pub(super) fn descriptor(&self) -> BorrowedFd<'_> {
        self.descriptor.as_fd()
    }

    /// Returns the size of the window up to [`LARGEST_SIDE`]; a larger window is used in its top
    /// left corner.
    pub(super) fn size(&self) -> Option<Size> {
        let size = tcgetwinsize(&self.descriptor).ok()?;
        // A serial line has no size and reports 0 by 0.
        match (size.ws_col, size.ws_row) {
            (0, _) | (_, 0) => Some(Size::new(80, 24)),
            (width, height) => Some(Size::new(width.min(LARGEST_SIDE), height.min(LARGEST_SIDE))),
        }
    }

    /// Returns whether the program is the foreground job, which may read keys and draw.
    pub(super) fn is_foreground(&self) -> bool {
        // On a terminal without job control every program may.
        tcgetpgrp(&self.descriptor).map_or(true, |group| group == getpgrp())
    }

    /// Enters raw mode: every key reaches the program as it is pressed.
    pub(super) fn make_raw(&self) -> io::Result<()> {
        let mut before = self.before();
        let now = tcgetattr(&self.descriptor)?;
        let mut raw = before.get_or_insert(now).clone();
        raw.make_raw();
        Ok(tcsetattr(&self.descriptor, OptionalActions::Now, &raw)?)
    }

    /// Restores the modes from before the first [`Tty::make_raw`].
    pub(super) fn restore(&self) -> io::Result<()> {
        match self.before().take() {
            Some(modes) => Ok(tcsetattr(&self.descriptor, OptionalActions::Now, &modes)?),
            None => Ok(()),
        }
    }

    /// Discards unread input.
    pub(super) fn forget_input(&self) -> io::Result<()> {
        Ok(tcflush(&self.descriptor, QueueSelector::IFlush)?)
    }

    fn before(&self) -> MutexGuard<'_, Option<Termios>> {
        self.before.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes while the bytes are wanted; returns whether all of them were written.
    pub(super) fn write(
        &self,
        mut bytes: &[u8],
        wanted: impl Fn() -> bool,
        mut written: impl FnMut(usize),
    ) -> io::Result<bool> {
        while !bytes.is_empty() {
            if !wanted() {
                return Ok(false);
            }
            match rustix::io::write(&self.descriptor, bytes) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(count) => {
                    written(count);
                    bytes = &bytes[count..];
                }
                Err(Errno::INTR) => {}
                Err(Errno::AGAIN) => self.wait()?,
                Err(error) => return Err(error.into()),
            }
        }
        Ok(true)
    }

    /// Writes a short sequence, and gives up after a time.
    pub(super) fn write_within(&self, bytes: &[u8], time: Duration) -> io::Result<bool> {
        let begun = Instant::now();
        self.write(bytes, || begun.elapsed() < time, |_| {})
    }

    fn wait(&self) -> io::Result<()> {
        let slice = Timespec {
            tv_sec: 0,
            tv_nsec: i64::from(SLICE.subsec_nanos()),
        };
        let mut descriptors = [PollFd::new(&self.descriptor, PollFlags::OUT)];
        match poll(&mut descriptors, Some(&slice)) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        let gone = PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL;
        if descriptors[0].revents().intersects(gone) {
            Err(io::ErrorKind::BrokenPipe.into())
        } else {
            Ok(())
        }
    }
}

/// Returns whether a shell could continue this program after it has stopped itself.
///
/// A program that is the only one of its terminal would stay stopped for ever.
pub(super) fn can_be_continued() -> bool {
    let leads_session = getsid(None).is_ok_and(|session| session == getpgrp());
    let orphan = getppid().is_none_or(|parent| parent.is_init());
    !leads_session && !orphan
}
