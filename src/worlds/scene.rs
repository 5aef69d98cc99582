//! What there is to see of a world: the same few shapes for every world, so that who
//! draws one needs to know none.
//!
//! Positions are in the world's own unit, x to the right and y upwards; headings are in
//! radians, 0 along +x, counter-clockwise.

use super::{Probe, StateType, SubtaskId, World};
use crate::random::Stream;

/// What does not change while an agent acts.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenery {
    /// Extent along x and y from the origin.
    pub extent: [f64; 2],
    /// The unit of lengths: `mm`, `cells`.
    pub unit: String,
    /// Columns and rows, where the world consists of equal cells.
    pub grid: Option<[usize; 2]>,
    /// Walls from one end to the other.
    pub walls: Vec<[[f64; 2]; 2]>,
    /// Places that have a name or a meaning and never move.
    pub places: Vec<Mark>,
    /// Primitive subtasks that move the agent by a cell.
    pub moves: Vec<Move>,
    /// What a time step lasts in seconds, where time is real.
    pub time_step_s: Option<f64>,
}

/// A primitive subtask that moves the agent by a cell, if nothing is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// The subtask.
    pub subtask: SubtaskId,
    /// Where it moves the agent.
    pub heading: f64,
}

/// What a mark means to the agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// Where the task ends: a nest, a destination.
    Goal,
    /// What is to be found or picked up: a battery, a passenger.
    Object,
    /// What is to be kept away from: a cliff.
    Hazard,
    /// A place with a name.
    Landmark,
}

/// Something at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// What it means.
    pub role: Role,
    /// A short name for people, such as `nest`, `battery 2`, `R`.
    pub label: String,
    /// Its centre.
    pub at: [f64; 2],
}

/// What an agent reads off one of its sensors.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// What is read; ends in the unit, such as `angle_deg`.
    pub name: String,
    /// The value; `None` where there is nothing to read, such as the angle to a target
    /// that is not seen.
    pub value: Option<f64>,
}

/// A sector in which an agent sees, symmetric about its heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Half its opening, in radians.
    pub half_angle: f64,
    /// How far it reaches.
    pub range: f64,
}

/// One state of an agent and its surroundings.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Centre of the agent.
    pub at: [f64; 2],
    /// Its radius.
    pub radius: f64,
    /// Where it heads, if it heads anywhere.
    pub heading: Option<f64>,
    /// Label of what it carries.
    pub carries: Option<String>,
    /// What can move or go: batteries that are left, a passenger.
    pub marks: Vec<Mark>,
    /// Where it sees.
    pub view: Option<View>,
    /// The place of the target that it sees.
    pub sees: Option<[f64; 2]>,
    /// Proximity rays, each from the agent to what it measured.
    pub rays: Vec<[[f64; 2]; 2]>,
    /// What the sensors read.
    pub readings: Vec<Reading>,
    /// The type of the state; the catalogue's terminal type when the task is done.
    pub state_type: StateType,
    /// Which of the [`variants`](Scenic::variants) is the case, by index; the last one when
    /// the task is done.
    pub variant: usize,
}

/// Inputs along which learned values are drawn, one after the other or in rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep<P> {
    /// From column to column.
    pub across: Scale,
    /// From row to row, if there is more than one row.
    pub down: Option<Scale>,
    /// The inputs, row by row.
    pub probes: Vec<Probe<P>>,
}

/// What changes along one direction of a [`Sweep`].
#[derive(Clone, Debug, PartialEq)]
pub enum Scale {
    /// A quantity.
    Quantity {
        /// Its name; ends in the unit.
        name: String,
        /// Its values, ascending.
        values: Vec<f64>,
    },
    /// Typical cases.
    Cases {
        /// What they are cases of.
        name: String,
        /// One label a case.
        labels: Vec<String>,
    },
}

impl Scale {
    /// What changes.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Quantity { name, .. } | Self::Cases { name, .. } => name,
        }
    }

    /// How many values or cases there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Quantity { values, .. } => values.len(),
            Self::Cases { labels, .. } => labels.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A value or case in words.
    #[must_use]
    pub fn label(&self, index: usize) -> String {
        match self {
            Self::Quantity { values, .. } => values.get(index).map(ToString::to_string),
            Self::Cases { labels, .. } => labels.get(index).cloned(),
        }
        .unwrap_or_default()
    }
}

/// A world that can be looked at.
pub trait Scenic: World {
    /// What does not change.
    fn scenery(&self) -> Scenery;

    /// What a state looks like.
    fn snapshot(&self, state: &Self::State) -> Snapshot;

    /// Where the agent is: [`Snapshot::at`] without the rest.
    fn position(&self, state: &Self::State) -> [f64; 2];

    /// What can be the case besides place and heading, in a few words each, such as
    /// `empty-handed` and `carrying`; at least one.
    fn variants(&self) -> Vec<String>;

    /// The state of an agent at a place with a heading, in one of the [`variants`]
    /// (by index); `None` where the agent cannot be.
    ///
    /// [`variants`]: Scenic::variants
    fn state_at(
        &self,
        at: [f64; 2],
        heading: f64,
        variant: usize,
        rng: &mut Stream,
    ) -> Option<Self::State>;

    /// Inputs along which the values of a subtask are drawn, as they are in states of
    /// the given type. By default the subtask's [`World::probes`].
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
