//! The dashboard: what a person sees of a run, and can do with it.
//!
//! [`App`] is a state and two functions. [`App::update`] takes an [`Input`] - a key, an
//! event of the run, time that went by, something that was loaded - and returns
//! [`Effect`]s for whoever drives it to carry out. [`App::draw`] is a pure function of the state. Neither
//! reads a clock, a file or the environment, so that a live run, a replay, a run watched
//! from afar and a snapshot test are the same code, and a frame can be made again.
//!
//! # The corners of this room
//!
//! | module | what is in it |
//! | --- | --- |
//! | `app` | the state and its two functions |
//! | `model` | the fold over the events of the run |
//! | `context` | what the person has chosen to look at; every view reads it |
//! | `player` | the rollout of the individual that is looked at |
//! | `keys` | actions, keys, and which key does what: one list for input, hints and help |
//! | `mouse`, `clicks` | what the mouse tells; what clicks and the wheel do |
//! | `hints` | which actions the last line names |
//! | `look` | themes, signs, lines of text, the canvas that arenas are drawn on |
//! | `scene` | worlds, drawn: in their true proportions, or cell by cell |
//! | `view_id` | the views by name |
//! | `views` | one file a view; a view in a corner of the overview is a panel |
//! | `runs` | the table of a study's runs, each of which can be opened |
//! | `export` | a frame as text, ANSI or SVG |
//! | [`terminal`] | the terminal's life: taken, lent to the shell, given back |
//! | [`session`] | who drives an [`App`] on a terminal: events, keys, signals, frames |
//!
//! A view is added by a variant of [`ViewId`], an entry in its table, and a file
//! that implements `View`.

mod app;
mod chrome;
mod context;
pub mod keys;
pub mod look;
mod panel;
mod runs;
mod scene;
pub mod session;
pub mod terminal;
mod view_id;
mod views;

pub use app::{App, FrameFormat, OffscreenDashboard, render};
pub use context::{
    Chosen, Config, ConfigError, Effect, Export, Gesture, Input, Mode, Mouse, Progress,
    RolloutPlayer, RunHistory, SPEEDS, ShownGeneration, Subject, ViewContext,
};
pub use runs::{RunRow, RunsEffect, RunsNews, RunsTable, Standing, Work};
pub use view_id::ViewId;
