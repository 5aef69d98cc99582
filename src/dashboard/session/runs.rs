//! A table of runs on a terminal, until one is opened or the person leaves.

use std::io;

use crossbeam_channel::{Receiver, after, never, select};
use crossterm::event::Event as Typed;
use signal_hook::consts::SIGHUP;

use super::{BACKGROUND, Exit, input};
use crate::dashboard::Input;
use crate::dashboard::runs::{RunsEffect, RunsNews, RunsTable};
use crate::dashboard::terminal::{Job, Terminal};

/// Why a session over a table of runs is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunsExit {
    /// The run of this row is to be opened, by its place in the rows that were told.
    Open(usize),
    /// The program is to end.
    End(Exit),
}

/// A table of runs on a terminal.
pub struct RunsSession<'s> {
    table: &'s mut RunsTable,
    terminal: &'s mut Terminal,
    /// The runs, whenever somebody has looked at them.
    news: &'s Receiver<RunsNews>,
    /// Whether something has changed that was not drawn.
    due: bool,
}

/// What a session waits for.
enum Woken {
    Typed(Option<Typed>),
    Job(Job),
    Drawn(io::Result<()>),
    Signal(i32),
    News(Option<RunsNews>),
    Time,
}

impl<'s> RunsSession<'s> {
    /// A session over a table, with what is told of its runs from time to time.
    #[must_use]
    pub fn new(
        table: &'s mut RunsTable,
        terminal: &'s mut Terminal,
        news: &'s Receiver<RunsNews>,
    ) -> Self {
        Self {
            table,
            terminal,
            news,
            due: true,
        }
    }

    /// Shows the table until a run is opened or somebody or something ends it. The screen is
    /// kept: dropping the terminal gives it back.
    ///
    /// # Errors
    /// When a frame cannot be made.
    pub fn run(mut self, signals: &Receiver<i32>) -> io::Result<RunsExit> {
        if self.appear().is_err() {
            return Ok(RunsExit::End(Exit::HungUp));
        }
        loop {
            if self.due && self.terminal.is_ready() {
                self.due = false;
                let table = &*self.table;
                self.terminal.draw(|frame| table.draw(frame))?;
            }
            let woken = self.wait(signals);
            if let Some(exit) = self.act(woken) {
                return Ok(exit);
            }
            if self.terminal.is_closed() {
                return Ok(RunsExit::End(Exit::Panicked));
            }
        }
    }

    /// Takes the screen, unless the program is in the background.
    fn appear(&mut self) -> io::Result<()> {
        self.terminal.go_on()?;
        self.resize();
        Ok(())
    }

    fn resize(&mut self) {
        let size = self.terminal.resize();
        self.table.resize(size.width, size.height);
        self.due = true;
    }

    fn wait(&self, signals: &Receiver<i32>) -> Woken {
        let again = match self.terminal.is_shown() {
            true => never(),
            false => after(BACKGROUND),
        };
        select! {
            recv(self.terminal.keys) -> typed => Woken::Typed(typed.ok()),
            recv(self.terminal.jobs) -> job => job.map_or(Woken::Time, Woken::Job),
            recv(self.terminal.drawn) -> drawn => drawn.map_or(Woken::Time, Woken::Drawn),
            recv(signals) -> signal => signal.map_or(Woken::Time, Woken::Signal),
            recv(self.news) -> news => Woken::News(news.ok()),
            recv(again) -> _ => Woken::Time,
        }
    }

    fn act(&mut self, woken: Woken) -> Option<RunsExit> {
        let exit = match woken {
            Woken::Drawn(Err(_)) | Woken::Signal(SIGHUP) | Woken::Typed(None) => Exit::HungUp,
            Woken::Signal(signal) => Exit::Signal(signal),
            Woken::News(None) => Exit::Failed,
            Woken::Typed(Some(typed)) => return self.typed(&typed),
            Woken::News(Some(news)) => {
                self.due |= self.table.take_in(news);
                return None;
            }
            Woken::Job(Job::Resize) => {
                self.resize();
                return None;
            }
            Woken::Job(Job::Suspend) => {
                self.terminal.suspend();
                return None;
            }
            Woken::Drawn(Ok(())) => return None,
            Woken::Time if self.terminal.is_shown() => return None,
            Woken::Time | Woken::Job(Job::Continue) => match self.appear() {
                Ok(()) => return None,
                Err(_) => Exit::HungUp,
            },
        };
        Some(RunsExit::End(exit))
    }

    fn typed(&mut self, typed: &Typed) -> Option<RunsExit> {
        let input = input(typed)?;
        self.due = true;
        let effect = match input {
            Input::Key(key) => self.table.key(key),
            Input::Mouse(mouse) => self.table.mouse(mouse),
            _ => None,
        };
        match effect? {
            RunsEffect::Open(place) => return Some(RunsExit::Open(place)),
            RunsEffect::Leave => return Some(RunsExit::End(Exit::Left)),
            RunsEffect::Detach => return Some(RunsExit::End(Exit::Detached)),
            RunsEffect::Suspend if !self.terminal.ask_to_suspend() => {
                let why = "no shell waits that could continue the program";
                self.table.say(why);
            }
            RunsEffect::Suspend => {}
            RunsEffect::Redraw => {
                if self.appear().is_err() {
                    return Some(RunsExit::End(Exit::HungUp));
                }
            }
        }
        None
    }
}
