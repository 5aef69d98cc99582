//! The subtasks of four rooms: the ways from a room to its hallways, and to the goal.

use super::house::{CELLS, Place};
use crate::worlds::{
    Blocks, Catalogue, FeatureKind, FeatureMap, Index, Kind, MapId, StateType, StateTypeInfo,
    StateTypes, Subtask, SubtaskId,
};

/// At the goal.
pub const AT_GOAL: StateType = StateType(8);

/// The primitive subtask Up.
pub const UP: SubtaskId = SubtaskId(10);
/// The primitive subtask Down.
pub const DOWN: SubtaskId = SubtaskId(11);
/// The primitive subtask Right.
pub const RIGHT: SubtaskId = SubtaskId(12);
/// The primitive subtask Left.
pub const LEFT: SubtaskId = SubtaskId(13);

/// Number of inputs: the cell.
pub(super) const INPUTS: usize = 1;

/// The cell.
pub(super) const CELL: MapId = MapId(0);

/// Every way, with every action.
pub(super) const HAND_MADE: &str = "(Root (NorthWestToNorth Up Down Right Left) \
     (NorthWestToWest Up Down Right Left) (NorthEastToNorth Up Down Right Left) \
     (NorthEastToEast Up Down Right Left) (SouthWestToWest Up Down Right Left) \
     (SouthWestToSouth Up Down Right Left) (SouthEastToEast Up Down Right Left) \
     (SouthEastToSouth Up Down Right Left) (ToGoal Up Down Right Left))";

/// The ways from a room to one of its hallways.
const WAYS: [(&str, &str, Place, Place); 8] = {
    use Place::{East, North, NorthEast, NorthWest, South, SouthEast, SouthWest, West};
    [
        (
            "NorthWestToNorth",
            "walk from the north-western room to the northern hallway",
            NorthWest,
            North,
        ),
        (
            "NorthWestToWest",
            "walk from the north-western room to the western hallway",
            NorthWest,
            West,
        ),
        (
            "NorthEastToNorth",
            "walk from the north-eastern room to the northern hallway",
            NorthEast,
            North,
        ),
        (
            "NorthEastToEast",
            "walk from the north-eastern room to the eastern hallway",
            NorthEast,
            East,
        ),
        (
            "SouthWestToWest",
            "walk from the south-western room to the western hallway",
            SouthWest,
            West,
        ),
        (
            "SouthWestToSouth",
            "walk from the south-western room to the southern hallway",
            SouthWest,
            South,
        ),
        (
            "SouthEastToEast",
            "walk from the south-eastern room to the eastern hallway",
            SouthEast,
            East,
        ),
        (
            "SouthEastToSouth",
            "walk from the south-eastern room to the southern hallway",
            SouthEast,
            South,
        ),
    ]
};

/// The catalogue of a house with its goal in the place given: if that is a hallway, whose
/// only cell the goal is, nobody is ever in a state of its type.
pub(super) fn catalogue(goal: Place) -> Catalogue {
    Catalogue {
        state_types: [
            "in the north-western room",
            "in the north-eastern room",
            "in the south-western room",
            "in the south-eastern room",
            "in the northern hallway",
            "in the western hallway",
            "in the eastern hallway",
            "in the southern hallway",
        ]
        .map(|description| StateTypeInfo {
            description: String::from(description),
        })
        .into(),
        subtasks: composites(goal).chain(primitives()).collect(),
        maps: vec![FeatureMap {
            name: String::from("cell"),
            kind: FeatureKind::Table(vec![Index {
                input: 0,
                values: CELLS,
            }]),
        }],
    }
}

fn types(places: impl IntoIterator<Item = Place>) -> StateTypes {
    let types = places.into_iter().map(Place::state_type);
    StateTypes::of(&types.collect::<Vec<_>>())
}

fn composites(goal: Place) -> impl Iterator<Item = Subtask> {
    let composite = |name, purpose, active, goal, weight| Subtask {
        name: String::from(name),
        purpose: String::from(purpose),
        active,
        map: CELL,
        kind: Kind::Composite {
            goal,
            weight,
            blocks: Blocks::One,
            abstractions: Vec::new(),
        },
    };
    let end = StateTypes::of(&[AT_GOAL]);
    let ways = WAYS.into_iter().map(move |(name, purpose, room, hallway)| {
        let others = room.neighbours().into_iter().filter(|&own| own != hallway);
        let reached = match hallway == goal {
            true => end,
            false => types([hallway]),
        };
        composite(name, purpose, types(others.chain([room])), reached, 2)
    });
    let around = types(goal.neighbours().into_iter().chain([goal]));
    let root = composite("Root", "walk to the goal", types(Place::ALL), end, 0);
    let last = composite("ToGoal", "walk to the goal from around it", around, end, 2);
    std::iter::once(root).chain(ways).chain([last])
}

fn primitives() -> [Subtask; 4] {
    let primitive = |name: &str, purpose| Subtask {
        name: String::from(name),
        purpose: String::from(purpose),
        active: types(Place::ALL),
        map: CELL,
        kind: Kind::Primitive {
            actions: vec![name.to_lowercase()],
        },
    };
    [
        primitive("Up", "walk one cell up"),
        primitive("Down", "walk one cell down"),
        primitive("Right", "walk one cell to the right"),
        primitive("Left", "walk one cell to the left"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_subtasks_are_those_of_their_names() {
        let catalogue = catalogue(Place::East);
        for (name, id) in [("Up", UP), ("Down", DOWN), ("Right", RIGHT), ("Left", LEFT)] {
            assert_eq!(catalogue.find(name), Some(id));
        }
        assert_eq!(catalogue.terminal(), AT_GOAL);
    }

    #[test]
    fn a_hallway_that_is_the_goal_is_the_end_of_the_ways_to_it() {
        let subtask = |goal, name| {
            let catalogue = catalogue(goal);
            catalogue.subtask(catalogue.find(name).unwrap()).clone()
        };
        let (at_goal, east) = (StateTypes::of(&[AT_GOAL]), types([Place::East]));
        assert_eq!(subtask(Place::East, "NorthEastToEast").goal(), at_goal);
        assert_eq!(subtask(Place::SouthEast, "NorthEastToEast").goal(), east);
        let active = subtask(Place::SouthEast, "ToGoal").active;
        assert_eq!(active, types([Place::SouthEast, Place::East, Place::South]));
    }
}
