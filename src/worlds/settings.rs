//! The settings of worlds, and the list that tells one world from another.

use super::scene::Scenic;
use crate::rules::{Check, Problem};

/// The settings of a world in a scenario file. They make the world.
///
/// The folder `src/worlds/NAME` exports them as `NameSettings`. The rest of the program uses
/// nothing else of it.
pub trait Settings {
    /// The world.
    type World: Scenic + 'static;

    /// Checks the settings and reports every broken rule.
    fn check(&self, check: &mut Check);

    /// Makes the world. The settings have been checked.
    ///
    /// # Errors
    /// Fails if they describe no world nevertheless. The problem's place is below the settings.
    fn build(&self) -> Result<Self::World, Problem>;

    /// Returns whether primitive subtasks are trained before evolution starts
    /// ([`World::training`](super::World::training)). If not, each individual learns them.
    fn trains_primitives(&self) -> bool {
        false
    }
}

/// A function of a world of any type: [`call`](WorldFn::call) is compiled once for each world.
pub trait WorldFn {
    /// What the function returns.
    type Output;

    /// Calls the function.
    fn call<W: Scenic + 'static>(self, world: W) -> Self::Output;
}

/// Defines the settings of a scenario's world, an enum of all worlds. Called once, in
/// `worlds/mod.rs`.
macro_rules! worlds {
    ($($(#[$doc:meta])* $name:ident: $folder:literal, $model:path;)+) => {
        /// The world of a scenario: its name, which is that of its folder, and its settings.
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum WorldSettings {
            $($(#[$doc])* $name(Box<$model>),)+
        }

        impl WorldSettings {
            /// The name of the world.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$name(_) => $folder,)+
                }
            }

            /// Checks every rule that the settings obey.
            pub fn check(&self, check: &mut Check) {
                match self {
                    $(Self::$name(model) => check.within($folder, |c| model.check(c)),)+
                }
            }

            /// Whether primitive subtasks are trained before evolution starts.
            #[must_use]
            pub fn trains_primitives(&self) -> bool {
                match self {
                    $(Self::$name(model) => model.trains_primitives(),)+
                }
            }

            /// Builds the world and calls `function` with it.
            ///
            /// # Errors
            /// When the settings make no world; the problem's place is below `world`.
            pub fn build<F: WorldFn>(&self, function: F) -> Result<F::Output, Problem> {
                let built = match self {
                    $(Self::$name(model) => model.build().map(|world| function.call(world)),)+
                };
                built.map_err(|problem| problem.within(self.name()))
            }
        }
    };
}
