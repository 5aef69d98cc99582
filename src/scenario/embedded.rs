//! The shipped scenarios, built into the program so that they work in any folder.

/// A scenario, or a plan, that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// The name it is run by.
    pub name: &'static str,
    /// Its JSON text.
    pub json: &'static str,
}

macro_rules! embedded {
    ($folder:literal: $($name:literal),+ $(,)?) => {
        &[$(Embedded {
            name: $name,
            json: include_str!(concat!("../../scenarios/", $folder, $name, ".json")),
        }),+]
    };
}

/// All embedded scenarios.
pub const EMBEDDED: &[Embedded] = embedded![
    "":
    "environment-1",
    "environment-2",
    "environment-3",
    "taxi",
    "taxi-fickle",
    "cliff",
    "smoke",
];

/// All embedded plans of studies; the names of their scenarios are those of embedded ones.
pub const EMBEDDED_PLANS: &[Embedded] = embedded!["studies/": "thesis", "evolving-taxi"];

/// The names of the embedded scenarios, for messages.
pub(super) fn names() -> String {
    let names: Vec<_> = EMBEDDED.iter().map(|embedded| embedded.name).collect();
    names.join(", ")
}
