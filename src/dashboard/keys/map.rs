//! The key map: which key triggers which action.

use thiserror::Error;

use super::action::{Action, Scope};
use super::key::{Key, KeyError};
use crate::dashboard::look::{Signs, width};
use crate::dashboard::view_id::ViewId;

/// The key map: which key triggers which action.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeyMap {
    bindings: Vec<(Action, Vec<Key>)>,
}

/// A key that is bound to two actions which can meet.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("key {key} is bound to {:?} and to {:?}, which apply in the same view; allowed: one action for each key", .one.name(), .other.name())]
pub struct Collision {
    /// The key.
    pub key: Key,
    /// One action.
    pub one: Action,
    /// The other action.
    pub other: Action,
}

impl Default for KeyMap {
    /// Returns the default keys of every action.
    fn default() -> Self {
        let parse = |action: Action| -> Result<Vec<Key>, KeyError> {
            action
                .default_keys()
                .iter()
                .map(|key| key.parse())
                .collect()
        };
        let bindings = Action::ALL.iter().map(|&action| {
            // A test checks that every default is a key.
            (action, parse(action).unwrap_or_default())
        });
        Self {
            bindings: bindings.collect(),
        }
    }
}

impl KeyMap {
    /// Binds an action to `keys` in place of its former keys.
    pub fn bind(&mut self, action: Action, keys: Vec<Key>) {
        for (bound, its_keys) in &mut self.bindings {
            if *bound == action {
                *its_keys = keys;
                return;
            }
        }
    }

    /// Checks that no key means two actions in one place.
    ///
    /// # Errors
    /// The first collision found.
    pub fn check(&self) -> Result<(), Collision> {
        for (index, (one, keys)) in self.bindings.iter().enumerate() {
            for (other, others) in &self.bindings[..index] {
                let shared = keys.iter().find(|key| others.contains(key));
                if let Some(&key) = shared.filter(|_| one.scope().meets(other.scope())) {
                    let (one, other) = (*other, *one);
                    return Err(Collision { key, one, other });
                }
            }
        }
        Ok(())
    }

    /// Returns the action of a key in a view.
    #[must_use]
    pub fn in_view(&self, key: Key, view: ViewId) -> Option<Action> {
        self.find(key, |scope| match scope {
            Scope::Everywhere => true,
            Scope::In(views) => views.contains(&view),
            Scope::ExportMenu | Scope::Question => false,
        })
    }

    /// Returns the action of a key in exactly this scope.
    #[must_use]
    pub fn in_scope(&self, key: Key, wanted: Scope) -> Option<Action> {
        self.find(key, |scope| scope == wanted)
    }

    fn find(&self, key: Key, counts: impl Fn(Scope) -> bool) -> Option<Action> {
        let mut found = self.bindings.iter().filter(|(_, keys)| keys.contains(&key));
        found
            .find(|(action, _)| counts(action.scope()))
            .map(|(action, _)| *action)
    }

    /// Returns the keys of an action; none if it is unbound.
    #[must_use]
    pub fn keys(&self, action: Action) -> &[Key] {
        let mut bindings = self.bindings.iter();
        bindings
            .find(|(bound, _)| *bound == action)
            .map_or(&[], |(_, keys)| keys)
    }

    /// Returns the first key of an action and its hint, such as `p pause`, or `None` if it is
    /// unbound.
    ///
    /// For an action with an opposite the keys of both are named, such as `↑↓ select`.
    #[must_use]
    pub fn hint(&self, action: Action, signs: &Signs) -> Option<(String, &'static str)> {
        let both = match action {
            Action::Up | Action::Down => &[Action::Up, Action::Down][..],
            Action::Left | Action::Right => &[Action::Left, Action::Right],
            _ => &[action],
        };
        let keys = both.iter().filter_map(|&action| self.keys(action).first());
        let labels: Vec<_> = keys.map(|key| key.label(signs)).collect();
        let are_short = labels.iter().all(|label| width(label) == 1);
        let between = if are_short { "" } else { "/" };
        (!labels.is_empty()).then(|| (labels.join(between), action.hint()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_action_has_a_key_and_no_default_collides() {
        let map = KeyMap::default();
        map.check().unwrap();
        for &action in Action::ALL {
            let keys = map.keys(action);
            assert_eq!(keys.len(), action.default_keys().len(), "{action:?}");
            assert!(
                !keys.is_empty() && !action.description().is_empty(),
                "{action:?}"
            );
            assert_eq!(Action::find(action.name()), Some(action));
        }
    }
}
