//! The settings in which two scenarios differ.

use std::fmt;

use serde_json::Value;

use crate::scenario::{EMBEDDED, Scenario};

/// Longest value that is shown whole, in characters.
const LONGEST: usize = 40;

/// A setting whose values differ between two scenarios.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Its dotted path, as `--set` takes it.
    pub key: String,
    /// Its value in the first scenario, as JSON; long values are shortened.
    pub one: String,
    /// Its value in the second scenario.
    pub other: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, one, .. } = self;
        write!(f, "{key}={one}")
    }
}

/// Returns the settings in which two scenarios differ, in the order of their paths. Name and
/// description do not count as settings.
#[must_use]
pub fn differences(one: &Scenario, other: &Scenario) -> Vec<Difference> {
    let json = |scenario: &Scenario| serde_json::to_value(scenario).unwrap_or_default();
    let mut found = differences_in(&json(one), &json(other));
    found.retain(|difference| !["name", "description"].contains(&difference.key.as_str()));
    found
}

/// Returns the fields in which two JSON values differ, in the order of their paths.
#[must_use]
pub fn differences_in(one: &Value, other: &Value) -> Vec<Difference> {
    let mut found = Vec::new();
    compare("", Some(one), Some(other), &mut found);
    found
}

/// Returns the first differences, of what is there from what is wanted here, and the number of the
/// others.
#[must_use]
pub fn told(differences: &[Difference]) -> String {
    let one =
        |Difference { key, one, other }: &Difference| format!("{key} is {one} there, {other} here");
    let mut told: Vec<_> = differences.iter().take(TOLD).map(one).collect();
    let more = differences.len().saturating_sub(TOLD);
    if more > 0 {
        told.push(format!("and {more} more"));
    }
    told.join("; ")
}

/// Returns the settings in which a scenario overrides the built-in scenario of its name; none if
/// there is no built-in one.
#[must_use]
pub fn overrides(scenario: &Scenario) -> Vec<Difference> {
    let embedded = EMBEDDED.iter().find(|known| known.name == scenario.name);
    let embedded = embedded.and_then(|known| Scenario::parse(known.json, known.name).ok());
    embedded.map_or_else(Vec::new, |embedded| differences(scenario, &embedded))
}

/// Differences that are listed.
const TOLD: usize = 6;

/// Returns the first differences, as `--set` takes them, and the number of the others; `None` if
/// there are none.
#[must_use]
pub fn summarise(differences: &[Difference]) -> Option<String> {
    let told: Vec<_> = differences
        .iter()
        .take(TOLD)
        .map(ToString::to_string)
        .collect();
    let more = match differences.len().saturating_sub(TOLD) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!told.is_empty()).then(|| told.join(", ") + &more)
}

/// Returns the name of a scenario with the summary of its overrides, which [`summarise`] makes.
#[must_use]
pub fn with_changes(name: &str, changed: Option<&str>) -> String {
    match changed {
        Some(changed) => format!("{name} with {changed}"),
        None => name.to_owned(),
    }
}

fn compare(path: &str, one: Option<&Value>, other: Option<&Value>, found: &mut Vec<Difference>) {
    if one == other {
        return;
    }
    if let (Some(Value::Object(one)), Some(Value::Object(other))) = (one, other) {
        let added = other.keys().filter(|key| !one.contains_key(*key));
        for key in one.keys().chain(added) {
            let inner = match path {
                "" => key.clone(),
                _ => format!("{path}.{key}"),
            };
            compare(&inner, one.get(key), other.get(key), found);
        }
        return;
    }
    found.push(Difference {
        key: path.to_owned(),
        one: shown(one),
        other: shown(other),
    });
}

fn shown(value: Option<&Value>) -> String {
    let text = match value {
        None => return String::from("nothing"),
        // `--set` takes a word without quotes.
        Some(Value::String(word)) => word.clone(),
        Some(value) => value.to_string(),
    };
    if text.chars().count() <= LONGEST {
        return text;
    }
    let start = text.chars().take(LONGEST - 3);
    start.chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn smoke(settings: &[&str]) -> Scenario {
        let settings: Vec<_> = settings.iter().map(|&setting| setting.into()).collect();
        let smoke = Scenario::load("smoke").unwrap();
        smoke.with_settings(&settings).unwrap()
    }

    #[test]
    fn exactly_the_settings_that_differ_are_found() {
        assert_eq!(differences(&smoke(&[]), &smoke(&[])), []);
        let renamed = smoke(&["name=mine", "description=of my own"]);
        assert_eq!(differences(&renamed, &smoke(&[])), []);
        let changed = smoke(&["evolution.selection=random", "learning.discount=0.5"]);
        let found = differences(&changed, &smoke(&["learning.discount=0.25"]));
        let texts: Vec<_> = found.iter().map(ToString::to_string).collect();
        assert_eq!(
            texts,
            ["evolution.selection=random", "learning.discount=0.5"]
        );
        assert_eq!(found[1].other, "0.25");
    }

    #[test]
    fn different_worlds_are_one_difference_and_long_values_are_shortened() {
        let found = differences(&smoke(&[]), &Scenario::load("cliff").unwrap());
        let world = found
            .iter()
            .find(|difference| difference.key == "world.foraging");
        let world = world.unwrap();
        assert_eq!(world.one.chars().count(), LONGEST);
        assert!(world.one.ends_with("..."), "{world}");
        assert_eq!(world.other, "nothing");
    }

    #[test]
    fn overrides_are_those_of_the_built_in_scenario_of_the_same_name() {
        assert_eq!(overrides(&smoke(&[])), []);
        let changed = overrides(&smoke(&["evolution.generation_limit=3"]));
        assert_eq!(changed[0].to_string(), "evolution.generation_limit=3");
        assert_eq!(
            overrides(&smoke(&["name=mine", "learning.discount=0.5"])),
            []
        );
    }
}
