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
    ($($name:literal),+ $(,)?) => {
        /// All embedded scenarios.
        pub const EMBEDDED: &[Embedded] = &[$(Embedded {
            name: $name,
            json: include_str!(concat!("../../scenarios/", $name, ".json")),
        }),+];
    };
}

embedded![
    "environment-1",
    "environment-2",
    "environment-3",
    "taxi",
    "taxi-fickle",
    "cliff",
    "smoke",
];

/// All embedded plans of studies; the names of their scenarios are those of embedded ones.
pub const EMBEDDED_PLANS: &[Embedded] = &[Embedded {
    name: "thesis",
    json: include_str!("../../scenarios/studies/thesis.json"),
}];

/// The names of the embedded scenarios, for messages.
pub(super) fn names() -> String {
    let names: Vec<_> = EMBEDDED.iter().map(|embedded| embedded.name).collect();
    names.join(", ")
}
