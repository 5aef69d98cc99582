#![doc = include_str!("README.md")]

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
pub use runs::{RowStatus, RunRow, RunsEffect, RunsNews, RunsTable, Work};
pub use view_id::ViewId;
