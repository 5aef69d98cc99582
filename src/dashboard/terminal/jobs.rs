//! The signals of job control and of the window: suspend, continue, resize.

use std::io;
use std::thread;

use crossbeam_channel::{Receiver, bounded};
use signal_hook::consts::{SIGCONT, SIGTSTP, SIGWINCH};
use signal_hook::iterator::{Handle, Signals};

/// A signal of job control or of the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// Restore the terminal and stop (SIGTSTP).
    Suspend,
    /// The program continues after a stop (SIGCONT).
    Continue,
    /// The window has a new size (SIGWINCH).
    Resize,
}

/// Receives these signals until it is dropped.
#[derive(Debug)]
pub(super) struct Jobs {
    handle: Handle,
}

/// Capacity of the queue; more signals than these would repeat earlier ones.
const CAPACITY: usize = 16;

impl Jobs {
    pub(super) fn start() -> io::Result<(Self, Receiver<Job>)> {
        let mut signals = Signals::new([SIGTSTP, SIGCONT, SIGWINCH])?;
        let handle = signals.handle();
        let (sender, told) = bounded(CAPACITY);
        thread::Builder::new()
            .name(String::from("terminal signals"))
            .spawn(move || {
                for signal in signals.forever() {
                    let job = match signal {
                        SIGTSTP => Job::Suspend,
                        SIGCONT => Job::Continue,
                        _ => Job::Resize,
                    };
                    if sender.send(job).is_err() {
                        return;
                    }
                }
            })?;
        Ok((Self { handle }, told))
    }
}

impl Drop for Jobs {
    fn drop(&mut self) {
        self.handle.close();
    }
}
