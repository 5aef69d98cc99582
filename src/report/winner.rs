//! The properties of final structures that the claims of the thesis are about.

use serde::Serialize;

use crate::evolution::{RankedRecord, TreeError};
use crate::hierarchy::{canonical, without_repeats};
use crate::lab::AnyExperiment;

/// Composite subtasks of the foraging task that serve capturing, and those that serve
/// delivering.
const SIDES: [[&str; 3]; 2] = [
    ["Capture", "FindBattery", "VisibleBattery"],
    ["Deliver", "FindNest", "VisibleNest"],
];

/// The structure of the best individual of a run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Winner {
    /// The hierarchy as text.
    pub tree: String,
    /// The hierarchy with children sorted and repeated primitive children left out.
    pub structure: String,
    /// Its composite subtasks, including the root.
    pub composites: Vec<String>,
    /// Its distinct primitive subtasks.
    pub primitives: Vec<String>,
    /// The primitive subtasks that can be selected, for each state type.
    pub selectable: Vec<Vec<String>>,
    /// Whether its world is the foraging task.
    #[serde(skip)]
    pub forages: bool,
}

impl Winner {
    /// Reads the hierarchy of an individual.
    ///
    /// # Errors
    /// When its text is not a hierarchy of the experiment.
    pub(super) fn of(
        record: &RankedRecord,
        experiment: &dyn AnyExperiment,
    ) -> Result<Self, TreeError> {
        let catalogue = experiment.catalogue();
        let tree = experiment.read_tree(&record.tree)?;
        let composites = tree.nodes().iter().filter_map(|node| {
            let subtask = catalogue.subtask(node.subtask);
            subtask.is_composite().then(|| subtask.name.to_owned())
        });
        Ok(Self {
            composites: composites.collect(),
            structure: canonical(&without_repeats(&tree, catalogue), catalogue),
            tree: record.tree.clone(),
            primitives: record.primitives.clone(),
            selectable: record.primitives_by_state_type.clone(),
            forages: SIDES
                .concat()
                .iter()
                .all(|name| catalogue.find(name).is_some()),
        })
    }

    /// Returns whether every state type has exactly one selectable primitive subtask: the
    /// *minimal strategy* of S. Elfwing et al., *Evolutionary Development of Hierarchical
    /// Learning Structures*, IEEE Transactions on Evolutionary Computation 11 (2007).
    #[must_use]
    pub fn is_minimal(&self) -> bool {
        self.selectable.iter().all(|names| names.len() == 1)
    }

    /// Returns the number of selectable primitive subtasks, summed over state types.
    #[must_use]
    pub fn selectable_in_all(&self) -> usize {
        self.selectable.iter().map(Vec::len).sum()
    }

    /// Returns the number of composite and selectable primitive subtasks of the capture side and
    /// of the deliver side; `None` if the task is not foraging.
    #[must_use]
    pub fn sides(&self) -> Option<[usize; 2]> {
        let [first, second, third, fourth] = self.selectable.as_slice() else {
            return None;
        };
        let composites = |side: [&str; 3]| {
            let own = self.composites.iter().map(String::as_str);
            own.filter(|name| side.contains(name)).count()
        };
        let [capture, deliver] = SIDES.map(composites);
        let capture = capture + first.len() + second.len();
        let deliver = deliver + third.len() + fourth.len();
        self.forages.then_some([capture, deliver])
    }

    /// Returns whether the deliver side has all of its composite subtasks and at least four
    /// primitive ones; `None` if the task is not foraging.
    #[must_use]
    pub fn deliver_is_complete(&self) -> Option<bool> {
        self.sides()?;
        let has = |name: &&str| self.composites.iter().any(|own| own == name);
        let mut primitives: Vec<_> = self.selectable.iter().skip(2).flatten().collect();
        primitives.sort_unstable();
        primitives.dedup();
        Some(SIDES[1].iter().all(has) && primitives.len() >= 4)
    }
}
