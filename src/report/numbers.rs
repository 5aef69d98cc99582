//! Lists of whole numbers as people write them, such as `1..30` or `1..10,15`.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::words::quoted;

/// Most numbers that a list may hold.
const MAX_COUNT: u64 = 1_000_000;

/// Distinct whole numbers in the order given. The text form has numbers and inclusive ranges,
/// separated by commas.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Numbers {
    ranges: Vec<RangeInclusive<u64>>,
}

impl Numbers {
    /// Returns the numbers in order.
    pub fn iter(&self) -> impl Iterator<Item = u64> + '_ {
        self.ranges.iter().cloned().flatten()
    }

    /// Returns how many numbers there are.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.ranges
            .iter()
            .map(|range| range.end() - range.start() + 1)
            .sum()
    }

    /// Returns these numbers, then those of `more` that are not among them.
    ///
    /// # Errors
    /// When they are too many.
    pub fn with(&self, more: &Self) -> Result<Self, String> {
        let lacking = more.iter().filter(|&number| !self.contains(number));
        Self::of(self.iter().chain(lacking))
    }

    /// Returns the same numbers, the smallest first.
    #[must_use]
    pub fn sorted(&self) -> Self {
        let mut ranges = self.ranges.clone();
        ranges.sort_by_key(|range| *range.start());
        let sorted = Self { ranges };
        // There are not more of them than before.
        Self::of(sorted.iter()).unwrap_or(sorted)
    }

    /// Joins distinct numbers to ranges.
    fn of(numbers: impl Iterator<Item = u64>) -> Result<Self, String> {
        let mut ranges: Vec<RangeInclusive<u64>> = Vec::new();
        for (before, number) in (0..).zip(numbers) {
            if before == MAX_COUNT {
                return Err(format!("found more numbers; allowed: 1 to {MAX_COUNT}"));
            }
            match ranges.last_mut() {
                Some(last) if last.end().checked_add(1) == Some(number) => {
                    *last = *last.start()..=number;
                }
                _ => ranges.push(number..=number),
            }
        }
        Ok(Self { ranges })
    }

    /// Returns whether `number` is among them.
    #[must_use]
    pub fn contains(&self, number: u64) -> bool {
        self.ranges.iter().any(|range| range.contains(&number))
    }
}

impl FromStr for Numbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut ranges: Vec<RangeInclusive<u64>> = Vec::new();
        let mut count = 0_u64;
        for part in text.split(',') {
            let range = range(part.trim()).ok_or_else(|| wrong(part))?;
            let meets = |other: &RangeInclusive<u64>| {
                other.start() <= range.end() && range.start() <= other.end()
            };
            if ranges.iter().any(meets) {
                return Err(format!(
                    "found {} twice; allowed: each number once",
                    quoted(part)
                ));
            }
            count = count.saturating_add((range.end() - range.start()).saturating_add(1));
            if count > MAX_COUNT {
                return Err(format!("found {count} numbers; allowed: 1 to {MAX_COUNT}"));
            }
            ranges.push(range);
        }
        Ok(Self { ranges })
    }
}

fn range(part: &str) -> Option<RangeInclusive<u64>> {
    let range = match part.split_once("..") {
        Some((first, last)) => {
            first.parse().ok()?..=last.strip_prefix('=').unwrap_or(last).parse().ok()?
        }
        None => {
            let number = part.parse().ok()?;
            number..=number
        }
    };
    (!range.is_empty()).then_some(range)
}

fn wrong(part: &str) -> String {
    format!(
        "found {}; allowed: numbers and ranges separated by commas, such as 1..30 or 1,2,5..9",
        quoted(part)
    )
}

impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, range) in self.ranges.iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            match (range.start(), range.end()) {
                (first, last) if first == last => write!(f, "{comma}{first}")?,
                (first, last) => write!(f, "{comma}{first}..{last}")?,
            }
        }
        Ok(())
    }
}

impl TryFrom<String> for Numbers {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Numbers> for String {
    fn from(numbers: Numbers) -> Self {
        numbers.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_ranges_are_read() {
        let of = |text: &str| text.parse::<Numbers>().unwrap().iter().collect::<Vec<_>>();
        assert_eq!(of("1..3"), [1, 2, 3]);
        assert_eq!(of("1..=3, 7"), [1, 2, 3, 7]);
        assert_eq!(of("5"), [5]);
        let numbers: Numbers = "1..30,42".parse().unwrap();
        assert_eq!(
            (numbers.to_string().as_str(), numbers.count()),
            ("1..30,42", 31)
        );
        assert!(numbers.contains(30) && !numbers.contains(31));
    }

    #[test]
    fn lists_are_joined() {
        let of = |text: &str| text.parse::<Numbers>().unwrap();
        let joined = |one: &str, more: &str| of(one).with(&of(more)).unwrap().to_string();
        assert_eq!(joined("1..30", "31..60"), "1..60");
        assert_eq!(joined("1..30", "20..40,50"), "1..40,50");
        assert_eq!(joined("5,1..3", "4"), "5,1..4");
        assert_eq!(joined("1..3", "2"), "1..3");
        assert_eq!(of("7,4..6,1").sorted().to_string(), "1,4..7");
        let last = u64::MAX.to_string();
        assert_eq!(joined(&last, "0"), format!("{last},0"));
        of("1..600000").with(&of("600001..1200000")).unwrap_err();
    }

    #[test]
    fn anything_else_is_refused() {
        for text in [
            "",
            "a",
            "3..1",
            "1..",
            "1-3",
            "1,,2",
            "1..5,3",
            "-1",
            "0..18446744073709551615",
        ] {
            assert!(text.parse::<Numbers>().is_err(), "{text:?}");
        }
    }
}
