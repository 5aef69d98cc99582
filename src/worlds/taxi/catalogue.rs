//! The subtasks of the taxi problem (Thesis Figures 2.7 and 3.1) and what their value
//! functions look at (Dietterich 2000, section 5).

use super::TaxiSettings;
use super::city::City;
use crate::worlds::{
    Blocks, Catalogue, FeatureKind, FeatureMap, Index, Kind, MapId, StateType, StateTypeInfo,
    StateTypes, Subtask, SubtaskId,
};

/// The passenger waits, the taxi is elsewhere.
pub const WAITING: StateType = StateType(0);
/// The passenger waits, the taxi is there.
pub const AT_PASSENGER: StateType = StateType(1);
/// The passenger is in the taxi, which is not at his destination.
pub const RIDING: StateType = StateType(2);
/// The passenger is in the taxi at his destination.
pub const AT_DESTINATION: StateType = StateType(3);
/// The passenger is delivered.
pub const DELIVERED: StateType = StateType(4);

/// The composite subtask Get.
pub const GET: SubtaskId = SubtaskId(1);
/// The composite subtask Put.
pub const PUT: SubtaskId = SubtaskId(2);
/// The composite subtask Navigate(source).
pub const NAVIGATE_TO_PASSENGER: SubtaskId = SubtaskId(3);
/// The composite subtask Navigate(destination).
pub const NAVIGATE_TO_DESTINATION: SubtaskId = SubtaskId(4);
/// The primitive subtask North.
pub const NORTH: SubtaskId = SubtaskId(5);
/// The primitive subtask South.
pub const SOUTH: SubtaskId = SubtaskId(6);
/// The primitive subtask East.
pub const EAST: SubtaskId = SubtaskId(7);
/// The primitive subtask West.
pub const WEST: SubtaskId = SubtaskId(8);
/// The primitive subtask Pickup.
pub const PICKUP: SubtaskId = SubtaskId(9);
/// The primitive subtask Putdown.
pub const PUTDOWN: SubtaskId = SubtaskId(10);

/// Number of inputs: cell of the taxi, where the passenger is, destination, target,
/// whether he can be picked up, whether he can be put down.
pub(super) const INPUTS: usize = 6;

/// The whole state.
pub(super) const STATE: MapId = MapId(0);
/// Cell of the taxi and the stand to go to.
const WAY: MapId = MapId(1);
/// The stand to go to.
const TARGET: MapId = MapId(2);
/// Where the passenger is, and his destination.
const RIDE: MapId = MapId(3);
/// Whether he can be picked up.
const PICKUP_LEGAL: MapId = MapId(4);
/// Whether he can be put down.
const PUTDOWN_LEGAL: MapId = MapId(5);
/// Nothing: one value for all states.
const NOTHING: MapId = MapId(6);

/// The number of places where a passenger can be.
pub(super) fn passenger_places(city: &City, settings: &TaxiSettings) -> usize {
    // Whether he can still change his mind belongs to the state where he ever can.
    let fickle = usize::from(settings.change_of_mind > 0.0);
    city.stands.len() + 1 + fickle
}

pub(super) fn catalogue(city: &City, settings: &TaxiSettings) -> Catalogue {
    Catalogue {
        state_types: [
            "passenger waits, taxi elsewhere",
            "passenger waits, taxi there",
            "passenger in taxi, not at destination",
            "passenger in taxi, at destination",
        ]
        .map(|description| StateTypeInfo {
            description: String::from(description),
        })
        .into(),
        subtasks: composites(settings.state_abstraction)
            .into_iter()
            .chain(primitives(settings.state_abstraction))
            .collect(),
        maps: maps(city, settings),
    }
}

fn composites(abstraction: bool) -> [Subtask; 5] {
    use {AT_DESTINATION as A, AT_PASSENGER as P, DELIVERED as D, RIDING as R, WAITING as W};
    let composite =
        |name, purpose, active: &[StateType], goal: &[StateType], weight, map| Subtask {
            name: String::from(name),
            purpose: String::from(purpose),
            active: StateTypes::of(active),
            map: if abstraction { map } else { STATE },
            kind: Kind::Composite {
                goal: StateTypes::of(goal),
                weight,
                blocks: Blocks::One,
                abstractions: Vec::new(),
            },
        };
    let mut subtasks = [
        composite(
            "Root",
            "solve the overall task",
            &[W, P, R, A],
            &[D],
            0,
            STATE,
        ),
        composite("Get", "pick the passenger up", &[W, P], &[R, A], 4, WAY),
        composite("Put", "put the passenger down", &[R, A], &[D], 4, WAY),
        composite(
            "NavigateToPassenger",
            "drive to the passenger: Navigate(source)",
            &[W],
            &[P],
            2,
            WAY,
        ),
        composite(
            "NavigateToDestination",
            "drive to the destination: Navigate(destination)",
            &[R],
            &[A],
            2,
            WAY,
        ),
    ];
    if abstraction {
        // However Get and Navigate do it, they end in the same state, and what is left
        // to be done from there depends on nothing else.
        for (subtask, abstracted) in [
            (0, vec![(GET, RIDE), (PUT, TARGET)]),
            (1, vec![(NAVIGATE_TO_PASSENGER, TARGET)]),
            (2, vec![(NAVIGATE_TO_DESTINATION, TARGET)]),
        ] {
            if let Kind::Composite { abstractions, .. } = &mut subtasks[subtask].kind {
                *abstractions = abstracted;
            }
        }
    }
    subtasks
}

fn primitives(abstraction: bool) -> [Subtask; 6] {
    let primitive = |name: &str, purpose, map| Subtask {
        name: String::from(name),
        purpose: String::from(purpose),
        active: StateTypes::of(&[WAITING, AT_PASSENGER, RIDING, AT_DESTINATION]),
        map: if abstraction { map } else { STATE },
        kind: Kind::Primitive {
            actions: vec![name.to_lowercase()],
        },
    };
    [
        primitive("North", "drive one cell north", NOTHING),
        primitive("South", "drive one cell south", NOTHING),
        primitive("East", "drive one cell east", NOTHING),
        primitive("West", "drive one cell west", NOTHING),
        primitive("Pickup", "take the passenger on", PICKUP_LEGAL),
        primitive("Putdown", "set the passenger down", PUTDOWN_LEGAL),
    ]
}

fn maps(city: &City, settings: &TaxiSettings) -> Vec<FeatureMap> {
    let index = |input, values| Index { input, values };
    let cell = index(0, city.cells());
    let passenger = index(1, passenger_places(city, settings));
    let destination = index(2, city.stands.len());
    let target = index(3, city.stands.len());
    let table = |name, indices| FeatureMap {
        name: String::from(name),
        kind: FeatureKind::Table(indices),
    };
    vec![
        table(
            "taxi x passenger x destination",
            vec![cell, passenger, destination],
        ),
        table("taxi x target", vec![cell, target]),
        table("target", vec![target]),
        table("passenger x destination", vec![passenger, destination]),
        table("pickup legal", vec![index(4, 2)]),
        table("putdown legal", vec![index(5, 2)]),
        table("nothing", Vec::new()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_values_are_those_of_dietterichs_abstraction() {
        let settings = TaxiSettings::default();
        let city = City::read(&settings.map).unwrap();
        let catalogue = catalogue(&city, &settings);
        let id = |name| catalogue.find(name).unwrap();
        for (name, expected) in [
            ("Get", GET),
            ("Put", PUT),
            ("NavigateToPassenger", NAVIGATE_TO_PASSENGER),
            ("NavigateToDestination", NAVIGATE_TO_DESTINATION),
            ("North", NORTH),
            ("South", SOUTH),
            ("East", EAST),
            ("West", WEST),
            ("Pickup", PICKUP),
            ("Putdown", PUTDOWN),
        ] {
            assert_eq!(id(name), expected);
        }
        // Sources and destinations; the passenger's place of the riding adds to the 16.
        assert_eq!(catalogue.completion_width(id("Root"), GET), 20);
        assert_eq!(catalogue.completion_width(GET, NAVIGATE_TO_PASSENGER), 4);
        assert_eq!(catalogue.completion_width(GET, PICKUP), 100);
        assert_eq!(catalogue.completion_width(PUT, NAVIGATE_TO_DESTINATION), 4);
        assert_eq!(catalogue.completion_width(PUT, PUTDOWN), 100);
        assert_eq!(
            catalogue.completion_width(NAVIGATE_TO_PASSENGER, NORTH),
            100
        );
        assert_eq!((catalogue.width(NORTH), catalogue.width(PICKUP)), (1, 2));
        assert_eq!(catalogue.completion_width(SubtaskId::ROOT, NORTH), 500);
    }
}
