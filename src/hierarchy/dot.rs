//! Hierarchies as Graphviz DOT.

use std::fmt::Write;

use super::tree::Tree;
use crate::worlds::Catalogue;

/// The hierarchy as a Graphviz digraph: composite subtasks as triangles with their
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
