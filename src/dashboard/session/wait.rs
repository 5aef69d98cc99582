//! What every session waits for, and why it ends.

use std::io;
use std::time::Instant;

use crossbeam_channel::{Receiver, select};
use ratatui::crossterm::event::Event as Typed;
use signal_hook::consts::SIGHUP;

use crate::dashboard::terminal::{Job, Terminal};

/// Why a session has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The user has quit.
    Left,
    /// The user has left; the run continues.
    Detached,
    /// The terminal is gone: the line dropped.
    HungUp,
    /// This signal asked the program to terminate.
    Signal(i32),
    /// A thread has panicked, and the terminal has been restored.
    Panicked,
    /// The run has failed.
    Failed,
}

/// What a session was woken by; `N` is its kind of news.
pub(super) enum WakeUp<N> {
    /// A key or a mouse gesture.
    Typed(Typed),
    /// A job-control signal or a new window size.
    Job(Job),
    /// The terminal has taken a frame.
    Drawn,
    /// News has arrived.
    News(N),
    /// No more news will arrive.
    Silence,
    /// The time is up.
    Time,
    /// The session must end.
    End(Exit),
}

/// Waits for the terminal, signals, news or the time, whichever comes first.
pub(super) fn wait<N>(
    terminal: &Terminal,
    signals: &Receiver<i32>,
    news: &Receiver<N>,
    time: &Receiver<Instant>,
) -> WakeUp<N> {
    select! {
        // A closed channel means that the terminal is gone.
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
