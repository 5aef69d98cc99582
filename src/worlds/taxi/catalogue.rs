//! The subtasks of the taxi problem (Thesis Figures 2.7 and 3.1), and which parts of the state
//! their value functions depend on (Dietterich 2000, section 5).

use super::TaxiSettings;
use super::city::City;
use crate::worlds::builder::CatalogueBuilder;
use crate::worlds::{Blocks, Catalogue, FeatureKind, Index, MapId, StateType, SubtaskId};

numbered! {
    STATE_TYPES: StateType {
        WAITING = "passenger waits, taxi elsewhere",
        AT_PASSENGER = "passenger waits, taxi there",
        RIDING = "passenger in taxi, not at destination",
        AT_DESTINATION = "passenger in taxi, at destination",
        DELIVERED = "passenger delivered",
    }
}

numbered! {
    SUBTASKS: SubtaskId {
        ROOT = "Root",
        GET = "Get",
        PUT = "Put",
        NAVIGATE_TO_PASSENGER = "NavigateToPassenger",
        NAVIGATE_TO_DESTINATION = "NavigateToDestination",
        NORTH = "North",
        SOUTH = "South",
        EAST = "East",
        WEST = "West",
        PICKUP = "Pickup",
        PUTDOWN = "Putdown",
    }
}

numbered! {
    MAPS: MapId {
        STATE = "taxi x passenger x destination",
        WAY = "taxi x target",
        TARGET = "target",
        RIDE = "passenger x destination",
        PICKUP_LEGAL = "pickup legal",
        PUTDOWN_LEGAL = "putdown legal",
        NOTHING = "nothing",
    }
}

/// The moves, in the order of [`Direction::ALL`](crate::worlds::grid::Direction::ALL).
pub(super) const MOVES: [SubtaskId; 4] = [NORTH, SOUTH, EAST, WEST];
/// The primitive subtasks.
pub(super) const ACTIONS: [SubtaskId; 6] = [NORTH, SOUTH, EAST, WEST, PICKUP, PUTDOWN];

/// Number of inputs: cell of the taxi, place of the passenger, destination, target, whether
/// he can be picked up, whether he can be put down.
pub(super) const INPUTS: usize = 6;

/// Returns the number of places of a passenger.
pub(super) fn passenger_places(city: &City, settings: &TaxiSettings) -> usize {
    // The state also says whether he may yet change his mind, if he ever may.
    let fickle = usize::from(settings.change_of_mind > 0.0);
    city.stands.len() + 1 + fickle
}

pub(super) fn catalogue(city: &City, settings: &TaxiSettings) -> Catalogue {
    use {AT_DESTINATION as A, AT_PASSENGER as P, DELIVERED as D, RIDING as R, WAITING as W};
    let mut b = CatalogueBuilder::new(Blocks::One, STATE_TYPES, SUBTASKS.iter().copied(), MAPS);
    let abstraction = settings.state_abstraction;
    let map = |map| if abstraction { map } else { STATE };
    let all = [W, P, R, A];
    b.composite(ROOT, "solve the overall task", STATE, all, [D], 0);
    b.composite(GET, "pick the passenger up", map(WAY), [W, P], [R, A], 4);
    b.composite(PUT, "put the passenger down", map(WAY), [R, A], [D], 4);
    let purpose = "drive to the passenger: Navigate(source)";
    b.composite(NAVIGATE_TO_PASSENGER, purpose, map(WAY), [W], [P], 2);
    let purpose = "drive to the destination: Navigate(destination)";
    b.composite(NAVIGATE_TO_DESTINATION, purpose, map(WAY), [R], [A], 2);
    if abstraction {
        // Get and Navigate always end in the same state, and the reward still to come from
        // there depends on nothing else.
        b.abstraction(ROOT, GET, RIDE);
        b.abstraction(ROOT, PUT, TARGET);
        b.abstraction(GET, NAVIGATE_TO_PASSENGER, TARGET);
        b.abstraction(PUT, NAVIGATE_TO_DESTINATION, TARGET);
    }
    b.primitive(NORTH, "drive one cell north", map(NOTHING), all);
    b.primitive(SOUTH, "drive one cell south", map(NOTHING), all);
    b.primitive(EAST, "drive one cell east", map(NOTHING), all);
    b.primitive(WEST, "drive one cell west", map(NOTHING), all);
    b.primitive(PICKUP, "take the passenger on", map(PICKUP_LEGAL), all);
    b.primitive(PUTDOWN, "set the passenger down", map(PUTDOWN_LEGAL), all);
    add_maps(&mut b, city, settings);
    b.finish()
}

fn add_maps(b: &mut CatalogueBuilder, city: &City, settings: &TaxiSettings) {
    let index = |input, values| Index { input, values };
    let cell = index(0, city.cells.count());
    let passenger = index(1, passenger_places(city, settings));
    let destination = index(2, city.stands.len());
    let target = index(3, city.stands.len());
    for (map, indices) in [
        (STATE, vec![cell, passenger, destination]),
        (WAY, vec![cell, target]),
        (TARGET, vec![target]),
        (RIDE, vec![passenger, destination]),
        (PICKUP_LEGAL, vec![index(4, 2)]),
        (PUTDOWN_LEGAL, vec![index(5, 2)]),
        (NOTHING, Vec::new()),
    ] {
        b.map(map, FeatureKind::Table(indices));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_sizes_are_those_of_dietterich() {
        let settings = TaxiSettings::default();
        let city = City::read(&settings.map).unwrap();
        let catalogue = catalogue(&city, &settings);
        // 16 pairs of source and destination, and 4 destinations of a riding passenger.
        assert_eq!(catalogue.completion_width(ROOT, GET), 20);
        assert_eq!(catalogue.completion_width(GET, NAVIGATE_TO_PASSENGER), 4);
        assert_eq!(catalogue.completion_width(GET, PICKUP), 100);
        assert_eq!(catalogue.completion_width(PUT, NAVIGATE_TO_DESTINATION), 4);
        assert_eq!(catalogue.completion_width(PUT, PUTDOWN), 100);
        assert_eq!(
            catalogue.completion_width(NAVIGATE_TO_PASSENGER, NORTH),
            100
        );
        assert_eq!((catalogue.width(NORTH), catalogue.width(PICKUP)), (1, 2));
        assert_eq!(catalogue.completion_width(ROOT, NORTH), 500);
    }
}
