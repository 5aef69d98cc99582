//! What a session waits for, whatever it shows.

use std::io;
use std::time::Instant;

use crossbeam_channel::{Receiver, select};
use crossterm::event::Event as Typed;
use signal_hook::consts::SIGHUP;

use super::exit::Exit;
use crate::dashboard::terminal::{Job, Terminal};

/// What a session was woken by; `N` is what else it hears.
pub(super) enum WakeUp<N> {
    /// A key or the mouse.
    Typed(Typed),
    /// The shell or the window manager asks for something.
    Job(Job),
    /// The terminal has taken a frame.
    Drawn,
    /// Something has come in.
    News(N),
    /// Nothing more comes in.
    Silence,
    /// Time has gone by.
    Time,
    /// Something that ends the session.
    End(Exit),
}

/// Waits for the terminal, for signals, for `news`, and for a time.
pub(super) fn wait<N>(
    terminal: &Terminal,
    signals: &Receiver<i32>,
    news: &Receiver<N>,
    time: &Receiver<Instant>,
) -> WakeUp<N> {
    select! {
        // No more keys come from a terminal that is gone.
        recv(terminal.keys) -> typed => typed.map_or(WakeUp::End(Exit::HungUp), WakeUp::Typed),
        recv(terminal.jobs) -> job => job.map_or(WakeUp::Time, WakeUp::Job),
        recv(terminal.drawn) -> drawn => drawn.map_or(WakeUp::Time, taken),
        recv(signals) -> signal => signal.map_or(WakeUp::Time, ending),
        recv(news) -> news => news.map_or(WakeUp::Silence, WakeUp::News),
        recv(time) -> _ => WakeUp::Time,
    }
}

fn taken<N>(frame: io::Result<()>) -> WakeUp<N> {
    match frame {
        Ok(()) => WakeUp::Drawn,
        Err(_) => WakeUp::End(Exit::HungUp),
    }
}

fn ending<N>(signal: i32) -> WakeUp<N> {
    WakeUp::End(match signal {
        SIGHUP => Exit::HungUp,
        signal => Exit::Signal(signal),
    })
}
