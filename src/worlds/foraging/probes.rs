//! Typical inputs of the primitive subtasks: the abscissae of Thesis Figure 4.3.

use super::catalogue::{INPUTS, PROXIMITY_SENSORS};
use super::{ForagingWorld, TargetReading};
use crate::worlds::Probe;

/// Angles at which target-seeking subtasks are probed, on either side of zero.
const ANGLE_STEPS: i16 = 6;
/// A distance for subtasks that do not look at it, in millimetres.
const SOME_DISTANCE_MM: f32 = 1000.0;

/// Which sensors read their smallest value, in the scenario's order; the others read
/// their largest.
const BLOCKED: [(&str, [bool; PROXIMITY_SENSORS]); 6] = [
    ("open", [false; PROXIMITY_SENSORS]),
    ("wall left", [true, true, false, false, false]),
    ("wall right", [false, false, false, true, true]),
    ("wall ahead", [false, true, true, true, false]),
    ("wall left, ahead", [true, true, true, false, false]),
    ("wall right, ahead", [false, false, true, true, true]),
];

impl ForagingWorld {
    pub(super) fn angle_probes(&self) -> Vec<Probe<[f32; INPUTS]>> {
        let step = self.sensors.vision_half_angle_deg / f32::from(ANGLE_STEPS);
        let far = [self.sensors.proximity_range[1]; PROXIMITY_SENSORS];
        (-ANGLE_STEPS..=ANGLE_STEPS)
            .map(|index| {
                let angle_deg = f32::from(index) * step;
                let target = TargetReading {
                    angle_deg,
                    distance_mm: SOME_DISTANCE_MM,
                };
                Probe {
                    label: format!("{angle_deg:+.0} deg"),
                    readings: vec![(String::from("angle_deg"), f64::from(angle_deg))],
                    percept: self.inputs(&far, Some(target)),
                }
            })
            .collect()
    }

    /// Typical surroundings, with this reading of a target.
    pub(super) fn proximity_probes(
        &self,
        target: Option<TargetReading>,
    ) -> Vec<Probe<[f32; INPUTS]>> {
        let [near, far] = self.sensors.proximity_range;
        BLOCKED
            .iter()
            .map(|(label, blocked)| {
                let proximity_mm = blocked.map(|blocked| if blocked { near } else { far });
                let named = proximity_mm.iter().enumerate();
                Probe {
                    label: (*label).to_owned(),
                    readings: named
                        .map(|(i, &mm)| (format!("proximity_{}_mm", i + 1), f64::from(mm)))
                        .collect(),
                    percept: self.inputs(&proximity_mm, target),
                }
            })
            .collect()
    }
}
