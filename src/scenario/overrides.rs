//! `--set KEY=VALUE`: changes of a scenario on the command line.

use serde_json::Value;

use super::{Scenario, ScenarioError};
use crate::words::{plain, quoted, shortened};

/// Returns the scenario with every setting applied. Rules are not checked here.
///
/// Settings act on the complete scenario with its defaults written out, so every existing key
/// can be set and any other key is an error.
pub(super) fn apply(scenario: &Scenario, settings: &[String]) -> Result<Scenario, ScenarioError> {
    settings
        .iter()
        .try_fold(scenario.clone(), |scenario, setting| {
            apply_one(&scenario, setting).map_err(|message| ScenarioError::Setting {
                setting: shortened(setting),
                message,
            })
        })
}

fn apply_one(scenario: &Scenario, setting: &str) -> Result<Scenario, String> {
    let (key, text) = setting
        .split_once('=')
        .ok_or("found no '='; allowed: key=value, such as learning.discount=0.95")?;
    let mut json = serde_json::to_value(scenario).map_err(|error| error.to_string())?;
    *find(&mut json, key)? =
        serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.to_owned()));
    serde_path_to_error::deserialize(json).map_err(|error| {
        let (place, message) = (error.path().to_string(), error.inner().to_string());
        format!("at {}: {}", shortened(&place), plain(&message))
    })
}

/// Returns the value at the dotted path `key`.
fn find<'a>(root: &'a mut Value, key: &str) -> Result<&'a mut Value, String> {
    let mut place = root;
    let mut path = String::from("the top level");
    for part in key.split('.') {
        let allowed = children(place);
        place = match place {
            Value::Object(fields) => fields.get_mut(part),
            Value::Array(items) => part.parse().ok().and_then(|i: usize| items.get_mut(i)),
            _ => None,
        }
        .ok_or_else(|| {
            format!(
                "found no {} at {path}; allowed there: {allowed}",
                quoted(part)
            )
        })?;
        path = match path.as_str() {
            "the top level" => part.to_owned(),
            _ => format!("{path}.{part}"),
        };
    }
    Ok(place)
}

/// Describes the keys that exist directly below `place`.
fn children(place: &Value) -> String {
    match place {
        Value::Object(fields) => fields.keys().cloned().collect::<Vec<_>>().join(", "),
        Value::Array(items) if items.is_empty() => String::from("nothing, the list is empty"),
        Value::Array(items) => format!("0 to {}", items.len() - 1),
        _ => String::from("nothing, it is a single value"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Selection;

    fn smoke() -> Scenario {
        Scenario::load("smoke").unwrap()
    }

    fn set(setting: &str) -> Result<Scenario, ScenarioError> {
        smoke().with_settings(&[setting.to_owned()])
    }

    #[test]
    fn a_setting_changes_one_value() {
        let changed = set("evolution.selection=random").unwrap();
        assert_eq!(changed.evolution.selection, Selection::Random);
        let changed = set("learning.discount=0.95").unwrap();
        assert_eq!(changed.learning.discount, 0.95);
        let mut expected = smoke();
        expected.learning.discount = 0.95;
        assert_eq!(changed, expected);
    }

    #[test]
    fn errors_name_the_key_the_value_and_the_choice() {
        let message = |setting| set(setting).unwrap_err().to_string();
        assert!(message("learning").contains("allowed: key=value"));
        let unknown = message("learning.gamma=1");
        assert!(unknown.contains("\"gamma\" at learning") && unknown.contains("discount"));
        let wrong = message("evolution.selection=best");
        assert!(wrong.contains("evolution.selection") && wrong.contains("random"));
        let out_of_range = message("learning.discount=2");
        assert!(out_of_range.contains("found 2; allowed: 0 to 1"));
    }
}
