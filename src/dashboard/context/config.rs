//! The configuration file: keys, theme and styles.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use thiserror::Error;
use toml::Spanned;

use crate::dashboard::keys::{Action, Collision, Key, KeyError, KeyMap};
use crate::dashboard::look::{Paint, StyleError, Theme};
use crate::files::{FileError, read_text};
use crate::words::{plain, quoted, shortened};

/// Size limit of the file, in bytes.
const MAX_BYTES: u64 = 1 << 16;

/// Keys and themes as configured by the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The key map.
    pub keys: KeyMap,
    /// The built-in themes with the user's changes.
    pub themes: Vec<Theme>,
    /// The name of the initial theme; `None` if it is to suit the terminal.
    pub theme: Option<String>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            keys: KeyMap::default(),
            themes: Theme::all(),
            theme: None,
        }
    }
}

/// Why a configuration file cannot be used.
#[derive(Debug, Error)]
pub enum ConfigError {
    /// The file cannot be read or parsed.
    #[error(transparent)]
    File(#[from] FileError),
    /// A value is not allowed.
    #[error("{path}, line {line}: {problem}")]
    Value {
        /// The file.
        path: String,
        /// The line number, from 1.
        line: usize,
        /// The problem.
        problem: Problem,
    },
}

/// A problem with a value.
#[derive(Debug, Error)]
pub enum Problem {
    /// It is not TOML of the right kind.
    #[error("{0}")]
    Syntax(String),
    /// The action does not exist.
    #[error("keys: found {}; allowed: {}", quoted(.found), actions())]
    Action {
        /// The name found.
        found: String,
    },
    /// The key does not exist.
    #[error("keys.{action}: {source}")]
    Key {
        /// The action.
        action: String,
        /// The problem.
        source: KeyError,
    },
    /// A key is bound to two actions that can meet.
    #[error("keys: {0}")]
    Collision(#[from] Collision),
    /// The theme does not exist.
    #[error("theme: found {}; allowed: {allowed}", quoted(.found))]
    Theme {
        /// The name found.
        found: String,
        /// The names of all themes.
        allowed: String,
    },
    /// The paint does not exist.
    #[error("styles: found {}; allowed: {}", quoted(.found), paints())]
    Paint {
        /// The name found.
        found: String,
    },
    /// The style cannot be read.
    #[error("styles.{paint}: {source}")]
    Style {
        /// The paint.
        paint: String,
        /// The problem.
        source: StyleError,
    },
}

fn actions() -> String {
    let names: Vec<_> = Action::ALL.iter().map(|action| action.name()).collect();
    names.join(", ")
}

fn paints() -> String {
    let names: Vec<_> = Paint::ALL.iter().map(|paint| paint.name()).collect();
    names.join(", ")
}

/// The contents of the file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct File {
    theme: Option<Spanned<String>>,
    keys: BTreeMap<Spanned<String>, Spanned<Keys>>,
    styles: BTreeMap<Spanned<String>, Spanned<String>>,
}

/// One key or several.
#[derive(Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "found neither; allowed: a key such as \"p\", or a list of keys such as [\"q\", \"Q\"]"
)]
enum Keys {
    One(String),
    Several(Vec<String>),
}

impl Config {
    /// Returns the default path: `maxq-lab/config.toml` in `XDG_CONFIG_HOME`, or in `.config`
    /// of the home folder.
    #[must_use]
    pub fn default_path() -> Option<PathBuf> {
        let folder = |name| {
            std::env::var_os(name)
                .map(PathBuf::from)
                .filter(|path| path.is_absolute())
        };
        let config = folder("XDG_CONFIG_HOME").or_else(|| Some(folder("HOME")?.join(".config")))?;
        Some(config.join("maxq-lab").join("config.toml"))
    }

    /// Reads a configuration file.
    ///
    /// # Errors
    /// When the file cannot be read, has an unknown name, or binds a key to two actions that
    /// can meet.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        let shown = path.display().to_string();
        let text = read_text(path, MAX_BYTES)?;
        Self::read(&text, &shown)
    }

    /// Reads a configuration from text; errors call it `path`.
    ///
    /// # Errors
    /// When the text has an unknown name, or binds a key to two actions that can meet.
    pub fn read(text: &str, path: &str) -> Result<Self, ConfigError> {
        let file = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            let line = text.lines().nth(line_of(text, at) - 1);
            let line = shortened(line.unwrap_or_default().trim());
            (
                at,
                Problem::Syntax(format!("{line}: {}", plain(error.message()))),
            )
        });
        let config = file.and_then(|file: File| file.apply());
        config.map_err(|(at, problem)| ConfigError::Value {
            path: path.to_owned(),
            line: line_of(text, at),
            problem,
        })
    }
}

fn line_of(text: &str, at: usize) -> usize {
    text.bytes().take(at).filter(|&byte| byte == b'\n').count() + 1
}

/// A byte offset in the file, and the problem there.
type At = (usize, Problem);

impl File {
    fn apply(self) -> Result<Config, At> {
        let mut config = Config::default();
        let mut places = Vec::new();
        for (name, keys) in &self.keys {
            let action = bind(&mut config.keys, name, keys)?;
            places.push((action, name.span().start));
        }
        config.keys.check().map_err(|collision| {
            let named =
                |(action, _): &&(Action, usize)| [collision.one, collision.other].contains(action);
            let at = places.iter().filter(named).map(|(_, at)| *at).max();
            (at.unwrap_or(0), Problem::Collision(collision))
        })?;
        if let Some(theme) = &self.theme {
            let names = config.themes.iter().map(|known| known.name.as_str());
            if !names.clone().any(|name| name == theme.as_ref()) {
                let allowed = names.collect::<Vec<_>>().join(", ");
                let found = theme.as_ref().clone();
                return Err((theme.span().start, Problem::Theme { found, allowed }));
            }
            config.theme = Some(theme.as_ref().clone());
        }
        for (name, style) in &self.styles {
            paint(&mut config, name, style)?;
        }
        Ok(config)
    }
}

fn bind(map: &mut KeyMap, name: &Spanned<String>, keys: &Spanned<Keys>) -> Result<Action, At> {
    let action = Action::find(name.as_ref()).ok_or_else(|| {
        let found = name.as_ref().clone();
        (name.span().start, Problem::Action { found })
    })?;
    let names = match keys.as_ref() {
        Keys::One(key) => std::slice::from_ref(key),
        Keys::Several(keys) => keys,
    };
    let keys: Result<Vec<Key>, KeyError> = names.iter().map(|key| key.parse()).collect();
    let keys = keys.map_err(|source| {
        let action = name.as_ref().clone();
        (name.span().start, Problem::Key { action, source })
    })?;
    map.bind(action, keys);
    Ok(action)
}

/// Changes a style of the configured theme, or of all themes if none is configured.
fn paint(config: &mut Config, name: &Spanned<String>, style: &Spanned<String>) -> Result<(), At> {
    let paint = Paint::find(name.as_ref()).ok_or_else(|| {
        let found = name.as_ref().clone();
        (name.span().start, Problem::Paint { found })
    })?;
    let is_meant =
        |theme: &&mut Theme| config.theme.as_ref().is_none_or(|name| theme.name == *name);
    let mut themes = config.themes.iter_mut().filter(is_meant);
    let set = themes.try_for_each(|theme| theme.set(paint, style.as_ref()));
    set.map_err(|source| {
        let paint = name.as_ref().clone();
        (style.span().start, Problem::Style { paint, source })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        Config::read(text, "config.toml").unwrap_err().to_string()
    }

    #[test]
    fn keys_and_styles_are_taken_over() {
        let text = "theme = \"light\"\n[keys]\npause = \"z\"\nquit = [\"q\", \"Q\"]\n[styles]\nwall = \"bold red on 16\"\n";
        let config = Config::read(text, "config.toml").unwrap();
        assert_eq!(config.theme.as_deref(), Some("light"));
        assert_eq!(config.keys.keys(Action::Pause), ["z".parse().unwrap()]);
        assert_eq!(config.keys.keys(Action::Quit).len(), 2);
        let light = &config.themes[1];
        assert_ne!(light.style(Paint::Wall), Theme::all()[1].style(Paint::Wall));
    }

    #[test]
    fn errors_name_the_place() {
        let lines = [
            ("\n[keys]\npaws = \"p\"\n", "line 3", "paws"),
            ("[keys]\npause = \"pp\"\n", "line 2", "pp"),
            (
                "[keys]\npause = \"p\"\nhelp = \"q\"\n",
                "line 3",
                "\"quit\"",
            ),
            ("theme = \"dusk\"\n", "line 1", "high-contrast"),
            ("[styles]\nwall = \"bald\"\n", "line 2", "bald"),
            ("[styles]\nwal = \"bold\"\n", "line 2", "\"wal\""),
            ("[keyz]\n", "line 1", "keyz"),
            ("[keys]\npause = 3\n", "line 2", "pause"),
        ];
        for (text, line, word) in lines {
            let error = error(text);
            assert!(error.starts_with("config.toml"), "{error}");
            assert!(
                error.contains(line) && error.contains(word),
                "{text:?}: {error}"
            );
        }
    }
}
