//! The text form of hierarchies: `(Root (Capture Wander ApproachBattery) ...)`.

use thiserror::Error;

use super::tree::Tree;
use crate::words::quoted;
use crate::worlds::Catalogue;

/// The longest text that is read, in bytes.
pub const MAX_TEXT_BYTES: usize = 4096;

/// Why a text is not a hierarchy.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TextError {
    /// The text is too long.
    #[error("the hierarchy has {found} bytes; allowed: at most {MAX_TEXT_BYTES}")]
    TooLong {
        /// Length in bytes.
        found: usize,
    },
    /// A token stands where another is expected.
    #[error("at byte {at}: found {found}; allowed: {expected}")]
    Unexpected {
        /// Offset in bytes, from 0.
        at: usize,
        /// The token found.
        found: String,
        /// The tokens allowed there.
        expected: String,
    },
}

/// Reads the text form of a hierarchy. Typing rules are left to [`super::check`].
///
/// # Examples
/// ```
/// use maxq_lab::hierarchy::{parse, to_text};
/// use maxq_lab::lab::experiment;
/// use maxq_lab::scenario::Scenario;
///
/// let experiment = experiment(Scenario::load("smoke")?, 1)?;
/// let text = "(Root (Capture Wander ApproachBattery) Wander ApproachNest)";
/// let tree = parse(text, experiment.catalogue())?;
/// assert_eq!(tree.depth(), 3);
/// assert_eq!(to_text(&tree, experiment.catalogue()), text);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the text is too long, is not one tree in parentheses, or names a subtask
/// that the catalogue does not have.
pub fn parse(text: &str, catalogue: &Catalogue) -> Result<Tree, TextError> {
    if text.len() > MAX_TEXT_BYTES {
        return Err(TextError::TooLong { found: text.len() });
    }
    let mut preorder = Vec::new();
    let mut depth = 0;
    let mut opened = false;
    for (at, token) in tokens(text) {
        let unexpected = |expected: String| TextError::Unexpected {
            at,
            found: quoted(token),
            expected,
        };
        let complete = depth == 0 && !preorder.is_empty();
        match token {
            _ if complete => return Err(unexpected(String::from("the end of the text"))),
            "(" if opened => return Err(unexpected(names(catalogue))),
            "(" => opened = true,
            ")" if opened || depth == 0 => return Err(unexpected(expected_at(depth, catalogue))),
            ")" => depth -= 1,
            _ if !opened && depth == 0 => return Err(unexpected(String::from("'('"))),
            name => {
                let subtask = catalogue
                    .find(name)
                    .ok_or_else(|| unexpected(names(catalogue)))?;
                preorder.push((subtask, depth + 1));
                depth += usize::from(std::mem::take(&mut opened));
            }
        }
    }
    let whole = Tree::from_preorder(&preorder).filter(|_| depth == 0 && !opened);
    whole.ok_or_else(|| TextError::Unexpected {
        at: text.len(),
        found: String::from("the end of the text"),
        expected: expected_at(depth, catalogue),
    })
}

fn expected_at(depth: usize, catalogue: &Catalogue) -> String {
    match depth {
        0 => format!("'(' and {}", names(catalogue)),
        _ => format!("')', '(', or {}", names(catalogue)),
    }
}

fn names(catalogue: &Catalogue) -> String {
    let names: Vec<_> = catalogue
        .subtasks
        .iter()
        .map(|subtask| subtask.name.as_str())
        .collect();
    format!("a subtask ({})", names.join(", "))
}

/// Parentheses and the words between them, with their offsets.
fn tokens(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut rest = 0;
    std::iter::from_fn(move || {
        let start = rest + text[rest..].find(|c: char| !c.is_ascii_whitespace())?;
        let token = &text[start..];
        let end = match token.strip_prefix(['(', ')']) {
            Some(_) => 1,
            None => token
                .find(|c: char| c.is_ascii_whitespace() || c == '(' || c == ')')
                .unwrap_or(token.len()),
        };
        rest = start + end;
        Some((start, &text[start..rest]))
    })
}

/// Returns the text form of a hierarchy, children in their order.
#[must_use]
pub fn to_text(tree: &Tree, catalogue: &Catalogue) -> String {
    write(
        tree,
        0,
        &|node| tree.subtask(node).name(catalogue),
        &|children| children,
    )
}

/// Returns the length of the text form in bytes.
pub(super) fn text_bytes(tree: &Tree, catalogue: &Catalogue) -> usize {
    let nodes = (0..tree.nodes().len()).map(|node| {
        let has_children = tree.children(node).next().is_some();
        // A space or nothing before it, parentheses around it and its children.
        let around = usize::from(node > 0) + 2 * usize::from(has_children);
        tree.subtask(node).name(catalogue).len() + around
    });
    nodes.sum()
}

/// Returns the canonical form: the text form with sorted children.
///
/// It is equal for two trees exactly if they differ at most in the order of children.
#[must_use]
pub fn canonical(tree: &Tree, catalogue: &Catalogue) -> String {
    let sorted = |mut children: Vec<String>| {
        children.sort_unstable();
        children
    };
    write(tree, 0, &|node| tree.subtask(node).name(catalogue), &sorted)
}

fn write<'c>(
    tree: &Tree,
    node: usize,
    name: &impl Fn(usize) -> &'c str,
    order: &impl Fn(Vec<String>) -> Vec<String>,
) -> String {
    let children = tree
        .children(node)
        .map(|child| write(tree, child, name, order));
    let children = order(children.collect());
    if children.is_empty() {
        name(node).to_owned()
    } else {
        format!("({} {})", name(node), children.join(" "))
    }
}
