//! One run: evaluation, evolution thread, events, run folder, checkpoint, replay.
mod evaluate;
pub use evaluate::{Evaluation, Protocol, Repeat, evaluate};
