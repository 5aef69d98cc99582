//! The typing rules of hierarchies (Thesis 3.2).

use thiserror::Error;

use super::text::{MAX_TEXT_BYTES, text_bytes};
use super::tree::Tree;
use crate::worlds::{Catalogue, StateTypes, SubtaskId};

/// The typing rule that a hierarchy breaks.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TypingError {
    /// The tree does not begin with the root subtask.
    #[error("the root is {found}; allowed: {root}")]
    NotRoot {
        /// The subtask found.
        found: String,
        /// The subtask allowed.
        root: String,
    },
    /// The root subtask occurs below itself.
    #[error("{root} stands below itself; allowed: only at the top")]
    RootBelow {
        /// The root subtask.
        root: String,
    },
    /// A composite subtask has no children.
    #[error("{composite} has no children; allowed: at least one")]
    Childless {
        /// The composite subtask.
        composite: String,
    },
    /// A primitive subtask has children.
    #[error("{primitive} has children; allowed: none, it is a primitive subtask")]
    PrimitiveParent {
        /// The primitive subtask.
        primitive: String,
    },
    /// A child's active state types do not fit those of its parent.
    #[error(
        "{child} (active in state types {child_active}) under {parent} (active in \
         {parent_active}); allowed: {}",
        if *.composite { "a composite child active only where its parent is" }
        else { "a child active somewhere where its parent is" }
    )]
    NotAllowed {
        /// The child.
        child: String,
        /// Its active state types.
        child_active: StateTypes,
        /// Whether the child is composite.
        composite: bool,
        /// The parent.
        parent: String,
        /// Its active state types.
        parent_active: StateTypes,
    },
    /// A composite subtask occurs twice.
    #[error("{composite} occurs more than once; allowed: every composite subtask at most once")]
    Repeated {
        /// The composite subtask.
        composite: String,
    },
    /// The tree has too many levels.
    #[error("the depth is {depth}; allowed: 2 to {maximum}, the root counted")]
    TooDeep {
        /// Depth found.
        depth: usize,
        /// Largest depth allowed.
        maximum: usize,
    },
    /// The text form would be too long to be read again.
    #[error("the text has {found} bytes; allowed: at most {MAX_TEXT_BYTES}")]
    TooLong {
        /// Length of the text form in bytes.
        found: usize,
    },
    /// The root cannot act in some state type.
    #[error(
        "nothing can act in state types {missing}; allowed: a root that can act in all of them"
    )]
    CannotAct {
        /// The state types without any action.
        missing: StateTypes,
    },
}

/// Checks a hierarchy against every typing rule.
///
/// # Errors
/// With the first broken rule. Rules on single nodes come first, in preorder.
pub fn check(tree: &Tree, catalogue: &Catalogue, maximum_depth: usize) -> Result<(), TypingError> {
    let root = catalogue.subtask(SubtaskId::ROOT);
    let top = catalogue.subtask(tree.subtask(0));
    if tree.subtask(0) != SubtaskId::ROOT {
        return Err(TypingError::NotRoot {
            found: top.name.clone(),
            root: root.name.clone(),
        });
    }
    for node in 0..tree.nodes().len() {
        check_node(tree, catalogue, node)?;
    }
    check_repeats(tree, catalogue)?;
    let depth = tree.depth();
    if depth > maximum_depth {
        return Err(TypingError::TooDeep {
            depth,
            maximum: maximum_depth,
        });
    }
    let found = text_bytes(tree, catalogue);
    if found > MAX_TEXT_BYTES {
        return Err(TypingError::TooLong { found });
    }
    let able = able(tree, catalogue)[0];
    let missing: Vec<_> = catalogue.types().filter(|&t| !able.contains(t)).collect();
    if !missing.is_empty() {
        return Err(TypingError::CannotAct {
            missing: StateTypes::of(&missing),
        });
    }
    Ok(())
}

fn check_node(tree: &Tree, catalogue: &Catalogue, node: usize) -> Result<(), TypingError> {
    let subtask = catalogue.subtask(tree.subtask(node));
    let childless = tree.children(node).next().is_none();
    if subtask.is_composite() && childless {
        return Err(TypingError::Childless {
            composite: subtask.name.clone(),
        });
    }
    if !subtask.is_composite() && !childless {
        return Err(TypingError::PrimitiveParent {
            primitive: subtask.name.clone(),
        });
    }
    let Some(parent) = tree.nodes()[node].parent else {
        return Ok(());
    };
    if tree.subtask(node) == SubtaskId::ROOT {
        return Err(TypingError::RootBelow {
            root: subtask.name.clone(),
        });
    }
    let parent = catalogue.subtask(tree.subtask(parent));
    let allowed = if subtask.is_composite() {
        subtask.active.is_subset_of(parent.active)
    } else {
        subtask.active.meets(parent.active)
    };
    if allowed {
        return Ok(());
    }
    Err(TypingError::NotAllowed {
        child: subtask.name.clone(),
        child_active: subtask.active,
        composite: subtask.is_composite(),
        parent: parent.name.clone(),
        parent_active: parent.active,
    })
}

fn check_repeats(tree: &Tree, catalogue: &Catalogue) -> Result<(), TypingError> {
    let mut seen = vec![false; catalogue.subtasks.len()];
    for node in tree.nodes() {
        let subtask = catalogue.subtask(node.subtask);
        if subtask.is_composite() && std::mem::replace(&mut seen[node.subtask.index()], true) {
            return Err(TypingError::Repeated {
                composite: subtask.name.clone(),
            });
        }
    }
    Ok(())
}

/// Returns the state types in which each node can act.
///
/// A primitive subtask can act where it is active. A composite subtask can act where it is
/// active, its goal is not reached, and at least one child can act.
#[must_use]
pub fn able(tree: &Tree, catalogue: &Catalogue) -> Vec<StateTypes> {
    let mut able = vec![StateTypes::default(); tree.nodes().len()];
    for node in (0..tree.nodes().len()).rev() {
        let subtask = catalogue.subtask(tree.subtask(node));
        able[node] = if subtask.is_composite() {
            let children = tree.children(node).map(|child| able[child]);
            let any = children.fold(StateTypes::default(), StateTypes::union);
            subtask.active.without(subtask.goal()).intersection(any)
        } else {
            subtask.active
        };
    }
    able
}
