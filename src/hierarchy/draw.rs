//! Hierarchies drawn for the terminal, and for Graphviz.

use std::fmt::Write;

use super::tree::Tree;
use crate::worlds::Catalogue;

/// The characters that branches are drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glyphs {
    /// Box-drawing characters.
    Unicode,
    /// Plain ASCII.
    Ascii,
}

impl Glyphs {
    /// Returns Unicode where the locale is UTF-8, else ASCII.
    ///
    /// The first of `LC_ALL`, `LC_CTYPE` and `LANG` that is set decides.
    #[must_use]
    pub fn of_locale() -> Self {
        let set = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(set);
        let locale = locale.unwrap_or_default().to_ascii_lowercase();
        if locale.contains("utf-8") || locale.contains("utf8") {
            Self::Unicode
        } else {
            Self::Ascii
        }
    }

    /// The branch to a child, the branch to the last child, a line that passes by.
    pub(super) fn signs(self) -> [&'static str; 3] {
        match self {
            Self::Unicode => ["├─ ", "└─ ", "│  "],
            Self::Ascii => ["|- ", "`- ", "|  "],
        }
    }
}

/// Draws a hierarchy, one line for each node in preorder.
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

/// Returns a hierarchy as a Graphviz digraph: composite subtasks as triangles with their
/// active state types, as in a MAXQ graph, primitive subtasks as boxes.
#[must_use]
pub fn to_dot(tree: &Tree, catalogue: &Catalogue) -> String {
    let mut dot = String::from("digraph hierarchy {\n  node [fontname=\"Helvetica\"];\n");
    for (index, node) in tree.nodes().iter().enumerate() {
        let subtask = catalogue.subtask(node.subtask);
        let shape = if subtask.is_composite() {
            "triangle"
        } else {
            "box"
        };
        let (name, active) = (&subtask.name, subtask.active);
        // Writing to a string cannot fail.
        let _ = writeln!(
            dot,
            "  n{index} [shape={shape}, label=\"{name}\\n{active}\"];"
        );
        if let Some(parent) = node.parent {
            let _ = writeln!(dot, "  n{parent} -> n{index};");
        }
    }
    dot.push_str("}\n");
    dot
}
