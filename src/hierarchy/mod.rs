//! MAXQ hierarchies: trees of subtasks, their typing rules, their text forms.
//!
//! A hierarchy is the genome of an individual. Here is its structure only; what it
//! has learned is in [`crate::learning`].

mod difference;
mod dot;
mod draw;
mod generate;
mod structure;
mod summary;
mod text;
mod tree;
mod typing;

pub use difference::structural_difference;
pub use dot::to_dot;
pub use draw::{Glyphs, draw};
pub(crate) use generate::random_subtree;
pub use generate::{complete, flat, random_tree};
pub use structure::without_repeats;
pub use summary::Summary;
pub use text::{MAX_TEXT_BYTES, TextError, canonical, parse, to_text};
pub use tree::{Node, Tree};
pub use typing::{TypingError, able, check};
