//! Everything that a view may read: the run, and what the user has chosen to see of it.

mod config;
mod history;
mod input;
mod mouse;
mod pace;
mod rollout_player;
mod view_context;

pub use config::{Config, ConfigError};
pub use history::{Progress, RunHistory};
pub use input::{Effect, Export, Input};
pub use mouse::{Gesture, Mouse};
pub use rollout_player::{RolloutPlayer, SPEEDS, Subject};
pub use view_context::{Chosen, Mode, ShownGeneration, ViewContext};

pub(in crate::dashboard) use mouse::{Clicked, line_at};
pub(super) use view_context::Activity;
