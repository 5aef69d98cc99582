//! Learning curves: trial length against trials lived, over several fresh hierarchies.

use serde::Serialize;

use super::statistics::{mean_of, standard_error};

/// Most stretches of a curve. More would be narrower than a column of a wide terminal.
const MOST_STRETCHES: usize = 50;

/// The same trials of all repeats.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CurvePoint {
    /// The first of the trials, from 1.
    pub first: usize,
    /// The last of the trials.
    pub last: usize,
    /// Mean time steps of a trial.
    pub mean: f64,
    /// Standard error of the mean; `None` for a single repeat.
    pub standard_error: Option<f64>,
    /// Share of the trials in which the task was completed.
    pub delivered_share: f64,
}

impl CurvePoint {
    /// Returns the trial in the middle.
    #[must_use]
    pub fn middle(&self) -> f64 {
        (self.first + self.last) as f64 / 2.0
    }
}

/// The trials of one repeat, summed up in stretches of equal length.
#[derive(Clone, Debug)]
pub(super) struct Lived {
    trials: usize,
    stretch: usize,
    /// Time steps and completed tasks of each stretch.
    sums: Vec<(u64, usize)>,
}

impl Lived {
    /// Starts a repeat of this many trials.
    pub(super) fn new(trials: usize) -> Self {
        Self {
            trials,
            stretch: stretch(trials),
            sums: Vec::new(),
        }
    }

    /// Adds the next trial; the first one has the number 0.
    pub(super) fn add(&mut self, trial: usize, steps: u32, delivered: bool) {
        let place = trial / self.stretch;
        if self.sums.len() <= place {
            self.sums.resize(place + 1, (0, 0));
        }
        let (sum, count) = &mut self.sums[place];
        *sum += u64::from(steps);
        *count += usize::from(delivered);
    }
}

/// Returns the smallest of 1, 2, 5, 10, 20, .. that divides the trials into few stretches.
fn stretch(trials: usize) -> usize {
    let sizes = (0..).flat_map(|power| [1, 2, 5].map(|digit| digit * 10_usize.pow(power)));
    let mut few = sizes.filter(|size| trials.div_ceil(*size) <= MOST_STRETCHES);
    few.next().unwrap_or(1)
}

/// Returns the curve of repeats, each with the index of its set of primitive subtasks.
pub(super) fn curve(repeats: &[(usize, Lived)]) -> Vec<CurvePoint> {
    let Some((_, one)) = repeats.first() else {
        return Vec::new();
    };
    let point = |place: usize| {
        let first = place * one.stretch + 1;
        let last = (first + one.stretch - 1).min(one.trials);
        let trials = (last - first + 1) as f64;
        let of = |lived: &Lived| lived.sums[place].0 as f64 / trials;
        let means: Vec<_> = repeats
            .iter()
            .map(|(set, lived)| (*set, of(lived)))
            .collect();
        let delivered = repeats
            .iter()
            .map(|(_, lived)| lived.sums[place].1 as f64 / trials);
        CurvePoint {
            first,
            last,
            mean: mean_of(means.iter().map(|(_, mean)| *mean)),
            standard_error: standard_error(&means),
            delivered_share: mean_of(delivered),
        }
    };
    (0..one.sums.len()).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_has_few_stretches_of_round_length() {
        let sizes = [1, 50, 51, 108, 508, 4008, 100_000].map(stretch);
        assert_eq!(sizes, [1, 1, 2, 5, 20, 100, 2000]);
    }

    #[test]
    fn points_are_means_over_trials_and_repeats() {
        let lived = |base: u32| {
            let mut lived = Lived::new(101);
            for trial in 0..101 {
                lived.add(trial, base + trial as u32, trial < 100);
            }
            lived
        };
        let points = curve(&[(0, lived(10)), (1, lived(20))]);
        // Stretches of 5 trials; the last has one.
        assert_eq!(points.len(), 21);
        assert_eq!((points[0].first, points[0].last), (1, 5));
        assert_eq!(points[0].mean, 17.0);
        assert_eq!(points[0].delivered_share, 1.0);
        let last = points[20];
        assert_eq!((last.first, last.last, last.mean), (101, 101, 115.0));
        assert_eq!(last.delivered_share, 0.0);
        // Two repeats with means 5 below and above.
        assert!((last.standard_error.unwrap() - 5.0).abs() < 1e-12);
    }
}
