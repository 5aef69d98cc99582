//! A gate at which running work pauses and stops, and its steps are counted.

use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};

use thiserror::Error;

/// The error of work that was stopped before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("stopped")]
pub struct Stopped;

const OPEN: u8 = 0;
const CLOSED: u8 = 1;
const STOPPED: u8 = 2;

/// A gate that all computing threads pass every few control steps.
///
/// Threads wait while it is closed. Once it is stopped they give up, for good. Passing an
/// open gate costs one relaxed load.
#[derive(Debug, Default)]
pub struct Gate {
    state: AtomicU8,
    lock: Mutex<()>,
    changed: Condvar,
    control_steps: AtomicU64,
}

impl Gate {
    /// Control steps between two passes of the gate: well under a millisecond of work.
    pub const STRIDE: u32 = 128;

    /// Counts `steps` control steps and passes the gate; waits while it is closed.
    ///
    /// # Errors
    /// When the gate is stopped.
    #[inline]
    pub fn pass(&self, steps: u32) -> Result<(), Stopped> {
        self.control_steps
            .fetch_add(u64::from(steps), Ordering::Relaxed);
        if self.state.load(Ordering::Relaxed) == OPEN {
            Ok(())
        } else {
            self.wait()
        }
    }

    /// Opens the gate: work continues.
    pub fn open(&self) {
        self.set(OPEN);
    }

    /// Closes the gate: work waits.
    pub fn close(&self) {
        self.set(CLOSED);
    }

    /// Stops all work, for good.
    pub fn stop(&self) {
        self.set(STOPPED);
    }

    /// Returns whether the gate is closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.state.load(Ordering::Relaxed) == CLOSED
    }

    /// Returns whether work was stopped.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.state.load(Ordering::Relaxed) == STOPPED
    }

    /// Returns the control steps counted so far. This number, for displays, runs ahead of
    /// the results.
    #[must_use]
    pub fn control_steps(&self) -> u64 {
        self.control_steps.load(Ordering::Relaxed)
    }

    fn set(&self, state: u8) {
        let _guard = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        if self.state.load(Ordering::Relaxed) != STOPPED {
            self.state.store(state, Ordering::Relaxed);
        }
        self.changed.notify_all();
    }

    fn wait(&self) -> Result<(), Stopped> {
        let mut guard = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            match self.state.load(Ordering::Relaxed) {
                OPEN => return Ok(()),
                STOPPED => return Err(Stopped),
                _ => {
                    guard = self
                        .changed
                        .wait(guard)
                        .unwrap_or_else(PoisonError::into_inner)
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_closed_gate_holds_work_and_a_stopped_gate_ends_it() {
        let gate = Gate::default();
        gate.close();
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| gate.pass(5));
            std::thread::sleep(Duration::from_millis(20));
            assert!(!worker.is_finished());
            gate.open();
            assert_eq!(worker.join().unwrap(), Ok(()));
        });
        gate.stop();
        gate.open();
        assert_eq!(gate.pass(1), Err(Stopped));
        assert_eq!(gate.control_steps(), 6);
    }
}
