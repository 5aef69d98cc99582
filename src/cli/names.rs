//! Names that shells offer to complete, beside the files that an argument may also be.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command, Error};
use clap_complete::Shell;

use crate::dashboard::look::Theme;
use crate::scenario::{EMBEDDED, EMBEDDED_PLANS, Embedded};

/// An argument that is any text; these names are offered.
#[derive(Clone, Debug)]
pub(super) struct Offered(Vec<&'static str>);

/// Offers the built-in scenarios.
pub(super) fn scenarios() -> Offered {
    Offered(names(EMBEDDED).collect())
}

/// Offers the built-in scenarios and plans.
pub(super) fn scenarios_and_plans() -> Offered {
    Offered(names(EMBEDDED).chain(names(EMBEDDED_PLANS)).collect())
}

/// Offers the built-in themes.
pub(super) fn themes() -> Offered {
    Offered(Theme::names().to_vec())
}

fn names(embedded: &[Embedded]) -> impl Iterator<Item = &'static str> {
    embedded.iter().map(|embedded| embedded.name)
}

impl TypedValueParser for Offered {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let names = self.0.iter().copied();
        Some(Box::new(names.map(PossibleValue::new)))
    }
}

/// Returns the completion script that clap made for a shell, mended where it falls short.
pub(super) fn completed(shell: Shell, script: &str, command: &Command) -> String {
    match shell {
        // Clap takes the `-` of the program's name for the start of a subcommand.
        Shell::Bash => script.replace("maxq__subcmd__lab", "maxq__lab"),
        Shell::Zsh => with_files(script),
        Shell::Fish => script.to_owned() + &names_for_fish(command),
        _ => script.to_owned(),
    }
}

/// Returns a completion script for zsh in which the scenarios and plans are offered beside files.
/// Where values are known, zsh would offer them alone.
fn with_files(script: &str) -> String {
    let [scenarios, all] = [scenarios(), scenarios_and_plans()];
    let offers = [scenarios, all].map(|Offered(names)| format!("({})", names.join(" ")));
    let with_files = |script: String, names: &String| {
        let both = format!(":{{_alternative \"names:name:{names}\" \"files:file:_files\"}}");
        script.replace(&format!(":{names}"), &both)
    };
    offers.iter().fold(script.to_owned(), with_files)
}

/// Returns lines for fish that offer names for arguments without an option, which clap leaves out.
fn names_for_fish(command: &Command) -> String {
    let mut lines = String::new();
    for inner in command.get_subcommands() {
        let values = inner.get_positionals().flat_map(Arg::get_possible_values);
        let names: Vec<_> = values.map(|value| value.get_name().to_owned()).collect();
        if !names.is_empty() {
            let (name, names) = (inner.get_name(), names.join(" "));
            lines += &format!(
                "complete -c maxq-lab -n \"__fish_maxq_lab_using_subcommand {name}\" -a \"{names}\"\n"
            );
        }
    }
    lines
}
