//! Signals that end the program.

use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, unbounded};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::output::Failure;
use crate::dashboard::terminal;

/// Signals that end the program, caught from now on; they wait to be heard.
#[derive(Debug)]
pub(super) struct SignalWatcher {
    /// The signals, in the order in which they came.
    pub(super) heard: Receiver<i32>,
}

/// The signal that ended the program.
#[derive(Clone, Debug, Default)]
pub(super) struct Termination {
    signal: Arc<AtomicI32>,
}

impl SignalWatcher {
    /// Catches SIGINT, SIGTERM and SIGHUP; a second SIGINT or SIGTERM ends the program at
    /// once, which loses no more than a crash would: nothing. SIGHUP comes twice when a line
    /// drops, from the system and from the shell, and means the same both times.
    pub(super) fn now() -> Result<Self, Failure> {
        let caught = match hangup_is_ignored() {
            true => vec![SIGINT, SIGTERM],
            false => vec![SIGINT, SIGTERM, SIGHUP],
        };
        let mut signals = Signals::new(caught)?;
        let (sender, heard) = unbounded();
        thread::Builder::new()
            .name(String::from("signals"))
            .spawn(move || {
                let mut asked = false;
                for signal in signals.forever() {
                    if asked && signal != SIGHUP {
                        terminal::restore();
                        signal_hook::low_level::exit(128 + signal);
                    }
                    asked |= signal != SIGHUP;
                    // Who does not listen is about to end anyway.
                    let _ = sender.send(signal);
                }
            })?;
        Ok(Self { heard })
    }

    /// Calls `stop` on every signal, those that wait already first; where the work `survives`
    /// a line that drops, SIGHUP lets go of the terminal instead.
    pub(super) fn stop(
        self,
        ended: &Termination,
        survives: bool,
        stop: impl Fn() + Send + 'static,
    ) -> Result<(), Failure> {
        let ended = ended.clone();
        thread::Builder::new()
            .name(String::from("ending"))
            .spawn(move || {
                for signal in &self.heard {
                    if signal == SIGHUP && survives {
                        // Work without a terminal is not worth less for a system without
                        // /dev/null.
                        let _detached = terminal::detach();
                        continue;
                    }
                    ended.by(signal);
                    stop();
                }
            })?;
        Ok(())
    }

    /// Calls `stop` on the first signal, the one that waits already if there is one.
    pub(super) fn then(self, stop: impl FnOnce() + Send + 'static) -> Result<Termination, Failure> {
        let ended = Termination::default();
        let first = ended.clone();
        thread::Builder::new()
            .name(String::from("ending"))
            .spawn(move || {
                if let Ok(signal) = self.heard.recv() {
                    first.by(signal);
                    stop();
                }
            })?;
        Ok(ended)
    }
}

impl Termination {
    /// A signal ended the program.
    pub(super) fn by(&self, signal: i32) {
        self.signal.store(signal, Ordering::SeqCst);
    }

    /// A person ended the program, as Ctrl-C would: who waits for work that was not done, a
    /// script say, must not take it for done.
    pub(super) fn by_hand(&self) {
        self.by(SIGINT);
    }

    /// The exit code that tells which signal ended the program: 128 and its number.
    pub(super) fn exit_code(&self) -> Option<u8> {
        match self.signal.load(Ordering::SeqCst) {
            0 => None,
            signal => u8::try_from(128 + signal).ok(),
        }
    }
}

/// Whether the program was started to survive a line that drops, as by `nohup`.
fn hangup_is_ignored() -> bool {
    // Where the system does not tell, SIGHUP is caught.
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else {
        return false;
    };
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask & (1 << (SIGHUP - 1)) != 0)
}
