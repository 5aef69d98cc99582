//! What is drawn of a world besides its scenery, and the signs for it.

use ratatui::style::{Modifier, Style};

use crate::dashboard::look::{Look, Paint};
use crate::lab::inspection::PolicyMap;
use crate::worlds::scene::{Mark, Role, Scenery, Snapshot};

/// What is drawn besides the scenery.
#[derive(Default)]
pub(in crate::dashboard) struct Scene<'s> {
    /// The agent and its surroundings.
    pub(in crate::dashboard) snapshot: Option<&'s Snapshot>,
    /// What can move or go, where it is while there is no agent to look at.
    pub(in crate::dashboard) marks: &'s [Mark],
    /// Where the agent has been.
    pub(in crate::dashboard) trail: Vec<[f64; 2]>,
    /// What the agent would do in each cell of a world of cells.
    pub(in crate::dashboard) cells: Option<&'s PolicyMap>,
}

impl Scene<'_> {
    /// What stands somewhere, the agent apart.
    pub(in crate::dashboard) fn marks<'a>(
        &'a self,
        scenery: &'a Scenery,
    ) -> impl Iterator<Item = &'a Mark> {
        let moving = self.snapshot.map_or(self.marks, |snapshot| &snapshot.marks);
        scenery.places.iter().chain(moving)
    }
}

/// What stands for a mark.
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

/// What stands for the agent: a robot that carries something looks like what it carries.
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
