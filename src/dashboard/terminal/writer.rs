//! A thread that writes frames to the terminal, one at a time.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded};

use super::screen::Screen;

/// The writer of frames, which accepts a frame only when the previous one has been written.
///
/// A slow or stuck terminal thus costs frames and never blocks the session; the next frame
/// contains all changes in between.
#[derive(Debug)]
pub(super) struct Writer {
    frames: Sender<Vec<u8>>,
    free: Arc<AtomicBool>,
}

impl Writer {
    /// Starts the writer; the receiver is notified when the writer is free again, or gets an
    /// error when the terminal is gone.
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
                    // An unread notification is enough for the session to check.
                    let _told = sender.try_send(written);
                }
            })?;
        Ok((Self { frames, free }, done))
    }

    pub(super) fn is_free(&self) -> bool {
        self.free.load(Ordering::SeqCst)
    }

    /// Sends a frame; call only when the writer is free.
    pub(super) fn send(&self, frame: Vec<u8>) {
        self.free.store(false, Ordering::SeqCst);
        if self.frames.try_send(frame).is_err() {
            self.free.store(true, Ordering::SeqCst);
        }
    }
}
