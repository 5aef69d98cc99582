//! What a world looks like, in the same few shapes for every world, so that drawing code knows
//! none of them.
//!
//! Positions are in the world's own unit, x to the right and y upwards; headings are in
//! radians, 0 along +x, counter-clockwise.

use super::{Probe, StateType, SubtaskId, World};
use crate::random::Stream;

/// The part of a world that does not change while an agent acts.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenery {
    /// Extent along x and y from the origin.
    pub extent: [f64; 2],
    /// The unit of lengths: `mm`, `cells`.
    pub unit: String,
    /// Columns and rows of a world of equal cells.
    pub grid: Option<[usize; 2]>,
    /// Walls, each from one end to the other.
    pub walls: Vec<[[f64; 2]; 2]>,
    /// Walls that stop the agent but not its sight; only worlds without cells have any.
    pub transparent_walls: Vec<[[f64; 2]; 2]>,
    /// Places with a name or a meaning, which never move.
    pub places: Vec<Mark>,
    /// Primitive subtasks that move the agent by one cell.
    pub moves: Vec<Move>,
    /// Length of a time step in seconds, in worlds with real time.
    pub time_step_s: Option<f64>,
}

/// A primitive subtask that moves the agent by one cell if nothing is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// The subtask.
    pub subtask: SubtaskId,
    /// The direction of the move.
    pub heading: f64,
}

/// The meaning of a mark for the agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// The place where the task ends: a nest, a destination.
    Goal,
    /// An object to find or pick up: a battery, a passenger.
    Object,
    /// A danger: a cliff.
    Hazard,
    /// A place with a name.
    Landmark,
}

/// An object or a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its meaning.
    pub role: Role,
    /// A short name, such as `nest`, `battery 2`, `R`.
    pub label: String,
    /// Its centre.
    pub at: [f64; 2],
}

/// The reading of a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The name, which ends with the unit: `angle_deg`.
    pub name: String,
    /// The value; `None` if there is none, such as the angle to a target out of sight.
    pub value: Option<f64>,
}

/// The field of view of an agent: a sector, symmetric about the heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Half its angle in radians.
    pub half_angle: f64,
    /// Its range.
    pub range: f64,
}

/// What a state of an agent and its surroundings looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Centre of the agent.
    pub at: [f64; 2],
    /// Its radius.
    pub radius: f64,
    /// Its heading, if agents of this world have one.
    pub heading: Option<f64>,
    /// The label of the object that it carries.
    pub carries: Option<String>,
    /// Objects that can move or disappear: the batteries left, a passenger.
    pub marks: Vec<Mark>,
    /// Its field of view.
    pub view: Option<View>,
    /// The position of the target that it sees.
    pub sees: Option<[f64; 2]>,
    /// The place where it remembers the target of its task, while it does not see it.
    pub remembers: Option<[f64; 2]>,
    /// Proximity rays, each from the body to the measured distance.
    pub rays: Vec<[[f64; 2]; 2]>,
    /// The readings of the sensors.
    pub readings: Vec<Reading>,
    /// The type of the state; the catalogue's terminal type when the task is done.
    pub state_type: StateType,
    /// The index of the present one of the [`variants`](Scenic::variants): the last if the task
    /// is done.
    pub variant: usize,
}

/// Inputs for which learned values are drawn, in one row or several.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep<P> {
    /// The scale from column to column.
    pub across: Scale,
    /// The scale from row to row, if there are several rows.
    pub down: Option<Scale>,
    /// The inputs, row by row.
    pub probes: Vec<Probe<P>>,
}

/// The scale along one direction of a [`Sweep`].
#[derive(Clone, Debug, PartialEq)]
pub enum Scale {
    /// A quantity.
    Quantity {
        /// Its name, which ends with the unit.
        name: String,
        /// Its values, ascending.
        values: Vec<f64>,
    },
    /// Typical cases.
    Cases {
        /// Their common name.
        name: String,
        /// A label for each case.
        labels: Vec<String>,
    },
}

impl Scale {
    /// Returns the name.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Quantity { name, .. } | Self::Cases { name, .. } => name,
        }
    }

    /// Returns the number of values or cases.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Quantity { values, .. } => values.len(),
            Self::Cases { labels, .. } => labels.len(),
        }
    }

    /// Returns whether there are no values or cases.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns a value or case in words.
    #[must_use]
    pub fn label(&self, index: usize) -> String {
        match self {
            Self::Quantity { values, .. } => values.get(index).map(ToString::to_string),
            Self::Cases { labels, .. } => labels.get(index).cloned(),
        }
        .unwrap_or_default()
    }
}

/// A world that can be drawn.
pub trait Scenic: World {
    /// Returns the part that does not change.
    fn scenery(&self) -> Scenery;

    /// Returns what a state looks like.
    fn snapshot(&self, state: &Self::State) -> Snapshot;

    /// Returns the position of the agent: [`Snapshot::at`] without the rest.
    fn position(&self, state: &Self::State) -> [f64; 2];

    /// Returns the situations of an agent apart from position and heading, in a few words each,
    /// such as `empty-handed` and `carrying`: at least one.
    fn variants(&self) -> Vec<String>;

    /// Returns the state of an agent at a position, with a heading and the index of one of the
    /// [`variants`].
    ///
    /// `None` where an agent cannot be.
    ///
    /// [`variants`]: Scenic::variants
    fn state_at(
        &self,
        at: [f64; 2],
        heading: f64,
        variant: usize,
        rng: &mut Stream,
    ) -> Option<Self::State>;

    /// Returns the inputs for which the values of a subtask are drawn in states of the given
    /// type: by default its [`World::probes`].
    fn sweeps(&self, subtask: SubtaskId, state_type: StateType) -> Vec<Sweep<Self::Percept>> {
        let _ = state_type;
        if self.catalogue().subtask(subtask).is_composite() {
            return Vec::new();
        }
        let probes = self.probes(subtask);
        let across = Scale::Cases {
            name: String::from("input"),
            labels: probes.iter().map(|probe| probe.label.clone()).collect(),
        };
        vec![Sweep {
            across,
            down: None,
            probes,
        }]
    }
}
