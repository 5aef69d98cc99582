//! Signals that end the program.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::output::Failure;

/// Signals that end the program, caught from now on; they wait to be heard.
#[derive(Debug)]
pub(super) struct Caught {
    signals: Signals,
}

/// The first signal that asked the program to end.
#[derive(Clone, Debug, Default)]
pub(super) struct Ended {
    signal: Arc<AtomicI32>,
}

impl Caught {
    /// Catches SIGINT, SIGTERM and SIGHUP; a second one of them ends the program at once,
    /// which loses no more than a crash would: nothing.
    pub(super) fn now() -> Result<Self, Failure> {
        let again = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            // Order matters: on the second signal the flag is set already.
            let code = 128 + signal;
            signal_hook::flag::register_conditional_shutdown(signal, code, Arc::clone(&again))?;
            signal_hook::flag::register(signal, Arc::clone(&again))?;
        }
        Ok(Self {
            signals: Signals::new([SIGINT, SIGTERM, SIGHUP])?,
        })
    }

    /// Calls `stop` on the first signal, the one that waits already if there is one.
    pub(super) fn then(mut self, stop: impl Fn() + Send + 'static) -> Result<Ended, Failure> {
        let ended = Ended::default();
        let first = ended.clone();
        std::thread::Builder::new()
            .name(String::from("signals"))
            .spawn(move || {
                if let Some(signal) = self.signals.forever().next() {
                    first.signal.store(signal, Ordering::SeqCst);
                    stop();
                }
            })?;
        Ok(ended)
    }
}

impl Ended {
    /// The exit code that tells which signal ended the program: 128 and its number.
    pub(super) fn exit_code(&self) -> Option<u8> {
        match self.signal.load(Ordering::SeqCst) {
            0 => None,
            signal => u8::try_from(128 + signal).ok(),
        }
    }
}
