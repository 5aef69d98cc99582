//! What the folder of a world gives to the rest of the program.

use super::scene::Scenic;
use crate::rules::{Check, Problem};

/// The settings of a world as scenario files hold them, and the world that they make.
///
/// The folder `src/worlds/NAME` exports them as `NameModel`: that is all that is known of it.
pub trait Settings {
    /// The world.
    type World: Scenic + 'static;

    /// Checks every rule that the settings obey.
    fn check(&self, check: &mut Check);

    /// The world that the settings describe; they obey the rules.
    ///
    /// # Errors
    /// When there is none nevertheless. The problem's place is below the settings.
    fn build(&self) -> Result<Self::World, Problem>;

    /// Whether primitive subtasks are trained before evolution starts
    /// ([`World::training`](super::World::training)); where they are not, each individual has to learn them.
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

/// The sum of the worlds: the type of their settings, and the one place that tells one
/// from another. Called once, in `worlds/mod.rs`.
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
