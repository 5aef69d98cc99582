//! Which generations' checkpoints a run keeps.

use std::fmt;
use std::str::FromStr;

/// Which generations' checkpoints are kept, so that past generations can be inspected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Keep {
    /// Those of all generations.
    #[default]
    All,
    /// Those of every n-th generation.
    Every(u64),
    /// Only the latest, `checkpoint.json`.
    None,
}

impl Keep {
    /// Returns whether the checkpoint of a generation is kept.
    #[must_use]
    pub fn keeps(self, generation: u64) -> bool {
        match self {
            Self::All => true,
            Self::Every(n) => generation.is_multiple_of(n),
            Self::None => false,
        }
    }
}

impl fmt::Display for Keep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::Every(n) => write!(f, "{n}"),
            Self::None => f.write_str("none"),
        }
    }
}

impl FromStr for Keep {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match (text, text.parse()) {
            ("all", _) => Ok(Self::All),
            ("none", _) => Ok(Self::None),
            (_, Ok(n)) if n > 0 => Ok(Self::Every(n)),
            _ => Err(format!(
                "found {text:?}; allowed: all, none, or a number n for every n-th"
            )),
        }
    }
}
