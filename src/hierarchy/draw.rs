//! Hierarchies drawn for the terminal.

use super::tree::Tree;
use crate::worlds::Catalogue;

/// The signs that branches are drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glyphs {
    /// Box-drawing characters.
    Unicode,
    /// Plain ASCII.
    Ascii,
}

impl Glyphs {
    /// Unicode where the environment's locale is UTF-8, by the usual precedence of its
    /// variables; else ASCII.
    #[must_use]
    pub fn of_locale() -> Self {
        let set = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(set);
        let locale = locale.unwrap_or_default().to_ascii_lowercase();
        match locale.contains("utf-8") || locale.contains("utf8") {
            true => Self::Unicode,
            false => Self::Ascii,
        }
    }

    /// Branch to a child, branch to the last child, passing line.
    fn signs(self) -> [&'static str; 3] {
        match self {
            Self::Unicode => ["├─ ", "└─ ", "│  "],
            Self::Ascii => ["|- ", "`- ", "|  "],
        }
    }
}

/// The hierarchy as one line a node, in preorder.
#[must_use]
pub fn draw(tree: &Tree, catalogue: &Catalogue, glyphs: Glyphs) -> Vec<String> {
    let name = |node: usize| tree.subtask(node).name(catalogue);
    let [branch, last, pass] = glyphs.signs();
    let is_last = |node: usize| match tree.nodes()[node].parent {
        Some(parent) => tree.children(parent).last() == Some(node),
        None => true,
    };
    (0..tree.nodes().len())
        .map(|node| {
            if node == 0 {
                return name(node).to_owned();
            }
            let mut above: Vec<_> = tree
                .ancestors(node)
                .filter(|&ancestor| ancestor != 0)
                .collect();
            above.reverse();
            let indent = above.iter().map(|&a| if is_last(a) { "   " } else { pass });
            let sign = if is_last(node) { last } else { branch };
            format!("{}{sign}{}", indent.collect::<String>(), name(node))
        })
        .collect()
}
