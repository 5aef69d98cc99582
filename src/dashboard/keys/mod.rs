//! Keys and actions: their names, and the key map between them.

mod action;
mod key;
mod map;

pub use action::{Action, Scope};
pub use key::{Key, KeyError};
pub use map::{Collision, KeyMap};
