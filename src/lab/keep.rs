//! Which generations' checkpoints a run keeps.

use std::fmt;
use std::iter;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Generations that are all kept when older ones are thinned out. Most runs converge sooner.
pub const RECENT: u64 = 64;

/// Which generations' checkpoints are kept, so that past generations can be inspected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum Keep {
    /// Those of the last 64 generations, and fewer of older ones: every second until they
    /// are twice as old, then every fourth until they are four times as old, and so on.
    #[default]
    Thinned,
    /// Those of all generations.
    All,
    /// Those of every n-th generation.
    Every(u64),
    /// Only the latest, `checkpoint.json`.
    None,
}

impl Keep {
    /// Returns whether the checkpoint of a generation is kept once the run has reached generation
    /// `latest`. One that is no longer kept is not needed later either.
    #[must_use]
    pub fn keeps(self, generation: u64, latest: u64) -> bool {
        match self {
            Self::Thinned => {
                let age = latest.saturating_sub(generation);
                let doublings = (age / RECENT).checked_ilog2().map_or(0, |log| log + 1);
                generation.is_multiple_of(1 << doublings)
            }
            Self::All => true,
            Self::Every(n) => generation.is_multiple_of(n),
            Self::None => false,
        }
    }

    /// Returns the generations that are no longer kept from generation `latest` on.
    pub(super) fn dropped_at(self, latest: u64) -> impl Iterator<Item = u64> {
        // Only at these ages more of them are left out.
        let ages = iter::successors(Some(RECENT), |age| age.checked_mul(2));
        let aged = ages.map_while(move |age| latest.checked_sub(age));
        let aged = aged.filter(move |&generation| generation > 0);
        aged.filter(move |&generation| self == Self::Thinned && !self.keeps(generation, latest))
    }
}

impl fmt::Display for Keep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Thinned => f.write_str("thinned"),
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
            ("thinned", _) => Ok(Self::Thinned),
            ("all", _) => Ok(Self::All),
            ("none", _) => Ok(Self::None),
            (_, Ok(n)) if n > 0 => Ok(Self::Every(n)),
            _ => Err(format!(
                "found {text:?}; allowed: thinned, all, none, or a number n for every n-th"
            )),
        }
    }
}

impl TryFrom<String> for Keep {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Keep> for String {
    fn from(keep: Keep) -> Self {
        keep.to_string()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn thinning_as_the_run_goes_on_keeps_what_the_rule_says() {
        let mut kept = BTreeSet::new();
        for latest in 1..=3000 {
            kept.insert(latest);
            for dropped in Keep::Thinned.dropped_at(latest) {
                kept.remove(&dropped);
            }
            let said = (1..=latest).filter(|&generation| Keep::Thinned.keeps(generation, latest));
            assert!(kept.iter().copied().eq(said), "at generation {latest}");
        }
        // All of the last 64, and 32 of each doubling.
        assert!(kept.range(2937..).count() == 64);
        assert!(kept.len() < 64 + 32 * 6, "{}", kept.len());
        assert!((1..=63).all(|latest| Keep::Thinned.dropped_at(latest).next().is_none()));
        assert_eq!(Keep::All.dropped_at(3000).count(), 0);
    }

    #[test]
    fn the_text_is_read_back() {
        for keep in [Keep::Thinned, Keep::All, Keep::Every(7), Keep::None] {
            assert_eq!(keep.to_string().parse(), Ok(keep));
        }
        assert!("0".parse::<Keep>().is_err());
    }
}
