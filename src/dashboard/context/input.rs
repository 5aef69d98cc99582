//! What reaches the dashboard, and what it wants done.

use std::sync::Arc;
use std::time::Duration;

use super::mouse::Mouse;
use crate::dashboard::keys::Key;
use crate::evolution::EvolutionState;
use crate::lab::Event;

/// Something that happened.
#[derive(Clone, Debug)]
pub enum Input {
    /// A key was pressed.
    Key(Key),
    /// Something was done with the mouse.
    Mouse(Mouse),
    /// The terminal has so many columns and rows.
    Resize(u16, u16),
    /// The run has a fact to tell.
    Event(Box<Event>),
    /// The run will tell nothing more: it is over, was stopped, or died.
    Closed,
    /// So much time went by since the last tick.
    Tick(Duration),
    /// The population after a generation, or why it cannot be had.
    Population {
        /// The generation.
        generation: u64,
        /// Its individuals with all that they have learned.
        state: Result<Arc<EvolutionState>, String>,
    },
    /// Whoever drives the dashboard has something to say: an export was written, a file
    /// could not be read.
    Message(String),
}

/// Something to be done by whoever drives the dashboard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Make evolution wait.
    Pause,
    /// Let evolution go on.
    Resume,
    /// Let evolution go on to the end of a generation.
    Step,
    /// Save the latest state now.
    Checkpoint,
    /// Save and end the run, and stay.
    Stop,
    /// Save and end the run if there is one, and leave.
    Quit,
    /// Go back to where the run was opened from, if it was opened from somewhere.
    Back,
    /// Leave, and let the run go on without a terminal.
    Detach,
    /// Put the program into the background of its shell.
    Suspend,
    /// Forget what is on the terminal and draw everything again.
    Redraw,
    /// Fetch the population after a generation; the answer is [`Input::Population`].
    Load {
        /// The generation.
        generation: u64,
    },
    /// Write a file for the person.
    Export(Export),
}

/// A file for the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// Its name without a folder.
    pub name: String,
    /// What is in it.
    pub contents: String,
}
