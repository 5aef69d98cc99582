//! What has learned nothing yet.

use crate::hierarchy::Tree;
use crate::learning::{CompositeValues, Hierarchy};
use crate::scenario::LearningSettings;
use crate::worlds::{Catalogue, SubtaskId};

/// A hierarchy of this shape.
pub(super) fn newborn(tree: Tree, learning: &LearningSettings, catalogue: &Catalogue) -> Hierarchy {
    let temperature = learning.initial_temperature as f32;
    let initial = learning.initial_parameter as f32;
    Hierarchy::new(tree, catalogue, temperature, initial)
}

/// A composite subtask with these children.
pub(super) fn anew(
    learning: &LearningSettings,
    subtask: SubtaskId,
    children: &[SubtaskId],
    catalogue: &Catalogue,
) -> CompositeValues {
    let temperature = learning.initial_temperature as f32;
    let initial = learning.initial_parameter as f32;
    CompositeValues::new(subtask, children, catalogue, temperature, initial)
}
