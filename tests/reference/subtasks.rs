//! A second copy of Thesis Tables 4.1 to 4.3 and 4.6, with the commands and Recall, and of Eq. 2.22.

use maxq_lab::worlds::foraging::{FeatureSettings, RbfWidth};

/// The terminal state type, after the four of Table 4.1 numbered from 1.
pub const DELIVERED: usize = 5;
/// Inputs of a percept: five proximity sensors, the angle, the distance.
const PROXIMITY: [usize; 5] = [0, 1, 2, 3, 4];
const ANGLE: usize = 5;
const DISTANCE: usize = 6;
/// The input after these: whether the robot remembers the place that its task needs.
pub const REMEMBERS: usize = 7;

/// The inputs of a subtask's value functions (Table 4.6).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// The proximity sensors.
    Proximity,
    /// Angle, distance and proximity sensors.
    Target,
    /// The angle, for Approach battery and Approach nest.
    Approach,
    /// The angle, for Turn.
    Turn,
    /// None, for commands and Recall.
    Nothing,
}

/// What a subtask is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A composite subtask. With memory one that `recalls` tells states with and without a
    /// remembered place apart.
    Composite { recalls: bool },
    /// A primitive subtask of Table 4.3.
    Behaviour,
    /// A primitive subtask of one command, which is worth nothing itself.
    Command,
    /// The primitive subtask that acts as another one does.
    Recall,
}

/// A row of Table 4.2 or 4.3.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The state types it is active in.
    pub active: &'static [usize],
    /// The state types that are its goal; none for a primitive subtask.
    pub goal: &'static [usize],
    /// The inputs of its value functions.
    pub input: Input,
    /// What it is.
    pub kind: Kind,
}

impl Row {
    /// Whether the subtask is primitive.
    pub fn is_primitive(&self) -> bool {
        !matches!(self.kind, Kind::Composite { .. })
    }
}

/// The row of a subtask.
pub fn row(name: &str) -> Row {
    let composite = |active, goal, input| Row {
        active,
        goal,
        input,
        kind: Kind::Composite {
            recalls: input == Input::Proximity,
        },
    };
    let primitive = |active, input, kind| Row {
        active,
        goal: &[],
        input,
        kind,
    };
    let behaviour = |active, input| primitive(active, input, Kind::Behaviour);
    match name {
        "Root" => composite(&[1, 2, 3, 4], &[DELIVERED], Input::Proximity),
        "Capture" => composite(&[1, 2], &[3, 4, DELIVERED], Input::Proximity),
        "Deliver" => composite(&[3, 4], &[DELIVERED], Input::Proximity),
        "FindBattery" => composite(&[1], &[2, 3, 4, DELIVERED], Input::Proximity),
        "VisibleBattery" => composite(&[2], &[3, 4, DELIVERED], Input::Target),
        "FindNest" => composite(&[3], &[4, DELIVERED], Input::Proximity),
        "VisibleNest" => composite(&[4], &[DELIVERED], Input::Target),
        "Avoid" | "Wander" => behaviour(&[1, 2, 3, 4], Input::Proximity),
        "ApproachBattery" => behaviour(&[2], Input::Approach),
        "ApproachNest" => behaviour(&[4], Input::Approach),
        "Turn" => behaviour(&[2, 4], Input::Turn),
        "Forward" | "Left" | "Right" | "HardLeft" | "HardRight" | "SpinLeft" | "SpinRight"
        | "Back" => primitive(&[1, 2, 3, 4], Input::Nothing, Kind::Command),
        "Recall" => primitive(&[1, 3], Input::Nothing, Kind::Recall),
        other => panic!("{other} is in no table"),
    }
}

/// Eq. 2.22 on the full grid: one exponential for each centre, divided by their sum. The last
/// input of the grid varies fastest.
pub fn phi(input: Input, percept: &[f32], model: &FeatureSettings) -> Vec<f64> {
    let proximity = PROXIMITY.map(|sensor| (sensor, model.proximity_centres));
    let axes: Vec<(usize, usize)> = match input {
        Input::Proximity => proximity.to_vec(),
        Input::Target => [
            (ANGLE, model.angle_centres),
            (DISTANCE, model.distance_centres),
        ]
        .into_iter()
        .chain(proximity)
        .collect(),
        Input::Approach => vec![(ANGLE, model.approach_centres)],
        Input::Turn => vec![(ANGLE, model.turn_centres)],
        Input::Nothing => Vec::new(),
    };
    let centres: usize = axes.iter().map(|(_, centres)| centres).product();
    let gaussians: Vec<f64> = (0..centres)
        .map(|centre| (-exponent(centre, &axes, percept, model.rbf_width)).exp())
        .collect();
    let sum: f64 = gaussians.iter().sum();
    gaussians.iter().map(|gaussian| gaussian / sum).collect()
}

/// |s - c|^2 / 2 sigma^2 for one centre of the grid. Each axis has its own sigma.
fn exponent(mut centre: usize, axes: &[(usize, usize)], percept: &[f32], width: RbfWidth) -> f64 {
    let mut exponent = 0.0;
    for &(input, centres) in axes.iter().rev() {
        let spacing = 1.0 / (centres - 1) as f64;
        let sigma_squared = match width {
            RbfWidth::Spacing => 2.0 * spacing * spacing,
            RbfWidth::Variance => 2.0_f64.sqrt() * spacing,
        };
        let c = (centre % centres) as f64 * spacing;
        exponent += (f64::from(percept[input]) - c).powi(2) / (2.0 * sigma_squared);
        centre /= centres;
    }
    exponent
}
