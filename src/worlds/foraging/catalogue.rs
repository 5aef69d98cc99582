//! The subtasks of the foraging task (Thesis Tables 4.1 to 4.3 and 4.6).

use super::{FeatureSettings, ForagingSettings, RbfWidth};
use crate::worlds::{
    Axis, Blocks, Catalogue, FeatureKind, FeatureMap, Kind, MapId, StateType, StateTypeInfo,
    StateTypes, Subtask, SubtaskId,
};

/// Empty-handed, no battery visible.
pub const SEARCHING: StateType = StateType(0);
/// Empty-handed, a battery visible.
pub const BATTERY_VISIBLE: StateType = StateType(1);
/// Carrying a battery, the nest not visible.
pub const CARRYING: StateType = StateType(2);
/// Carrying a battery, the nest visible.
pub const NEST_VISIBLE: StateType = StateType(3);
/// The battery is delivered.
pub const DELIVERED: StateType = StateType(4);

/// The primitive subtask Avoid.
pub const AVOID: SubtaskId = SubtaskId(7);
/// The primitive subtask Wander.
pub const WANDER: SubtaskId = SubtaskId(8);
/// The primitive subtask Approach battery.
pub const APPROACH_BATTERY: SubtaskId = SubtaskId(9);
/// The primitive subtask Approach nest.
pub const APPROACH_NEST: SubtaskId = SubtaskId(10);
/// The primitive subtask Turn.
pub const TURN: SubtaskId = SubtaskId(11);

/// Number of proximity sensors; they are the first inputs.
pub const PROXIMITY_SENSORS: usize = 5;
/// Input: angle to the target.
pub const ANGLE: usize = PROXIMITY_SENSORS;
/// Input: distance to the target.
pub const DISTANCE: usize = PROXIMITY_SENSORS + 1;
/// Number of inputs.
pub const INPUTS: usize = PROXIMITY_SENSORS + 2;

const PROXIMITY_MAP: MapId = MapId(0);
const TARGET_MAP: MapId = MapId(1);
const APPROACH_MAP: MapId = MapId(2);
const TURN_MAP: MapId = MapId(3);

/// The catalogue of the foraging task with the scenario's actions and features.
pub(super) fn catalogue(settings: &ForagingSettings) -> Catalogue {
    Catalogue {
        state_types: state_types(),
        subtasks: subtasks(settings),
        maps: maps(&settings.features),
    }
}

fn state_types() -> Vec<StateTypeInfo> {
    [
        "empty-handed, no battery visible",
        "empty-handed, a battery visible",
        "carrying, nest not visible",
        "carrying, nest visible",
    ]
    .map(|description| StateTypeInfo {
        description: String::from(description),
    })
    .into()
}

fn subtasks(settings: &ForagingSettings) -> Vec<Subtask> {
    use {BATTERY_VISIBLE as B, CARRYING as C, DELIVERED as D, NEST_VISIBLE as N, SEARCHING as S};
    let composite =
        |name, purpose, active: &[StateType], map, goal: &[StateType], weight| Subtask {
            name: String::from(name),
            purpose: String::from(purpose),
            active: StateTypes::of(active),
            map,
            kind: Kind::Composite {
                goal: StateTypes::of(goal),
                weight,
                blocks: Blocks::PerStateType,
                abstractions: Vec::new(),
            },
        };
    let primitive = |name, purpose, active: &[StateType], map, actions: &[[f64; 2]]| Subtask {
        name: String::from(name),
        purpose: String::from(purpose),
        active: StateTypes::of(active),
        map,
        kind: Kind::Primitive {
            actions: actions
                .iter()
                .map(|[right, left]| format!("({right},{left})"))
                .collect(),
        },
    };
    let p = &settings.primitives;
    vec![
        composite(
            "Root",
            "solve the overall task",
            &[S, B, C, N],
            PROXIMITY_MAP,
            &[D],
            0,
        ),
        composite(
            "Capture",
            "find, approach and capture a battery",
            &[S, B],
            PROXIMITY_MAP,
            &[C, N, D],
            4,
        ),
        composite(
            "Deliver",
            "find the nest and deliver a battery",
            &[C, N],
            PROXIMITY_MAP,
            &[D],
            4,
        ),
        composite(
            "FindBattery",
            "find a battery",
            &[S],
            PROXIMITY_MAP,
            &[B, C, N, D],
            2,
        ),
        composite(
            "VisibleBattery",
            "approach and capture a visible battery",
            &[B],
            TARGET_MAP,
            &[C, N, D],
            2,
        ),
        composite("FindNest", "find the nest", &[C], PROXIMITY_MAP, &[N, D], 2),
        composite(
            "VisibleNest",
            "deliver a battery to the visible nest",
            &[N],
            TARGET_MAP,
            &[D],
            2,
        ),
        primitive(
            "Avoid",
            "avoid hitting walls",
            &[S, B, C, N],
            PROXIMITY_MAP,
            &p.avoid.actions_mm_per_s,
        ),
        primitive(
            "Wander",
            "explore the environment",
            &[S, B, C, N],
            PROXIMITY_MAP,
            &p.wander.actions_mm_per_s,
        ),
        primitive(
            "ApproachBattery",
            "approach and capture a battery",
            &[B],
            APPROACH_MAP,
            &p.approach_battery.actions_mm_per_s,
        ),
        primitive(
            "ApproachNest",
            "deliver the battery to the nest",
            &[N],
            APPROACH_MAP,
            &p.approach_nest.actions_mm_per_s,
        ),
        primitive(
            "Turn",
            "rotate to a battery or the nest",
            &[B, N],
            TURN_MAP,
            &p.turn.actions_mm_per_s,
        ),
    ]
}

fn maps(features: &FeatureSettings) -> Vec<FeatureMap> {
    let axis = |input, centres| Axis {
        input,
        centres,
        sigma: sigma(features.rbf_width, centres),
    };
    let proximity = (0..PROXIMITY_SENSORS).map(|sensor| axis(sensor, features.proximity_centres));
    let angle = axis(ANGLE, features.angle_centres);
    let distance = axis(DISTANCE, features.distance_centres);
    vec![
        FeatureMap {
            name: String::from("proximity"),
            kind: FeatureKind::Gaussian(proximity.clone().collect()),
        },
        FeatureMap {
            name: String::from("angle x distance x proximity"),
            kind: FeatureKind::Gaussian([angle, distance].into_iter().chain(proximity).collect()),
        },
        FeatureMap {
            name: String::from("angle"),
            kind: FeatureKind::Gaussian(vec![axis(ANGLE, features.approach_centres)]),
        },
        FeatureMap {
            name: String::from("angle"),
            kind: FeatureKind::Gaussian(vec![axis(ANGLE, features.turn_centres)]),
        },
    ]
}

/// Width of Gaussians whose `centres` stand equidistantly from 0 to 1 (Thesis 4.4).
fn sigma(width: RbfWidth, centres: usize) -> f64 {
    let spacing = 1.0 / (centres - 1) as f64;
    match width {
        RbfWidth::Spacing => std::f64::consts::SQRT_2 * spacing,
        RbfWidth::Variance => (std::f64::consts::SQRT_2 * spacing).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worlds::foraging::settings::tests::environment;

    #[test]
    fn numbers_of_features_are_those_of_table_4_6() {
        let catalogue = catalogue(&environment(1));
        let width = |name| catalogue.width(catalogue.find(name).unwrap());
        assert_eq!(width("Root"), 128);
        assert_eq!((width("Capture"), width("Deliver")), (64, 64));
        assert_eq!((width("FindBattery"), width("FindNest")), (32, 32));
        assert_eq!((width("VisibleBattery"), width("VisibleNest")), (320, 320));
        assert_eq!((width("Avoid"), width("Wander")), (32, 32));
        assert_eq!((width("ApproachBattery"), width("ApproachNest")), (11, 11));
        assert_eq!(width("Turn"), 7);
        for (id, name) in [
            (AVOID, "Avoid"),
            (WANDER, "Wander"),
            (APPROACH_BATTERY, "ApproachBattery"),
            (APPROACH_NEST, "ApproachNest"),
            (TURN, "Turn"),
        ] {
            assert_eq!(catalogue.subtask(id).name, name);
        }
    }
}
