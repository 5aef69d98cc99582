//! How the dashboard looks and which keys it has: arguments that several commands share.

use std::path::PathBuf;

use clap::Args;

use super::output::Failure;
use crate::dashboard::Config;
use crate::dashboard::keys::KeyMap;
use crate::dashboard::look::{Look, Signs, Theme};
use crate::hierarchy::Glyphs;

/// How the dashboard looks and which keys it has.
#[derive(Clone, Debug, Args)]
pub(super) struct Appearance {
    /// Colours: dark, light, high-contrast, mono [default: the file's, mono where NO_COLOR
    /// is set, else dark].
    #[arg(long)]
    theme: Option<String>,

    /// Draw with plain ASCII characters [default: where the locale is not UTF-8].
    #[arg(long)]
    ascii: bool,

    /// Keys and colours, a TOML file [default: maxq-lab/config.toml in $XDG_CONFIG_HOME or
    /// ~/.config, if it is there].
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
}

impl Appearance {
    /// Reads the person's file and the environment.
    pub(super) fn load(&self) -> Result<(Look, KeyMap), Failure> {
        let default = || Config::default_path().filter(|path| path.exists());
        let config = match self.config.clone().or_else(default) {
            Some(path) => Config::load(&path)?,
            None => Config::default(),
        };
        let glyphs = match self.ascii {
            true => Glyphs::Ascii,
            false => Glyphs::of_locale(),
        };
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let (themes, first) = match &self.theme {
            Some(theme) => (config.themes, theme.clone()),
            None if no_colour => (vec![Theme::mono()], String::from("mono")),
            None => (config.themes, config.theme),
        };
        if !themes.iter().any(|theme| theme.name == first) {
            let names: Vec<_> = themes.iter().map(|theme| theme.name.as_str()).collect();
            let message = format!("--theme: found {first:?}; allowed: {}", names.join(", "));
            return Err(Failure::Message(message));
        }
        Ok((Look::new(themes, &first, Signs::of(glyphs)), config.keys))
    }
}
