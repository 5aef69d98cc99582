//! What a world tells about its subtasks: names, active states, goals, features.

use std::fmt;

/// The type of a state, numbered from 0; the worlds' documentation, and all that a
/// person sees, numbers them from 1 as Thesis Table 4.1 does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StateType(pub u8);

impl StateType {
    /// The number a person sees.
    #[must_use]
    pub fn number(self) -> usize {
        usize::from(self.0) + 1
    }
}

/// A set of state types.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct StateTypes(u32);

impl StateTypes {
    /// The set of the given types.
    #[must_use]
    pub const fn of(types: &[StateType]) -> Self {
        let mut bits = 0;
        let mut i = 0;
        while i < types.len() {
            bits |= 1 << types[i].0;
            i += 1;
        }
        Self(bits)
    }

    /// Whether the set holds `state_type`.
    #[must_use]
    pub const fn contains(self, state_type: StateType) -> bool {
        self.0 & (1 << state_type.0) != 0
    }

    /// Whether the two sets share a type.
    #[must_use]
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether every type of this set is in the other.
    #[must_use]
    pub const fn is_subset_of(self, other: Self) -> bool {
        self.0 & !other.0 == 0
    }

    /// The types of both sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The types that are in both sets.
    #[must_use]
    pub const fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// The types of this set that are not in the other.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// How many types the set holds.
    #[must_use]
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether the set is empty.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// How many types of the set come before `state_type`: the place of its block
    /// among the one-hot blocks of a subtask's parameters.
    #[must_use]
    pub const fn rank(self, state_type: StateType) -> usize {
        (self.0 & ((1 << state_type.0) - 1)).count_ones() as usize
    }

    /// The types in ascending order.
    pub fn iter(self) -> impl Iterator<Item = StateType> {
        (0..u32::BITS as u8)
            .map(StateType)
            .filter(move |&state_type| self.contains(state_type))
    }
}

impl fmt::Display for StateTypes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let numbers: Vec<_> = self.iter().map(|t| t.number().to_string()).collect();
        f.write_str(&numbers.join(","))
    }
}

/// A subtask of a catalogue: its index there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SubtaskId(pub u8);

impl SubtaskId {
    /// The root of every hierarchy comes first in a catalogue.
    pub const ROOT: Self = Self(0);

    /// The index into [`Catalogue::subtasks`].
    #[must_use]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }

    /// The subtask's name in the given catalogue.
    #[must_use]
    pub fn name(self, catalogue: &Catalogue) -> &str {
        &catalogue.subtask(self).name
    }
}

/// A feature map of a catalogue: its index there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MapId(pub u8);

impl MapId {
    /// The index into [`Catalogue::maps`].
    #[must_use]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// One input of a feature map, covered by equidistant RBF centres from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Index into the world's percept.
    pub input: usize,
    /// Number of centres, at least 2.
    pub centres: usize,
    /// Width sigma of the Gaussians.
    pub sigma: f64,
}

/// One input of a table: a whole number from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Index {
    /// Index into the world's percept.
    pub input: usize,
    /// The number of values that it can have.
    pub values: usize,
}

/// How features are made of inputs; the last input varies fastest in the parameter
/// vectors.
#[derive(Clone, Debug, PartialEq)]
pub enum FeatureKind {
    /// A grid of normalised Gaussian features (Thesis Eq. 2.22).
    Gaussian(Vec<Axis>),
    /// One feature for each combination of values, one where it is the case and zero
    /// elsewhere: the linear approximator then is a table. A table without inputs has
    /// one entry.
    Table(Vec<Index>),
}

/// The features of some inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureMap {
    /// What the map covers, for people.
    pub name: String,
    /// The inputs, and what is made of them.
    pub kind: FeatureKind,
}

impl FeatureMap {
    /// Number of features: the product over all inputs.
    #[must_use]
    pub fn width(&self) -> usize {
        match &self.kind {
            FeatureKind::Gaussian(axes) => axes.iter().map(|axis| axis.centres).product(),
            FeatureKind::Table(indices) => indices.iter().map(|index| index.values).product(),
        }
    }

    /// The axes of a grid of Gaussians; none for a table.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        match &self.kind {
            FeatureKind::Gaussian(axes) => axes,
            FeatureKind::Table(_) => &[],
        }
    }
}

/// How the completion functions of a composite subtask see the type of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocks {
    /// One-hot: a block of features for each state type that the subtask is active in
    /// (Thesis 4.2).
    PerStateType,
    /// Not at all, but for what is in the inputs.
    One,
}

/// What kind of subtask it is.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Chooses among its children until it terminates.
    Composite {
        /// State types in which it has reached its goal (Thesis Table 4.2); the
        /// terminal type may be among them.
        goal: StateTypes,
        /// Its weight in the structural difference (Thesis 4.5.2).
        weight: u32,
        /// How its completion functions see state types.
        blocks: Blocks,
        /// Children whose completion functions look at less than the subtask does:
        /// state abstraction (Dietterich 2000, section 5).
        abstractions: Vec<(SubtaskId, MapId)>,
    },
    /// Executes one of its actions for one time step.
    Primitive {
        /// What its actions do, for people; one entry an action.
        actions: Vec<String>,
    },
}

/// A subtask that a world provides.
#[derive(Clone, Debug, PartialEq)]
pub struct Subtask {
    /// Its name in hierarchies, such as `FindBattery`.
    pub name: String,
    /// What it is for, in a few words.
    pub purpose: String,
    /// State types in which it can be active (Thesis Tables 4.2 and 4.3).
    pub active: StateTypes,
    /// The features that its value functions are linear in.
    pub map: MapId,
    /// Composite or primitive.
    pub kind: Kind,
}

impl Subtask {
    /// Whether this is a composite subtask.
    #[must_use]
    pub fn is_composite(&self) -> bool {
        matches!(self.kind, Kind::Composite { .. })
    }

    /// Number of actions of a primitive subtask; 0 for a composite one.
    #[must_use]
    pub fn actions(&self) -> usize {
        match &self.kind {
            Kind::Primitive { actions } => actions.len(),
            Kind::Composite { .. } => 0,
        }
    }

    /// Number of blocks in a parameter vector: see [`Blocks`]; 1 for a primitive subtask.
    #[must_use]
    pub fn blocks(&self) -> usize {
        match self.kind {
            Kind::Composite {
                blocks: Blocks::PerStateType,
                ..
            } => self.active.len(),
            _ => 1,
        }
    }

    /// Which block a state type has.
    #[must_use]
    pub fn block(&self, state_type: StateType) -> usize {
        match self.blocks() {
            1 => 0,
            _ => self.active.rank(state_type),
        }
    }

    /// State types that are goals of a composite subtask; none for a primitive one.
    #[must_use]
    pub fn goal(&self) -> StateTypes {
        match self.kind {
            Kind::Composite { goal, .. } => goal,
            Kind::Primitive { .. } => StateTypes::default(),
        }
    }
}

/// A state type for people.
#[derive(Clone, Debug, PartialEq)]
pub struct StateTypeInfo {
    /// What is the case in such a state.
    pub description: String,
}

/// All subtasks of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Catalogue {
    /// The non-terminal state types, in order.
    pub state_types: Vec<StateTypeInfo>,
    /// The subtasks; the root comes first, composites before primitives.
    pub subtasks: Vec<Subtask>,
    /// The feature maps.
    pub maps: Vec<FeatureMap>,
}

impl Catalogue {
    /// The subtask with this id.
    #[must_use]
    pub fn subtask(&self, id: SubtaskId) -> &Subtask {
        &self.subtasks[id.index()]
    }

    /// The subtask with this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<SubtaskId> {
        self.ids().find(|&id| self.subtask(id).name == name)
    }

    /// All subtasks in order.
    pub fn ids(&self) -> impl Iterator<Item = SubtaskId> + '_ {
        (0..self.subtasks.len()).map(|index| SubtaskId(index as u8))
    }

    /// The composite subtasks in order.
    pub fn composites(&self) -> impl Iterator<Item = SubtaskId> + '_ {
        self.ids().filter(|&id| self.subtask(id).is_composite())
    }

    /// The primitive subtasks in order.
    pub fn primitives(&self) -> impl Iterator<Item = SubtaskId> + '_ {
        self.ids().filter(|&id| !self.subtask(id).is_composite())
    }

    /// One capital letter for each primitive subtask: the first of its capitals, or else of
    /// its letters, that no other has.
    #[must_use]
    pub fn letters(&self) -> Vec<char> {
        let mut letters: Vec<char> = Vec::new();
        for primitive in self.primitives() {
            let name = &self.subtask(primitive).name;
            let capitals = name.chars().filter(char::is_ascii_uppercase);
            let others = name.chars().map(|c| c.to_ascii_uppercase());
            let free = capitals
                .chain(others)
                .find(|letter| !letters.contains(letter));
            letters.push(free.unwrap_or('?'));
        }
        letters
    }

    /// The non-terminal state types in order.
    pub fn types(&self) -> impl Iterator<Item = StateType> + '_ {
        (0..self.state_types.len()).map(|index| StateType(index as u8))
    }

    /// The type of a state in which the overall task is done.
    #[must_use]
    pub fn terminal(&self) -> StateType {
        StateType(self.state_types.len() as u8)
    }

    /// The map of the completion functions of `parent` for `child`, both C~ and C: the
    /// parent's, unless the world says that less is enough.
    #[must_use]
    pub fn completion_map(&self, parent: SubtaskId, child: SubtaskId) -> MapId {
        let parent = self.subtask(parent);
        let Kind::Composite { abstractions, .. } = &parent.kind else {
            return parent.map;
        };
        let own = abstractions.iter().find(|(other, _)| *other == child);
        own.map_or(parent.map, |&(_, map)| map)
    }

    /// Number of parameters of each completion function of `parent` for `child`.
    #[must_use]
    pub fn completion_width(&self, parent: SubtaskId, child: SubtaskId) -> usize {
        let map = self.completion_map(parent, child);
        self.subtask(parent).blocks() * self.maps[map.index()].width()
    }

    /// Number of features of a subtask's value functions (Thesis Table 4.6): those
    /// of its map, once per block of a composite.
    #[must_use]
    pub fn width(&self, id: SubtaskId) -> usize {
        let subtask = self.subtask(id);
        subtask.blocks() * self.maps[subtask.map.index()].width()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_state_types_behave_as_sets() {
        let of = |numbers: &[u8]| {
            StateTypes::of(&numbers.iter().map(|&n| StateType(n)).collect::<Vec<_>>())
        };
        let (some, more) = (of(&[1, 3]), of(&[0, 1, 3]));
        assert!(some.is_subset_of(more) && !more.is_subset_of(some));
        assert!(some.meets(more) && !some.meets(of(&[0, 2])));
        assert_eq!(some.union(of(&[0])), more);
        assert_eq!(more.intersection(of(&[0, 2])), of(&[0]));
        assert_eq!(more.without(of(&[0, 2])), some);
        assert_eq!((more.len(), more.rank(StateType(3))), (3, 2));
        assert_eq!(more.to_string(), "1,2,4");
    }
}
