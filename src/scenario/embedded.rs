//! The shipped scenarios, built into the program so that they work in any folder.

/// A scenario, or a plan, that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// The name it is run by.
    pub name: &'static str,
    /// Its JSON text.
    pub json: &'static str,
}

/// All embedded scenarios: the files of `scenarios/`, found by `src/build.rs`.
pub const EMBEDDED: &[Embedded] = include!(concat!(env!("OUT_DIR"), "/scenarios.rs"));

/// All embedded plans of studies, the files of `scenarios/studies/`; the names of their
/// scenarios are those of embedded ones.
pub const EMBEDDED_PLANS: &[Embedded] = include!(concat!(env!("OUT_DIR"), "/plans.rs"));

/// The names of the embedded scenarios, for messages.
pub(super) fn names() -> String {
    let names: Vec<_> = EMBEDDED.iter().map(|embedded| embedded.name).collect();
    names.join(", ")
}
