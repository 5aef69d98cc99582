//! The scenarios and plans that are part of the program, so that they work in any folder.

/// A scenario or a plan that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Embedded {
    /// Its name, as given on the command line.
    pub name: &'static str,
    /// Its JSON text.
    pub json: &'static str,
}

/// Embeds the JSON files of a folder with the given names.
macro_rules! embedded {
    ($folder:literal: $($name:literal),+ $(,)?) => {
        &[$(Embedded {
            name: $name,
            json: include_str!(concat!("../../", $folder, "/", $name, ".json")),
        }),+]
    };
}

/// All built-in scenarios: the files of `scenarios/`.
pub const EMBEDDED: &[Embedded] = embedded!["scenarios": "cliff", "environment-1", "environment-1-timed", "environment-2", "environment-2-timed", "environment-3", "environment-3-timed", "environment-4", "environment-5", "environment-6", "four-rooms", "smoke", "taxi", "taxi-fickle"];

/// All built-in plans of studies: the files of `scenarios/studies/`. They use embedded
/// scenarios only.
pub const EMBEDDED_PLANS: &[Embedded] =
    embedded!["scenarios/studies": "evolving-taxi", "learning", "mutation", "thesis"];

/// Returns the names of built-in scenarios or plans, for messages.
#[must_use]
pub fn names(embedded: &[Embedded]) -> String {
    let names: Vec<_> = embedded.iter().map(|embedded| embedded.name).collect();
    names.join(", ")
}
