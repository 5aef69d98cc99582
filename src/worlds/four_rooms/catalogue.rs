//! The subtasks of four rooms: the ways from a room to its hallways, and to the goal.

use super::house::{CELLS, Place};
use crate::worlds::builder::CatalogueBuilder;
use crate::worlds::grid::add_moves;
use crate::worlds::{
    Blocks, Catalogue, FeatureKind, Index, MapId, StateType, StateTypes, SubtaskId,
};

numbered! {
    STATE_TYPES: StateType {
        _ = "in the north-western room",
        _ = "in the north-eastern room",
        _ = "in the south-western room",
        _ = "in the south-eastern room",
        _ = "in the northern hallway",
        _ = "in the western hallway",
        _ = "in the eastern hallway",
        _ = "in the southern hallway",
        AT_GOAL = "at the goal",
    }
}

numbered! {
    SUBTASKS: SubtaskId {
        ROOT = "Root",
        _ = "NorthWestToNorth",
        _ = "NorthWestToWest",
        _ = "NorthEastToNorth",
        _ = "NorthEastToEast",
        _ = "SouthWestToWest",
        _ = "SouthWestToSouth",
        _ = "SouthEastToEast",
        _ = "SouthEastToSouth",
        TO_GOAL = "ToGoal",
        UP = "Up",
        DOWN = "Down",
        RIGHT = "Right",
        LEFT = "Left",
    }
}

numbered! { MAPS: MapId { CELL = "cell", } }

/// The primitive subtasks.
pub(super) const ACTIONS: [SubtaskId; 4] = [UP, DOWN, RIGHT, LEFT];

/// Number of inputs: the cell.
pub(super) const INPUTS: usize = 1;

/// Every composite subtask with every action.
pub(super) const HAND_MADE: &str = "(Root (NorthWestToNorth Up Down Right Left) \
     (NorthWestToWest Up Down Right Left) (NorthEastToNorth Up Down Right Left) \
     (NorthEastToEast Up Down Right Left) (SouthWestToWest Up Down Right Left) \
     (SouthWestToSouth Up Down Right Left) (SouthEastToEast Up Down Right Left) \
     (SouthEastToSouth Up Down Right Left) (ToGoal Up Down Right Left))";

/// The catalogue of a house whose goal lies in the given place. If that is a hallway, the goal
/// is its only cell, and no state has the hallway's type.
pub(super) fn catalogue(goal: Place) -> Catalogue {
    let mut builder =
        CatalogueBuilder::new(Blocks::One, STATE_TYPES, SUBTASKS.iter().copied(), MAPS);
    let all = types(Place::ALL);
    builder.composite(ROOT, "walk to the goal", CELL, all, [AT_GOAL], 0);
    let rooms = Place::ALL.into_iter().take(4);
    let ways = rooms.flat_map(|room| room.neighbours().map(|hallway| (room, hallway)));
    for (id, (room, hallway)) in (1..).map(SubtaskId).zip(ways) {
        let [from, to] = [room, hallway].map(|place| STATE_TYPES[place as usize]);
        let [from, to] = [from, to].map(|place| place.trim_start_matches("in "));
        let others = room.neighbours().into_iter().filter(|&own| own != hallway);
        let reached = if hallway == goal {
            AT_GOAL
        } else {
            hallway.state_type()
        };
        let active = types(others.chain([room]));
        let purpose = format!("walk from {from} to {to}");
        builder.composite(id, &purpose, CELL, active, [reached], 2);
    }
    let around = types(goal.neighbours().into_iter().chain([goal]));
    let last = "walk to the goal from around it";
    builder.composite(TO_GOAL, last, CELL, around, [AT_GOAL], 2);
    add_moves(&mut builder, ACTIONS, CELL, all);
    let values = CELLS;
    builder.map(CELL, FeatureKind::Table(vec![Index { input: 0, values }]));
    builder.finish()
}

fn types(places: impl IntoIterator<Item = Place>) -> StateTypes {
    let types = places.into_iter().map(Place::state_type);
    StateTypes::of(&types.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_has_the_name_of_its_two_places() {
        let catalogue = catalogue(Place::East);
        let east = catalogue.find("SouthEastToEast").unwrap();
        let purpose = "walk from the south-eastern room to the eastern hallway";
        assert_eq!(catalogue.subtask(east).purpose, purpose);
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
