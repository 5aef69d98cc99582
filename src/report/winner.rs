//! The properties of final structures that the claims of the thesis are about.

use super::facts::Winner;

/// Composite subtasks of the foraging task that serve capturing, and those that serve
/// delivering.
const SIDES: [[&str; 3]; 2] = [
    ["Capture", "FindBattery", "VisibleBattery"],
    ["Deliver", "FindNest", "VisibleNest"],
];

impl Winner {
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
        let captures = self.primitives.iter().any(|name| name == "ApproachBattery");
        let composites = |side: [&str; 3]| {
            let own = self.composites.iter().map(String::as_str);
            own.filter(|name| side.contains(name)).count()
        };
        let [capture, deliver] = SIDES.map(composites);
        let capture = capture + first.len() + second.len();
        let deliver = deliver + third.len() + fourth.len();
        captures.then_some([capture, deliver])
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
