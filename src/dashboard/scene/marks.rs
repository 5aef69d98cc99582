//! What is drawn of a world besides its scenery, and its signs.

use ratatui::style::{Modifier, Style};

use crate::dashboard::look::{Look, Paint};
use crate::lab::inspection::PolicyMap;
use crate::worlds::scene::{Mark, Role, Scenery, Snapshot};

/// What is drawn besides the scenery.
#[derive(Default)]
pub(in crate::dashboard) struct Scene<'s> {
    /// The agent and its surroundings.
    pub(in crate::dashboard) snapshot: Option<&'s Snapshot>,
    /// Movable marks, drawn while there is no snapshot.
    pub(in crate::dashboard) marks: &'s [Mark],
    /// Positions of the agent so far.
    pub(in crate::dashboard) trail: Vec<[f64; 2]>,
    /// The policy in each cell, in a world of cells.
    pub(in crate::dashboard) cells: Option<&'s PolicyMap>,
}

impl Scene<'_> {
    /// Returns all marks except the agent.
    pub(in crate::dashboard) fn marks<'a>(
        &'a self,
        scenery: &'a Scenery,
    ) -> impl Iterator<Item = &'a Mark> {
        let moving = self.snapshot.map_or(self.marks, |snapshot| &snapshot.marks);
        scenery.places.iter().chain(moving)
    }
}

/// Returns sign and style of a mark.
pub(in crate::dashboard) fn sign<'m>(look: &Look, mark: &'m Mark) -> (&'m str, Style) {
    let signs = look.signs;
    let (sign, paint) = match mark.role {
        Role::Goal => (signs.goal, Paint::Goal),
        Role::Object => (signs.object, Paint::Object),
        Role::Hazard => (signs.hazard, Paint::Hazard),
        Role::Landmark => (mark.label.as_str(), Paint::Landmark),
    };
    (sign, look.style(paint))
}

/// Returns sign and style of the agent; one that carries something has the object's style.
pub(in crate::dashboard) fn agent(look: &Look, snapshot: &Snapshot) -> (&'static str, Style) {
    let sign = match snapshot.heading {
        Some(heading) => look.signs.heading(heading),
        None => look.signs.agent,
    };
    let style = match snapshot.carries {
        Some(_) => look.style(Paint::Object).add_modifier(Modifier::REVERSED),
        None => look.style(Paint::Agent),
    };
    (sign, style)
}
