//! What a session waits for, whatever it shows.

use std::io;
use std::time::Instant;

use crossbeam_channel::{Receiver, select};
use crossterm::event::Event as Typed;
use signal_hook::consts::SIGHUP;

use super::exit::Exit;
use crate::dashboard::terminal::{Job, Terminal};

/// What a session was woken by; `N` is what else it hears.
pub(super) enum Woken<N> {
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
) -> Woken<N> {
    select! {
        // No more keys come from a terminal that is gone.
        recv(terminal.keys) -> typed => typed.map_or(Woken::End(Exit::HungUp), Woken::Typed),
        recv(terminal.jobs) -> job => job.map_or(Woken::Time, Woken::Job),
        recv(terminal.drawn) -> drawn => drawn.map_or(Woken::Time, taken),
        recv(signals) -> signal => signal.map_or(Woken::Time, ending),
        recv(news) -> news => news.map_or(Woken::Silence, Woken::News),
        recv(time) -> _ => Woken::Time,
    }
}

fn taken<N>(frame: io::Result<()>) -> Woken<N> {
    match frame {
        Ok(()) => Woken::Drawn,
        Err(_) => Woken::End(Exit::HungUp),
    }
}

fn ending<N>(signal: i32) -> Woken<N> {
    Woken::End(match signal {
        SIGHUP => Exit::HungUp,
        signal => Exit::Signal(signal),
    })
}
