//! The table of a study's runs on a terminal.

use std::io;

use crossbeam_channel::{Receiver, after, never};
use ratatui::crossterm::event::Event as Typed;

use super::wait::{WakeUp, wait};
use super::{BACKGROUND, Exit, input};
use crate::dashboard::context::Input;
use crate::dashboard::runs::{RunsEffect, RunsNews, RunsTable};
use crate::dashboard::terminal::{Job, Terminal};

/// Why a session over a table of runs has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunsExit {
    /// The user opens the run of this row: an index into the rows of [`RunsNews`].
    Open(usize),
    /// The program should end.
    End(Exit),
}

/// A table of runs on a terminal.
pub struct RunsSession<'s> {
    table: &'s mut RunsTable,
    terminal: &'s mut Terminal,
    /// News of the runs.
    news: &'s Receiver<RunsNews>,
    /// Whether a change has not been drawn yet.
    due: bool,
}

impl<'s> RunsSession<'s> {
    /// Creates a session over a table that is updated from `news`.
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

    /// Shows the table until a run is opened or the session ends.
    ///
    /// The screen is kept; it is restored when the terminal is dropped.
    ///
    /// # Errors
    /// When a frame cannot be drawn.
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

    fn wait(&self, signals: &Receiver<i32>) -> WakeUp<RunsNews> {
        let again = if self.terminal.is_shown() {
            never()
        } else {
            after(BACKGROUND)
        };
        wait(self.terminal, signals, self.news, &again)
    }

    fn act(&mut self, woken: WakeUp<RunsNews>) -> Option<RunsExit> {
        match woken {
            WakeUp::Drawn => {}
            WakeUp::End(exit) => return Some(RunsExit::End(exit)),
            WakeUp::Silence => return Some(RunsExit::End(Exit::Failed)),
            WakeUp::Typed(typed) => return self.typed(&typed),
            WakeUp::News(news) => self.due |= self.table.update(news),
            WakeUp::Job(Job::Resize) => self.resize(),
            WakeUp::Job(Job::Suspend) => self.terminal.suspend(),
            WakeUp::Time if self.terminal.is_shown() => {}
            WakeUp::Time | WakeUp::Job(Job::Continue) => {
                if self.appear().is_err() {
                    return Some(RunsExit::End(Exit::HungUp));
                }
            }
        }
        None
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
                let why = "cannot suspend: no shell is there to resume the program";
                self.table.show_message(why);
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
