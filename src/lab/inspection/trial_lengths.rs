//! How long the trials of a rollout are while it learns.

/// Most stretches: more would show noise instead of a course.
const MOST: usize = 24;

/// The mean length of trials, in stretches of equal length: a learning curve of bounded size.
///
/// When there are too many stretches, neighbours are joined.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrialLengths {
    /// Trials of a stretch.
    stretch: u64,
    /// Time steps of each whole stretch.
    whole: Vec<u64>,
    /// Trials and time steps of the stretch that is not whole yet.
    trials: u64,
    steps: u64,
}

impl Default for TrialLengths {
    fn default() -> Self {
        Self {
            stretch: 1,
            whole: Vec::new(),
            trials: 0,
            steps: 0,
        }
    }
}

impl TrialLengths {
    /// Adds a trial.
    pub fn add(&mut self, steps: u32) {
        self.trials += 1;
        self.steps += u64::from(steps);
        if self.trials < self.stretch {
            return;
        }
        self.whole.push(self.steps);
        (self.trials, self.steps) = (0, 0);
        if self.whole.len() == MOST {
            let pairs = self.whole.chunks(2);
            self.whole = pairs.map(|pair| pair.iter().sum()).collect();
            self.stretch *= 2;
        }
    }

    /// Returns the number of trials of a stretch.
    #[must_use]
    pub fn stretch(&self) -> u64 {
        self.stretch
    }

    /// Returns the last trial of each whole stretch, counted from 1, and the mean time steps of a
    /// trial in it.
    #[must_use]
    pub fn means(&self) -> Vec<(u64, f64)> {
        let stretches = (1..).zip(&self.whole);
        stretches
            .map(|(count, &steps)| {
                let mean = steps as f64 / self.stretch as f64;
                (count * self.stretch, mean)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_joined_and_lose_no_trial() {
        let mut lengths = TrialLengths::default();
        for steps in 1..24 {
            lengths.add(steps);
        }
        assert_eq!((lengths.stretch(), lengths.means().len()), (1, 23));
        lengths.add(24);
        assert_eq!(lengths.stretch(), 2);
        assert_eq!(lengths.means()[..2], [(2, 1.5), (4, 3.5)]);
        lengths.add(25);
        assert_eq!(lengths.means().len(), 12, "the last stretch is not whole");
        for steps in 26..=1000 {
            lengths.add(steps);
        }
        let means = lengths.means();
        assert_eq!((lengths.stretch(), means.len()), (64, 15));
        assert_eq!(means[14], (960, (897.0 + 960.0) / 2.0));
    }
}
