//! Makes the catalogues of the worlds: ids come from lists of names.

use super::catalogue::{
    Blocks, Catalogue, FeatureKind, FeatureMap, Imitation, Kind, MapId, StateType, StateTypeInfo,
    StateTypes, Subtask, SubtaskId,
};

/// Lists names, and defines constants that hold their ids: their places in the list. A name
/// that needs no constant has `_` in its place.
macro_rules! numbered {
    ($list:ident: $id:ident { $($constant:tt = $name:literal,)+ }) => {
        pub(super) const $list: &[&str] = &[$($name),+];
        $(numbered! { @ $list $id $constant $name })+
    };
    (@ $list:ident $id:ident _ $name:literal) => {};
    (@ $list:ident $id:ident $constant:ident $name:literal) => {
        #[doc = concat!("`", $name, "`.")]
        pub const $constant: $id = $id($crate::worlds::builder::place($list, $name));
    };
}

/// The place of a name in a list. In a constant, a name that is not listed fails to compile.
pub(super) const fn place(names: &[&str], name: &str) -> u8 {
    let mut place = 0;
    while !equal(names[place].as_bytes(), name.as_bytes()) {
        place += 1;
    }
    place as u8
}

fn owned(names: &[&str]) -> impl Iterator<Item = String> {
    names.iter().map(|&name| String::from(name))
}

const fn equal(a: &[u8], b: &[u8]) -> bool {
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

/// A catalogue in the making.
pub(super) struct CatalogueBuilder {
    catalogue: Catalogue,
    blocks: Blocks,
}

impl CatalogueBuilder {
    /// Starts a catalogue with these names. The terminal state type is the last of its list.
    pub(super) fn new<'n>(
        blocks: Blocks,
        state_types: &[&str],
        subtasks: impl IntoIterator<Item = &'n str>,
        maps: &[&str],
    ) -> Self {
        let (_terminal, others) = state_types.split_last().unwrap_or((&"", &[]));
        let names = subtasks.into_iter().map(String::from);
        let subtasks = names.map(|name| Subtask {
            kind: Kind::Primitive {
                actions: vec![name.to_lowercase()],
                imitates: None,
            },
            name,
            purpose: String::new(),
            active: StateTypes::default(),
            map: MapId(0),
        });
        let maps = owned(maps).map(|name| FeatureMap {
            name,
            kind: FeatureKind::Table(Vec::new()),
        });
        Self {
            catalogue: Catalogue {
                state_types: owned(others)
                    .map(|description| StateTypeInfo { description })
                    .collect(),
                subtasks: subtasks.collect(),
                maps: maps.collect(),
                memory: None,
            },
            blocks,
        }
    }

    /// Sets what a feature map is made of.
    pub(super) fn map(&mut self, id: MapId, kind: FeatureKind) {
        self.catalogue.maps[id.index()].kind = kind;
    }

    /// Describes a primitive subtask. It has one action, with the subtask's own name.
    pub(super) fn primitive(
        &mut self,
        id: SubtaskId,
        purpose: &str,
        map: MapId,
        active: impl Into<StateTypes>,
    ) {
        let subtask = &mut self.catalogue.subtasks[id.index()];
        subtask.purpose = purpose.to_owned();
        subtask.active = active.into();
        subtask.map = map;
    }

    /// Gives a primitive subtask several actions.
    pub(super) fn actions(&mut self, id: SubtaskId, actions: Vec<String>) {
        self.catalogue.subtasks[id.index()].kind = Kind::Primitive {
            actions,
            imitates: None,
        };
    }

    /// Takes a primitive subtask's actions away: it uses those of others.
    pub(super) fn imitation(&mut self, id: SubtaskId, imitation: Imitation) {
        self.catalogue.subtasks[id.index()].kind = Kind::Primitive {
            actions: Vec::new(),
            imitates: Some(imitation),
        };
    }

    /// Lets an input tell whether the agent remembers the place that its task needs.
    pub(super) fn memory(&mut self, input: usize) {
        self.catalogue.memory = Some(input);
    }

    /// Sets how the completion functions of a composite subtask depend on the type of a state.
    pub(super) fn blocks(&mut self, id: SubtaskId, by: Blocks) {
        if let Kind::Composite { blocks, .. } = &mut self.catalogue.subtasks[id.index()].kind {
            *blocks = by;
        }
    }

    /// Describes a composite subtask.
    pub(super) fn composite(
        &mut self,
        id: SubtaskId,
        purpose: &str,
        map: MapId,
        active: impl Into<StateTypes>,
        goal: impl Into<StateTypes>,
        weight: u32,
    ) {
        self.primitive(id, purpose, map, active);
        self.catalogue.subtasks[id.index()].kind = Kind::Composite {
            goal: goal.into(),
            weight,
            blocks: self.blocks,
            abstractions: Vec::new(),
        };
    }

    /// Lets the completion functions of a composite subtask for a child look at less.
    pub(super) fn abstraction(&mut self, parent: SubtaskId, child: SubtaskId, map: MapId) {
        let kind = &mut self.catalogue.subtasks[parent.index()].kind;
        if let Kind::Composite { abstractions, .. } = kind {
            abstractions.push((child, map));
        }
    }

    /// The catalogue.
    pub(super) fn finish(self) -> Catalogue {
        self.catalogue
    }
}

impl<const N: usize> From<[StateType; N]> for StateTypes {
    fn from(types: [StateType; N]) -> Self {
        Self::of(&types)
    }
}
