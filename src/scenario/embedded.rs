//! The shipped scenarios, built into the program so that they work in any folder.

/// A scenario, or a plan, that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// The name it is run by.
    pub name: &'static str,
    /// Its JSON text.
    pub json: &'static str,
}

/// The files of a folder by name, built into the program.
macro_rules! embedded {
    ($folder:literal: $($name:literal),+ $(,)?) => {
        &[$(Embedded {
            name: $name,
            json: include_str!(concat!("../../", $folder, "/", $name, ".json")),
        }),+]
    };
}

/// All embedded scenarios: the files of `scenarios/`.
pub const EMBEDDED: &[Embedded] = embedded!["scenarios": "cliff", "environment-1", "environment-2", "environment-3", "four-rooms", "smoke", "taxi", "taxi-fickle"];

/// All embedded plans of studies, the files of `scenarios/studies/`; the names of their
/// scenarios are those of embedded ones.
pub const EMBEDDED_PLANS: &[Embedded] =
    embedded!["scenarios/studies": "evolving-taxi", "mutation", "thesis"];

/// The names of the embedded scenarios, for messages.
pub(super) fn names() -> String {
    let names: Vec<_> = EMBEDDED.iter().map(|embedded| embedded.name).collect();
    names.join(", ")
}
