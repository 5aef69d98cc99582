//! The subtasks of a world: names, active state types, goals, features.

use std::fmt;

/// The type of a state, numbered from 0. Documentation and output number the types from 1, as
/// Thesis Table 4.1 does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StateType(pub u8);

impl StateType {
    /// Returns the number in documentation and output.
    #[must_use]
    pub fn number(self) -> usize {
        usize::from(self.0) + 1
    }
}

/// A set of state types.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct StateTypes(u32);

impl StateTypes {
    /// Returns the set of the given types.
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

    /// Returns whether the set contains `state_type`.
    #[must_use]
    pub const fn contains(self, state_type: StateType) -> bool {
        self.0 & (1 << state_type.0) != 0
    }

    /// Returns whether the sets have a type in common.
    #[must_use]
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Returns whether every type of this set is in the other.
    #[must_use]
    pub const fn is_subset_of(self, other: Self) -> bool {
        self.0 & !other.0 == 0
    }

    /// Returns the types that are in either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the types that are in both sets.
    #[must_use]
    pub const fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns the types of this set that are not in the other.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns the number of types.
    #[must_use]
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Returns whether the set is empty.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the number of types of the set before `state_type`: the place of its block among
    /// the one-hot blocks of a subtask's parameters.
    #[must_use]
    pub const fn rank(self, state_type: StateType) -> usize {
        (self.0 & ((1 << state_type.0) - 1)).count_ones() as usize
    }

    /// Returns the types in ascending order.
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

/// The index of a subtask in its catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SubtaskId(pub u8);

impl SubtaskId {
    /// The root of every hierarchy, the first subtask of every catalogue.
    pub const ROOT: Self = Self(0);

    /// Returns the index into [`Catalogue::subtasks`].
    #[must_use]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }

    /// Returns the subtask's name in the given catalogue.
    #[must_use]
    pub fn name(self, catalogue: &Catalogue) -> &str {
        &catalogue.subtask(self).name
    }
}

/// The index of a feature map in its catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MapId(pub u8);

impl MapId {
    /// Returns the index into [`Catalogue::maps`].
    #[must_use]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// An input of a feature map, covered by equidistant RBF centres from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Index into the world's percept.
    pub input: usize,
    /// Number of centres, at least 2.
    pub centres: usize,
    /// Width sigma of the Gaussians.
    pub sigma: f64,
}

/// An input of a table: a whole number from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Index {
    /// Index into the world's percept.
    pub input: usize,
    /// Number of values.
    pub values: usize,
}

/// How features are computed from inputs. In parameter vectors the last input varies fastest.
#[derive(Clone, Debug, PartialEq)]
pub enum FeatureKind {
    /// A grid of normalised Gaussian features (Thesis Eq. 2.22).
    Gaussian(Vec<Axis>),
    /// A table: one feature for each combination of values, which is one for the present
    /// combination and zero otherwise. A table without inputs has one entry.
    Table(Vec<Index>),
}

/// Features of some inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureMap {
    /// The inputs in words.
    pub name: String,
    /// The inputs and how features are computed from them.
    pub kind: FeatureKind,
}

impl FeatureMap {
    /// Returns the number of features: the product over all inputs.
    #[must_use]
    pub fn width(&self) -> usize {
        match &self.kind {
            FeatureKind::Gaussian(axes) => axes.iter().map(|axis| axis.centres).product(),
            FeatureKind::Table(indices) => indices.iter().map(|index| index.values).product(),
        }
    }

    /// Returns the axes of a grid of Gaussians; none for a table.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        match &self.kind {
            FeatureKind::Gaussian(axes) => axes,
            FeatureKind::Table(_) => &[],
        }
    }
}

/// How the completion functions of a composite subtask depend on the type of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocks {
    /// One-hot: a block of features for each state type that the subtask is active in
    /// (Thesis 4.2).
    PerStateType,
    /// One-hot, once for states in which the agent remembers the place that its task needs,
    /// and once for the others ([`Catalogue::memory`]).
    PerStateTypeAndMemory,
    /// Not at all: one block for all state types.
    One,
}

/// The kind of a subtask.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Chooses among its children until it terminates.
    Composite {
        /// State types in which it has reached its goal (Thesis Table 4.2); the
        /// terminal type may be among them.
        goal: StateTypes,
        /// Its weight in the structural difference (Thesis 4.5.2).
        weight: u32,
        /// How its completion functions depend on state types.
        blocks: Blocks,
        /// Children whose completion functions have a map of their own, with fewer inputs:
        /// state abstraction (Dietterich 2000, section 5).
        abstractions: Vec<(SubtaskId, MapId)>,
    },
    /// Executes one of its actions for one time step.
    Primitive {
        /// What each action does, in words.
        actions: Vec<String>,
        /// Whose place it takes, if it has no actions of its own.
        imitates: Option<Imitation>,
    },
}

/// The subtasks whose values and actions a primitive subtask uses instead of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Imitation {
    /// The subtask for each state type, while the agent remembers the place that its task needs.
    pub with_memory: Vec<(StateType, SubtaskId)>,
    /// The subtask in all other states.
    pub otherwise: SubtaskId,
}

/// A subtask that a world provides.
#[derive(Clone, Debug, PartialEq)]
pub struct Subtask {
    /// The name in hierarchies, such as `FindBattery`.
    pub name: String,
    /// Its purpose in a few words.
    pub purpose: String,
    /// State types in which it can be active (Thesis Tables 4.2 and 4.3).
    pub active: StateTypes,
    /// The features that its value functions are linear in.
    pub map: MapId,
    /// Composite or primitive.
    pub kind: Kind,
}

impl Subtask {
    /// Returns whether the subtask is composite.
    #[must_use]
    pub fn is_composite(&self) -> bool {
        matches!(self.kind, Kind::Composite { .. })
    }

    /// Returns the number of actions: 0 for a composite subtask, and for a primitive one that
    /// imitates others.
    #[must_use]
    pub fn actions(&self) -> usize {
        match &self.kind {
            Kind::Primitive { actions, .. } => actions.len(),
            Kind::Composite { .. } => 0,
        }
    }

    /// Returns the number of blocks in a parameter vector (see [`Blocks`]): 1 for a primitive
    /// subtask.
    #[must_use]
    pub fn blocks(&self) -> usize {
        let types = self.active.len();
        match self.blocks_by() {
            Blocks::PerStateType => types,
            Blocks::PerStateTypeAndMemory => 2 * types,
            Blocks::One => 1,
        }
    }

    /// Returns the block of a state type, in states with or without a remembered place.
    #[must_use]
    pub fn block(&self, state_type: StateType, remembers: bool) -> usize {
        let rank = self.active.rank(state_type);
        match self.blocks_by() {
            Blocks::PerStateType => rank,
            Blocks::PerStateTypeAndMemory => rank + usize::from(remembers) * self.active.len(),
            Blocks::One => 0,
        }
    }

    fn blocks_by(&self) -> Blocks {
        match self.kind {
            Kind::Composite { blocks, .. } => blocks,
            Kind::Primitive { .. } => Blocks::One,
        }
    }

    /// Returns the goal of a composite subtask: no state type for a primitive one.
    #[must_use]
    pub fn goal(&self) -> StateTypes {
        match self.kind {
            Kind::Composite { goal, .. } => goal,
            Kind::Primitive { .. } => StateTypes::default(),
        }
    }
}

/// A state type in words.
#[derive(Clone, Debug, PartialEq)]
pub struct StateTypeInfo {
    /// What is true in states of the type.
    pub description: String,
}

/// All subtasks of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Catalogue {
    /// The non-terminal state types, in order.
    pub state_types: Vec<StateTypeInfo>,
    /// The subtasks: the root first, composites before primitives.
    pub subtasks: Vec<Subtask>,
    /// The feature maps.
    pub maps: Vec<FeatureMap>,
    /// The input that is 1 while the agent remembers the place that its task needs, and 0
    /// otherwise; `None` in a world where agents have no memory.
    pub memory: Option<usize>,
}

impl Catalogue {
    /// Returns the subtask with this id.
    #[must_use]
    pub fn subtask(&self, id: SubtaskId) -> &Subtask {
        &self.subtasks[id.index()]
    }

    /// Returns the subtask with this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<SubtaskId> {
        self.ids().find(|&id| self.subtask(id).name == name)
    }

    /// Returns all subtasks in order.
    pub fn ids(&self) -> impl Iterator<Item = SubtaskId> + '_ {
        (0..self.subtasks.len()).map(|index| SubtaskId(index as u8))
    }

    /// Returns the composite subtasks in order.
    pub fn composites(&self) -> impl Iterator<Item = SubtaskId> + '_ {
        self.ids().filter(|&id| self.subtask(id).is_composite())
    }

    /// Returns the primitive subtasks in order.
    pub fn primitives(&self) -> impl Iterator<Item = SubtaskId> + '_ {
        self.ids().filter(|&id| !self.subtask(id).is_composite())
    }

    /// Returns the primitive subtask whose values and actions `primitive` uses in a state:
    /// itself, unless it imitates others.
    #[must_use]
    pub fn acts_as(
        &self,
        primitive: SubtaskId,
        state_type: StateType,
        remembers: bool,
    ) -> SubtaskId {
        let Kind::Primitive {
            imitates: Some(imitation),
            ..
        } = &self.subtask(primitive).kind
        else {
            return primitive;
        };
        let recalled = imitation.with_memory.iter().filter(|_| remembers);
        let mut recalled = recalled.filter(|(of, _)| *of == state_type);
        recalled
            .next()
            .map_or(imitation.otherwise, |&(_, subtask)| subtask)
    }

    /// Returns one capital letter for each primitive subtask: the first of its capitals that no
    /// subtask before it has, or else of its other letters; `?` if there is none.
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

    /// Returns the non-terminal state types in order.
    pub fn types(&self) -> impl Iterator<Item = StateType> + '_ {
        (0..self.state_types.len()).map(|index| StateType(index as u8))
    }

    /// Returns the type of states in which the overall task is done.
    #[must_use]
    pub fn terminal(&self) -> StateType {
        StateType(self.state_types.len() as u8)
    }

    /// Returns the map of both completion functions C~ and C of `parent` for `child`: that of
    /// the parent, unless the parent has an abstraction for the child.
    #[must_use]
    pub fn completion_map(&self, parent: SubtaskId, child: SubtaskId) -> MapId {
        let parent = self.subtask(parent);
        let Kind::Composite { abstractions, .. } = &parent.kind else {
            return parent.map;
        };
        let own = abstractions.iter().find(|(other, _)| *other == child);
        own.map_or(parent.map, |&(_, map)| map)
    }

    /// Returns the number of parameters of each completion function of `parent` for `child`.
    #[must_use]
    pub fn completion_width(&self, parent: SubtaskId, child: SubtaskId) -> usize {
        let map = self.completion_map(parent, child);
        self.subtask(parent).blocks() * self.maps[map.index()].width()
    }

    /// Returns the number of features of a subtask's value functions (Thesis Table 4.6): those
    /// of its map, once for each block.
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
