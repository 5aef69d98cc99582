//! In which settings two scenarios differ.

use std::fmt;

use serde_json::Value;

use crate::scenario::{EMBEDDED, Scenario};

/// Longest value that is shown as it is, in characters.
const LONGEST: usize = 40;

/// A setting that two scenarios do not have alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Its dotted path, as `--set` takes it.
    pub key: String,
    /// Its value in the one scenario, as JSON; shortened where it is long.
    pub one: String,
    /// Its value in the other.
    pub other: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, one, .. } = self;
        write!(f, "{key}={one}")
    }
}

/// The settings that two scenarios do not have alike, in the order of their paths; what they
/// are called and described as is no setting.
#[must_use]
pub fn differences(one: &Scenario, other: &Scenario) -> Vec<Difference> {
    let mut found = Vec::new();
    let json = |scenario: &Scenario| serde_json::to_value(scenario).unwrap_or_default();
    compare("", Some(&json(one)), Some(&json(other)), &mut found);
    found.retain(|difference| !["name", "description"].contains(&difference.key.as_str()));
    found
}

/// The settings in which a scenario departs from the embedded one of its name; none where
/// there is no embedded one.
#[must_use]
pub fn overrides(scenario: &Scenario) -> Vec<Difference> {
    let embedded = EMBEDDED.iter().find(|known| known.name == scenario.name);
    let embedded = embedded.and_then(|known| Scenario::parse(known.json, known.name).ok());
    embedded.map_or_else(Vec::new, |embedded| differences(scenario, &embedded))
}

/// Differences that are told one by one.
const TOLD: usize = 6;

/// The first differences, as `--set` takes them, and how many more there are; none if all is
/// alike.
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

/// The name of a scenario and in what it departs from the embedded one of that name, in the
/// words of [`summarise`].
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
        // As it may be written after `--set`.
        Some(Value::String(word)) => word.clone(),
        Some(value) => value.to_string(),
    };
    match text.chars().count() > LONGEST {
        true => text
            .chars()
            .take(LONGEST - 3)
            .chain("...".chars())
            .collect(),
        false => text,
    }
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
    fn settings_that_are_not_alike_are_found_and_no_others() {
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
    fn worlds_differ_as_a_whole_and_long_values_are_shortened() {
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
    fn a_scenario_departs_from_the_embedded_one_of_its_name() {
        assert_eq!(overrides(&smoke(&[])), []);
        let changed = overrides(&smoke(&["evolution.generation_limit=3"]));
        assert_eq!(changed[0].to_string(), "evolution.generation_limit=3");
        assert_eq!(
            overrides(&smoke(&["name=mine", "learning.discount=0.5"])),
            []
        );
    }
}
