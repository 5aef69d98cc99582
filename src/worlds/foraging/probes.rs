//! Inputs for which learned values are shown: the abscissae of Thesis Figure 4.3, and others.

use super::catalogue::{INPUTS, PROXIMITY_SENSORS};
use super::{BATTERY_VISIBLE, ForagingWorld, NEST_VISIBLE, TargetReading};
use crate::worlds::scene::{Scale, Sweep};
use crate::worlds::{Probe, StateType};

/// Number of probed angles on either side of zero.
const ANGLE_STEPS: i16 = 6;
/// A distance in millimetres, where values do not depend on it or it is not varied.
const SOME_DISTANCE_MM: f32 = 1000.0;
/// Numbers of angles and distances of a sweep.
const ANGLES: usize = 25;
const DISTANCES: usize = 8;

/// Typical surroundings: which sensors, in the scenario's order, read their smallest value. The
/// others read their largest.
const BLOCKED: [(&str, [bool; PROXIMITY_SENSORS]); 6] = [
    ("open", [false; PROXIMITY_SENSORS]),
    ("wall left", [true, true, false, false, false]),
    ("wall right", [false, false, false, true, true]),
    ("wall ahead", [false, true, true, true, false]),
    ("wall left, ahead", [true, true, true, false, false]),
    ("wall right, ahead", [false, false, true, true, true]),
];

impl ForagingWorld {
    /// Returns targets at several angles, in the open.
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

    /// Returns typical surroundings with this reading of a target.
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

    /// Returns typical surroundings, with a target straight ahead in states that see one.
    pub(super) fn pattern_sweep(&self, state_type: StateType) -> Sweep<[f32; INPUTS]> {
        let ahead = TargetReading {
            angle_deg: 0.0,
            distance_mm: SOME_DISTANCE_MM,
        };
        let sees_target = matches!(state_type, BATTERY_VISIBLE | NEST_VISIBLE);
        let probes = self.proximity_probes(sees_target.then_some(ahead));
        Sweep {
            across: Scale::Cases {
                name: String::from("surroundings"),
                labels: probes.iter().map(|probe| probe.label.clone()).collect(),
            },
            down: None,
            probes,
        }
    }

    /// Returns targets at many angles, in the open.
    pub(super) fn angle_sweep(&self) -> Sweep<[f32; INPUTS]> {
        let angles = self.angles();
        let probes = angles
            .iter()
            .map(|&angle| self.target_probe(angle, SOME_DISTANCE_MM));
        Sweep {
            probes: probes.collect(),
            across: scale("angle_deg", &angles),
            down: None,
        }
    }

    /// Returns targets at several angles and distances, in the open.
    pub(super) fn target_sweep(&self) -> Sweep<[f32; INPUTS]> {
        let angles = self.angles();
        let step = self.sensors.vision_range as f32 / DISTANCES as f32;
        let distances: Vec<_> = (1..=DISTANCES).map(|i| i as f32 * step).collect();
        let row = |&distance: &f32| {
            let probe = move |&angle: &f32| self.target_probe(angle, distance);
            angles.iter().map(probe).collect::<Vec<_>>()
        };
        Sweep {
            probes: distances.iter().flat_map(row).collect(),
            across: scale("angle_deg", &angles),
            down: Some(scale("distance_mm", &distances)),
        }
    }

    fn angles(&self) -> Vec<f32> {
        let half = self.sensors.vision_half_angle_deg;
        let step = 2.0 * half / (ANGLES - 1) as f32;
        (0..ANGLES).map(|i| i as f32 * step - half).collect()
    }

    fn target_probe(&self, angle_deg: f32, distance_mm: f32) -> Probe<[f32; INPUTS]> {
        let far = [self.sensors.proximity_range[1]; PROXIMITY_SENSORS];
        let target = TargetReading {
            angle_deg,
            distance_mm,
        };
        Probe {
            label: format!("{angle_deg:+.0} deg, {distance_mm:.0} mm"),
            readings: vec![
                (String::from("angle_deg"), f64::from(angle_deg)),
                (String::from("distance_mm"), f64::from(distance_mm)),
            ],
            percept: self.inputs(&far, Some(target)),
        }
    }
}

fn scale(name: &str, values: &[f32]) -> Scale {
    Scale::Quantity {
        name: name.to_owned(),
        values: values.iter().copied().map(f64::from).collect(),
    }
}
