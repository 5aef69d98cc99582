//! What the shell and the window tell the program: stop, go on, another size.

use std::io;
use std::thread;

use crossbeam_channel::{Receiver, bounded};
use signal_hook::consts::{SIGCONT, SIGTSTP, SIGWINCH};
use signal_hook::iterator::{Handle, Signals};

/// What was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Job {
    /// Give the terminal back and stop (SIGTSTP).
    Suspend,
    /// The program goes on after it was stopped (SIGCONT).
    Continue,
    /// The window has another size (SIGWINCH).
    Resize,
}

/// Hears these signals until it is dropped.
#[derive(Debug)]
pub(super) struct Jobs {
    handle: Handle,
}

/// News that wait; of more than these the later ones say nothing new.
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
