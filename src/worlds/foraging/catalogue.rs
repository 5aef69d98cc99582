//! The subtasks of the foraging task (Thesis Tables 4.1 to 4.3 and 4.6).

use super::defaults::COMMANDS;
use super::{FeatureSettings, ForagingSettings, RbfWidth};
use crate::worlds::builder::CatalogueBuilder;
use crate::worlds::{Axis, Blocks, Catalogue, FeatureKind, Imitation, MapId, StateType, SubtaskId};

numbered! {
    STATE_TYPES: StateType {
        SEARCHING = "empty-handed, no battery visible",
        BATTERY_VISIBLE = "empty-handed, a battery visible",
        CARRYING = "carrying, nest not visible",
        NEST_VISIBLE = "carrying, nest visible",
        DELIVERED = "battery delivered",
    }
}

numbered! {
    SUBTASKS: SubtaskId {
        ROOT = "Root",
        CAPTURE = "Capture",
        DELIVER = "Deliver",
        FIND_BATTERY = "FindBattery",
        VISIBLE_BATTERY = "VisibleBattery",
        FIND_NEST = "FindNest",
        VISIBLE_NEST = "VisibleNest",
        AVOID = "Avoid",
        WANDER = "Wander",
        APPROACH_BATTERY = "ApproachBattery",
        APPROACH_NEST = "ApproachNest",
        TURN = "Turn",
    }
}

numbered! {
    MAPS: MapId {
        PROXIMITY_MAP = "proximity",
        TARGET_MAP = "angle x distance x proximity",
        APPROACH_MAP = "angle, to approach",
        TURN_MAP = "angle, to turn",
        NOTHING_MAP = "nothing",
    }
}

/// Number of proximity sensors; they are the first inputs.
pub const PROXIMITY_SENSORS: usize = 5;
/// Input: angle to the target.
pub const ANGLE: usize = PROXIMITY_SENSORS;
/// Input: distance to the target.
pub const DISTANCE: usize = PROXIMITY_SENSORS + 1;
/// Input: whether the robot remembers the place that its task needs.
pub const REMEMBERS: usize = PROXIMITY_SENSORS + 2;
/// Number of inputs.
pub const INPUTS: usize = PROXIMITY_SENSORS + 3;

/// The subtask that goes to a remembered place.
const RECALL: &str = "Recall";

/// The catalogue of the foraging task with the scenario's actions and features.
pub(super) fn catalogue(settings: &ForagingSettings) -> Catalogue {
    use {BATTERY_VISIBLE as B, CARRYING as C, DELIVERED as D, NEST_VISIBLE as N, SEARCHING as S};
    use {PROXIMITY_MAP as P, TARGET_MAP as T};
    let commands = COMMANDS.iter().filter(|_| settings.commands);
    let names = SUBTASKS.iter().copied();
    let names = names.chain(commands.clone().map(|(name, _)| *name));
    let names = names.chain(settings.memory.iter().map(|_| RECALL));
    let mut b = CatalogueBuilder::new(Blocks::PerStateType, STATE_TYPES, names, MAPS);
    let all = [S, B, C, N];
    b.composite(ROOT, "solve the overall task", P, all, [D], 0);
    let purpose = "find, approach and capture a battery";
    b.composite(CAPTURE, purpose, P, [S, B], [C, N, D], 4);
    let purpose = "find the nest and deliver a battery";
    b.composite(DELIVER, purpose, P, [C, N], [D], 4);
    b.composite(FIND_BATTERY, "find a battery", P, [S], [B, C, N, D], 2);
    let purpose = "approach and capture a visible battery";
    b.composite(VISIBLE_BATTERY, purpose, T, [B], [C, N, D], 2);
    b.composite(FIND_NEST, "find the nest", P, [C], [N, D], 2);
    let purpose = "deliver a battery to the visible nest";
    b.composite(VISIBLE_NEST, purpose, T, [N], [D], 2);
    b.primitive(AVOID, "avoid hitting walls", P, all);
    b.primitive(WANDER, "explore the environment", P, all);
    let purpose = "approach and capture a battery";
    b.primitive(APPROACH_BATTERY, purpose, APPROACH_MAP, [B]);
    let purpose = "deliver the battery to the nest";
    b.primitive(APPROACH_NEST, purpose, APPROACH_MAP, [N]);
    let purpose = "rotate to a battery or the nest";
    b.primitive(TURN, purpose, TURN_MAP, [B, N]);
    let p = &settings.primitives;
    for (primitive, actions) in [
        (AVOID, &p.avoid.actions_mm_per_s),
        (WANDER, &p.wander.actions_mm_per_s),
        (APPROACH_BATTERY, &p.approach_battery.actions_mm_per_s),
        (APPROACH_NEST, &p.approach_nest.actions_mm_per_s),
        (TURN, &p.turn.actions_mm_per_s),
    ] {
        b.actions(primitive, actions.iter().map(in_words).collect());
    }
    let mut next = SubtaskId(SUBTASKS.len() as u8);
    for (_, speeds) in commands {
        b.primitive(next, "give one command to the wheels", NOTHING_MAP, all);
        b.actions(next, vec![in_words(speeds)]);
        next.0 += 1;
    }
    if settings.memory.is_some() {
        add_memory(&mut b, next);
    }
    add_maps(&mut b, &settings.features);
    b.finish()
}

/// Adds the memory of the robot: the subtask Recall, and blocks of features for the composite
/// subtasks that do not see their target.
fn add_memory(b: &mut CatalogueBuilder, recall: SubtaskId) {
    b.memory(REMEMBERS);
    let purpose = "go to the remembered battery or nest";
    b.primitive(recall, purpose, NOTHING_MAP, [SEARCHING, CARRYING]);
    let with_memory = vec![(SEARCHING, APPROACH_BATTERY), (CARRYING, APPROACH_NEST)];
    b.imitation(
        recall,
        Imitation {
            with_memory,
            otherwise: WANDER,
        },
    );
    for composite in [ROOT, CAPTURE, DELIVER, FIND_BATTERY, FIND_NEST] {
        b.blocks(composite, Blocks::PerStateTypeAndMemory);
    }
}

fn in_words([right, left]: &[f64; 2]) -> String {
    format!("({right},{left})")
}

fn add_maps(b: &mut CatalogueBuilder, features: &FeatureSettings) {
    let axis = |input, centres| Axis {
        input,
        centres,
        sigma: sigma(features.rbf_width, centres),
    };
    let proximity = (0..PROXIMITY_SENSORS).map(|sensor| axis(sensor, features.proximity_centres));
    let angle = axis(ANGLE, features.angle_centres);
    let distance = axis(DISTANCE, features.distance_centres);
    for (map, axes) in [
        (PROXIMITY_MAP, proximity.clone().collect()),
        (
            TARGET_MAP,
            [angle, distance].into_iter().chain(proximity).collect(),
        ),
        (APPROACH_MAP, vec![axis(ANGLE, features.approach_centres)]),
        (TURN_MAP, vec![axis(ANGLE, features.turn_centres)]),
    ] {
        b.map(map, FeatureKind::Gaussian(axes));
    }
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
    }
}
