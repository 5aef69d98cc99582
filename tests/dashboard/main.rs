//! The dashboard: the same events and keys give the same frame, every view draws at every
//! size, and nothing that is told or pressed makes it panic.
//!
//! Why it matters: it is the program's face, over lines and terminals that nobody chose; a
//! panic would take a run of hours with it, and a frame that cannot be made again cannot
//! be reported or tested. Frames are made by the functions that a terminal's frames are
//! made by, from recorded runs and simulated keys.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;

mod anything;
mod apart;
mod behaviour;
mod frames;
mod mouse;
mod product;
mod recorded;
mod room;
mod runs;
mod textbook;
