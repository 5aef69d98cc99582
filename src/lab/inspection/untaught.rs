//! Primitive subtasks that have nothing learned of their own, in words.

use crate::worlds::{Catalogue, Imitation, Kind, SubtaskId};

/// Tells why a primitive subtask has no learned values of its own; `None` if it has some, and for
/// a composite subtask. `learns` says whether it is trained or learns during evolution.
pub(in crate::lab) fn nothing_learned(
    catalogue: &Catalogue,
    subtask: SubtaskId,
    learns: bool,
) -> Option<String> {
    let Kind::Primitive { actions, imitates } = &catalogue.subtask(subtask).kind else {
        return None;
    };
    match (imitates, actions.as_slice()) {
        (Some(imitation), _) => Some(imitated(catalogue, imitation)),
        (None, _) if learns => None,
        (None, [only]) => Some(format!(
            "always executes {only}; it has nothing to choose and learns nothing"
        )),
        (None, _) => Some(String::from("is not trained and does not learn")),
    }
}

/// Tells whom a subtask imitates.
fn imitated(catalogue: &Catalogue, imitation: &Imitation) -> String {
    let recalled = imitation.with_memory.iter().map(|(state_type, subtask)| {
        let name = subtask.name(catalogue);
        format!("as {name} in state type {}", state_type.number())
    });
    let recalled = recalled.collect::<Vec<_>>().join(" and ");
    let otherwise = imitation.otherwise.name(catalogue);
    format!(
        "has no values of its own; where the place is remembered, it acts {recalled}, else as \
         {otherwise}"
    )
}
