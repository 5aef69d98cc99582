//! The views by name: what keys, hints, the desk and the command line know of them.

use std::str::FromStr;

use thiserror::Error;

/// A view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ViewId {
    /// Everything at a glance.
    Overview,
    /// A rollout of the selected individual.
    Arena,
    /// The selected individual's task hierarchy.
    Hierarchy,
    /// Fitness and structural difference over generations.
    Fitness,
    /// Primitive-selection probabilities.
    Policy,
    /// All individuals of a generation.
    Population,
    /// What the run is doing.
    Status,
    /// An individual: its tree, what it has learned, where it comes from.
    Inspector,
    /// What an individual would do all over the arena.
    PolicyMap,
    /// One time step of the rollout.
    Stepper,
    /// Two individuals side by side.
    Compare,
}

/// A view's name for the command line, and its title.
const VIEWS: &[(ViewId, &str, &str)] = &[
    (ViewId::Overview, "overview", "Overview"),
    (ViewId::Arena, "arena", "Arena"),
    (ViewId::Hierarchy, "hierarchy", "Hierarchy"),
    (ViewId::Fitness, "fitness", "Fitness"),
    (ViewId::Policy, "policy", "Policy"),
    (ViewId::Population, "population", "Population"),
    (ViewId::Status, "status", "Status"),
    (ViewId::Inspector, "inspector", "Inspector"),
    (ViewId::PolicyMap, "policy-map", "Policy map"),
    (ViewId::Stepper, "stepper", "Trial stepper"),
    (ViewId::Compare, "compare", "Comparison"),
];

/// A name that no view has.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("found {found:?}; allowed: {}", names())]
pub struct UnknownView {
    /// The name.
    pub found: String,
}

fn names() -> String {
    let names: Vec<_> = VIEWS.iter().map(|(_, name, _)| *name).collect();
    names.join(", ")
}

impl ViewId {
    /// All views, in the order of the header.
    pub fn all() -> impl Iterator<Item = Self> {
        VIEWS.iter().map(|(id, ..)| *id)
    }

    fn entry(self) -> (&'static str, &'static str) {
        let entry = VIEWS.iter().find(|(id, ..)| *id == self);
        entry.map_or(("", ""), |(_, name, title)| (name, title))
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// Whether it shows what the individual on the stage does or has learned.
    pub(super) fn needs_stage(self) -> bool {
        matches!(
            self,
            Self::Arena
                | Self::Hierarchy
                | Self::Inspector
                | Self::PolicyMap
                | Self::Stepper
                | Self::Compare
        )
    }

    /// The view that takes apart what is selected in it.
    pub(super) fn opens(self) -> Option<Self> {
        matches!(self, Self::Hierarchy | Self::Population | Self::Compare)
            .then_some(Self::Inspector)
    }

    /// Its title.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.entry().1
    }
}

impl FromStr for ViewId {
    type Err = UnknownView;

    fn from_str(name: &str) -> Result<Self, UnknownView> {
        let entry = VIEWS.iter().find(|(_, known, _)| *known == name);
        entry.map(|(id, ..)| *id).ok_or_else(|| UnknownView {
            found: name.to_owned(),
        })
    }
}
