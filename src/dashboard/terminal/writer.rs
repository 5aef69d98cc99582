//! The way of frames to the terminal: through a thread of its own, one at a time.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded};

use super::screen::Screen;

/// Takes a frame only when the one before has gone. A terminal that is slow or stuck thus
/// costs frames, and never anybody's time: what changes meanwhile is in the next frame.
#[derive(Debug)]
pub(super) struct Writer {
    frames: Sender<Vec<u8>>,
    free: Arc<AtomicBool>,
}

impl Writer {
    /// Also returns who is told that the writer is free again, or that the terminal is gone.
    pub(super) fn start(screen: Arc<Screen>) -> io::Result<(Self, Receiver<io::Result<()>>)> {
        let (frames, to_write) = bounded::<Vec<u8>>(1);
        let (sender, done) = bounded(1);
        let free = Arc::new(AtomicBool::new(true));
        let freed = Arc::clone(&free);
        thread::Builder::new()
            .name(String::from("terminal output"))
            .spawn(move || {
                for frame in to_write {
                    let written = screen.write(&frame);
                    freed.store(true, Ordering::SeqCst);
                    // Nobody has taken the last notice: they will look anyway.
                    let _told = sender.try_send(written);
                }
            })?;
        Ok((Self { frames, free }, done))
    }

    pub(super) fn is_free(&self) -> bool {
        self.free.load(Ordering::SeqCst)
    }

    /// Sends a frame on its way. To be called when the writer is free.
    pub(super) fn send(&self, frame: Vec<u8>) {
        self.free.store(false, Ordering::SeqCst);
        if self.frames.try_send(frame).is_err() {
            self.free.store(true, Ordering::SeqCst);
        }
    }
}
