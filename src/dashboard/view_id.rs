//! The views by name, for everything that a view may itself import.

macro_rules! views {
    ($($(#[doc = $doc:literal])* $view:ident,)*) => {
        /// A view.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum ViewId {
            $($(#[doc = $doc])* $view,)*
        }

        impl ViewId {
            /// Returns all views, in the order of their keys.
            pub fn all() -> impl Iterator<Item = Self> {
                [$(Self::$view),*].into_iter()
            }
        }
    };
}

views! {
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
    /// One individual: its hierarchy, what it has learned, its ancestors.
    Inspector,
    /// The actions that an individual would take all over the world.
    PolicyMap,
    /// One time step of the rollout.
    Stepper,
    /// Two individuals side by side.
    Compare,
}
