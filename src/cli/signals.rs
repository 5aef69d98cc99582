//! The signals that end the program: SIGINT, SIGTERM, SIGQUIT and SIGHUP.

use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, unbounded};
use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
use signal_hook::iterator::Signals;

use super::output::Failure;
use crate::dashboard::terminal;

/// Catches the signals that end the program and queues them.
#[derive(Debug)]
pub(super) struct SignalWatcher {
    /// The signals, in the order in which they arrived.
    pub(super) received: Receiver<i32>,
}

/// The signal that ended the program, if any.
#[derive(Clone, Debug, Default)]
pub(super) struct Termination {
    signal: Arc<AtomicI32>,
}

impl SignalWatcher {
    /// Starts to catch SIGINT, SIGTERM and, unless they are ignored, SIGQUIT and SIGHUP.
    ///
    /// SIGQUIT saves and restores as SIGTERM does: a terminal left raw and an unsaved
    /// generation cost the user more than a dump of memory helps.
    ///
    /// A second SIGINT, SIGTERM or SIGQUIT ends the program at once. That loses nothing, because a
    /// run survives a crash too. SIGHUP does not count: when a connection is lost it is sent
    /// twice, by the system and by the shell.
    pub(super) fn start() -> Result<Self, Failure> {
        let mut watched = vec![SIGINT, SIGTERM];
        watched.extend(
            [SIGQUIT, SIGHUP]
                .into_iter()
                .filter(|&one| !is_ignored(one)),
        );
        let mut signals = Signals::new(watched)?;
        let (sender, received) = unbounded();
        let watch = move || {
            let mut interrupted = false;
            for signal in signals.forever() {
                if interrupted && signal != SIGHUP {
                    terminal::restore();
                    signal_hook::low_level::exit(128 + signal);
                }
                interrupted |= signal != SIGHUP;
                // Without a receiver the program is about to end anyway.
                let _ = sender.send(signal);
            }
        };
        spawn("signals", watch)?;
        Ok(Self { received })
    }

    /// Records every signal in `termination` and calls `stop`, starting with the signals that
    /// are queued already.
    ///
    /// With `survives_hangup`, SIGHUP detaches the program from its terminal instead.
    pub(super) fn stop_on_signals(
        self,
        termination: &Termination,
        survives_hangup: bool,
        stop: impl Fn() + Send + 'static,
    ) -> Result<(), Failure> {
        let termination = termination.clone();
        spawn("ending", move || {
            for signal in &self.received {
                if signal == SIGHUP && survives_hangup {
                    // Fails only without /dev/null, and then the work goes on all the same.
                    let _detached = terminal::detach();
                } else {
                    termination.record(signal);
                    stop();
                }
            }
        })
    }
}

impl Termination {
    /// Records the signal that ended the program.
    pub(super) fn record(&self, signal: i32) {
        self.signal.store(signal, Ordering::SeqCst);
    }

    /// Records that the user stopped unfinished work from the dashboard.
    ///
    /// This counts as Ctrl-C: a script must not take the work for finished.
    pub(super) fn record_user_stop(&self) {
        self.record(SIGINT);
    }

    /// The exit code for the recorded signal: 128 plus its number.
    pub(super) fn exit_code(&self) -> Option<u8> {
        match self.signal.load(Ordering::SeqCst) {
            0 => None,
            signal => u8::try_from(128 + signal).ok(),
        }
    }
}

/// Runs `work` in a thread with a name.
pub(super) fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> Result<(), Failure> {
    thread::Builder::new().name(name.to_owned()).spawn(work)?;
    Ok(())
}

/// Whether the program was started with a signal ignored, as `nohup` does with SIGHUP.
///
/// Only Linux tells; elsewhere the signal is caught.
fn is_ignored(signal: i32) -> bool {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else {
        return false;
    };
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask & (1 << (signal - 1)) != 0)
}
