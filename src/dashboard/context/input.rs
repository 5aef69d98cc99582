//! The inputs of the dashboard, and the effects that it asks its driver to run.

use std::sync::Arc;
use std::time::Duration;

use super::mouse::Mouse;
use crate::dashboard::keys::Key;
use crate::evolution::EvolutionState;
use crate::lab::{Event, LastSign};

/// An input of the dashboard.
#[derive(Clone, Debug)]
pub enum Input {
    /// A key was pressed.
    Key(Key),
    /// The mouse was used.
    Mouse(Mouse),
    /// The terminal has this many columns and rows.
    Resize(u16, u16),
    /// The run has emitted an event.
    Event(Box<Event>),
    /// The run will emit no more events: it has finished, was stopped, or crashed.
    Closed,
    /// The process that computed the run is gone before the end, and this was its last sign.
    LastSign(LastSign),
    /// This much time has passed since the last tick.
    Tick(Duration),
    /// The size of the run folder.
    FolderBytes(u64),
    /// The population after a generation, or why it could not be loaded.
    Population {
        /// Number of the generation.
        generation: u64,
        /// The individuals with everything that they have learned, or the error message. If the
        /// generation was not kept, those of the nearest one that was.
        state: Result<Arc<EvolutionState>, String>,
    },
    /// The driver has a message for the user: an export was written, a file could not be read.
    Message(String),
}

/// An effect that the driver of the dashboard must run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Pause evolution.
    Pause,
    /// Resume evolution.
    Resume,
    /// Evolve to the end of a generation, then pause.
    Step,
    /// Save a checkpoint now.
    Checkpoint,
    /// Save and stop the run; the dashboard stays open.
    Stop,
    /// Save and stop the run if it is live, and quit.
    Quit,
    /// Return to the list of runs, if the dashboard was opened from one.
    Back,
    /// Quit, and let the run continue without a terminal.
    Detach,
    /// Suspend the program.
    Suspend,
    /// Redraw the whole screen, whatever the terminal shows.
    Redraw,
    /// Load the population after a generation; the reply is [`Input::Population`].
    Load {
        /// Number of the generation.
        generation: u64,
    },
    /// Write a file.
    Export(Export),
    /// Remove the file that was written last.
    RemoveExport,
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// The name without a folder.
    pub name: String,
    /// The contents.
    pub contents: String,
}
