#![doc = include_str!("README.md")]

mod compare;
mod draw;
mod fold;
mod generate;
mod text;
mod tree;
mod typing;

pub use compare::{Summary, structural_difference, without_repeats};
pub use draw::{Glyphs, draw, to_dot};
pub use fold::{TreeLine, TreeText, folded_lines, lines};
pub(crate) use generate::random_subtree;
pub use generate::{complete, flat, random_tree};
pub use text::{MAX_TEXT_BYTES, TextError, canonical, parse, to_text};
pub use tree::{Node, Tree};
pub use typing::{TypingError, able, check};
