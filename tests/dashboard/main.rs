//! The dashboard: the same inputs give the same frame, every view draws at every size, and no
//! input makes it panic.
//!
//! Why it matters: users meet the program here, over any line and on any terminal. A panic
//! would end a run of hours, and a frame that cannot be reproduced can be neither reported nor
//! tested. The frames are made from recorded runs and simulated keys by the same functions as
//! on a terminal.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;

mod anything;
mod apart;
mod behaviour;
mod frames;
mod mouse;
mod options;
mod product;
mod recorded;
mod room;
mod runs;
mod textbook;
