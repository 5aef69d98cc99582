//! Signals that end the program.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::output::Failure;

/// The first signal that asked the program to end.
#[derive(Clone, Debug, Default)]
pub(super) struct Ended {
    signal: Arc<AtomicI32>,
}

impl Ended {
    /// Calls `stop` on the first SIGINT, SIGTERM or SIGHUP; a second one of them ends the
    /// program at once, which loses no more than a crash would: nothing.
    pub(super) fn on_signal(stop: impl Fn() + Send + 'static) -> Result<Self, Failure> {
        let ended = Self::default();
        let again = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            // Order matters: on the second signal the flag is set already.
            let code = 128 + signal;
            signal_hook::flag::register_conditional_shutdown(signal, code, Arc::clone(&again))?;
            signal_hook::flag::register(signal, Arc::clone(&again))?;
        }
        let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP])?;
        let first = ended.clone();
        std::thread::Builder::new()
            .name(String::from("signals"))
            .spawn(move || {
                if let Some(signal) = signals.forever().next() {
                    first.signal.store(signal, Ordering::SeqCst);
                    stop();
                }
            })?;
        Ok(ended)
    }

    /// The exit code that tells which signal ended the program: 128 and its number.
    pub(super) fn exit_code(&self) -> Option<u8> {
        match self.signal.load(Ordering::SeqCst) {
            0 => None,
            signal => u8::try_from(128 + signal).ok(),
        }
    }
}
