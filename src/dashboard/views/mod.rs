//! The views, one file or folder each.
//!
//! A view fills the screen between header and hint bar. Most views are also panels of the
//! overview, where they draw what fits.

mod arena;
mod compare;
mod fitness;
mod hierarchy;
mod inspector;
mod overview;
mod policy;
mod policy_map;
mod population;
mod shared;
mod status;
mod stepper;
mod view;

pub(super) use overview::panels;
pub(super) use view::View;

use std::str::FromStr;

use thiserror::Error;

use super::view_id::ViewId;

/// Returns all views in the order of [`ViewId::all`].
pub(super) fn all() -> Vec<(ViewId, Box<dyn View>)> {
    ViewId::all().map(|id| (id, view(id))).collect()
}

fn view(id: ViewId) -> Box<dyn View> {
    match id {
        ViewId::Overview => Box::new(overview::Overview),
        ViewId::Arena => Box::new(arena::Arena),
        ViewId::Hierarchy => Box::new(hierarchy::Hierarchy),
        ViewId::Fitness => Box::new(fitness::Fitness),
        ViewId::Policy => Box::new(policy::Policy),
        ViewId::Population => Box::new(population::Population::default()),
        ViewId::Status => Box::new(status::Status),
        ViewId::Inspector => Box::new(inspector::Inspector::default()),
        ViewId::PolicyMap => Box::new(policy_map::PolicyMapView::default()),
        ViewId::Stepper => Box::new(stepper::Stepper::default()),
        ViewId::Compare => Box::new(compare::Compare::default()),
    }
}

impl ViewId {
    /// Returns the name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        view(self).name()
    }

    /// Returns the title on the screen.
    #[must_use]
    pub fn title(self) -> &'static str {
        view(self).title()
    }
}

/// A name that no view has.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("found {found:?}; allowed: {}", names())]
pub struct UnknownView {
    /// The name.
    pub found: String,
}

fn names() -> String {
    let names: Vec<_> = ViewId::all().map(ViewId::name).collect();
    names.join(", ")
}

impl FromStr for ViewId {
    type Err = UnknownView;

    fn from_str(name: &str) -> Result<Self, UnknownView> {
        let found = Self::all().find(|id| id.name() == name);
        found.ok_or_else(|| UnknownView {
            found: name.to_owned(),
        })
    }
}
