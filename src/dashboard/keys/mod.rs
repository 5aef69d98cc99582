//! Keys: their names, what they do, and the one list that says so.

mod action;
mod key;
mod map;

pub use action::{Action, Scope};
pub use key::{Key, KeyError};
pub use map::{Collision, KeyMap};
