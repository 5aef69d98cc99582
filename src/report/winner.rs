//! What the thesis looks at in a hierarchy.

use super::facts::Winner;

/// Composite subtasks of the foraging task by the side that they serve: capturing,
/// delivering.
const SIDES: [[&str; 3]; 2] = [
    ["Capture", "FindBattery", "VisibleBattery"],
    ["Deliver", "FindNest", "VisibleNest"],
];

impl Winner {
    /// Whether every state type has one selectable primitive subtask: the *minimal
    /// strategy* of S. Elfwing et al., *Evolutionary Development of Hierarchical Learning
    /// Structures*, IEEE Transactions on Evolutionary Computation 11 (2007).
    #[must_use]
    pub fn is_minimal(&self) -> bool {
        self.selectable.iter().all(|names| names.len() == 1)
    }

    /// Selectable primitive subtasks, summed over the state types.
    #[must_use]
    pub fn selectable_in_all(&self) -> usize {
        self.selectable.iter().map(Vec::len).sum()
    }

    /// Composite and selectable primitive subtasks of the capture and of the deliver side;
    /// none where the task is not foraging.
    #[must_use]
    pub fn sides(&self) -> Option<[usize; 2]> {
        let [first, second, third, fourth] = self.selectable.as_slice() else {
            return None;
        };
        let captures = self.primitives.iter().any(|name| name == "ApproachBattery");
        let composites = |side: [&str; 3]| {
            self.composites
                .iter()
                .filter(|name| side.contains(&name.as_str()))
                .count()
        };
        let [capture, deliver] = SIDES.map(composites);
        captures.then(|| {
            [
                capture + first.len() + second.len(),
                deliver + third.len() + fourth.len(),
            ]
        })
    }

    /// Whether the deliver side has all its composite subtasks and at least four primitive
    /// ones; none where the task is not foraging.
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
