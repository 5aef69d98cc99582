//! The dashboard of one run: its state, its response to input, and its frames.

mod clicks;
mod export;
mod offscreen;
mod state;
mod steering;

pub use export::{FrameFormat, render};
pub use offscreen::OffscreenDashboard;
pub use state::App;
