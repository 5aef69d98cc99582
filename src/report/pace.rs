//! An estimate of the time that the rest of a study takes.

use std::collections::BTreeMap;
use std::time::Duration;

use super::study::RunId;

/// The durations of finished runs, and the estimate for the remaining ones.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    /// Number and total seconds of finished runs, by scenario and arm.
    done: BTreeMap<(usize, usize), (u32, f64)>,
    /// Number of remaining runs, by scenario and arm.
    left: BTreeMap<(usize, usize), u32>,
}

impl Pace {
    /// Creates the estimate with these runs remaining.
    #[must_use]
    pub fn of(runs: &[RunId]) -> Self {
        let mut pace = Self::default();
        for run in runs {
            *pace.left.entry((run.scenario, run.arm)).or_default() += 1;
        }
        pace
    }

    /// Notes that a run is no longer remaining, and its duration if it was finished here.
    pub fn note(&mut self, run: &RunId, took: Option<Duration>) {
        let kind = (run.scenario, run.arm);
        if let Some(left) = self.left.get_mut(&kind) {
            *left = left.saturating_sub(1);
        }
        if let Some(took) = took {
            let (count, seconds) = self.done.entry(kind).or_default();
            *count += 1;
            *seconds += took.as_secs_f64();
        }
    }

    /// Returns the expected time for the remaining runs with `jobs` at a time. A run is expected
    /// to take the mean time of the finished runs of its scenario and arm, or of all finished
    /// runs if there are none of its kind.
    ///
    /// Returns `None` before any run has finished.
    #[must_use]
    pub fn left(&self, jobs: usize) -> Option<Duration> {
        let mean = |count: u32, seconds: f64| (count > 0).then(|| seconds / f64::from(count));
        let (count, seconds) = self
            .done
            .values()
            .fold((0, 0.0), |(count, sum), (n, seconds)| {
                (count + n, sum + seconds)
            });
        let overall = mean(count, seconds)?;
        let left = self.left.iter().map(|(kind, &left)| {
            let own = self
                .done
                .get(kind)
                .and_then(|&(count, seconds)| mean(count, seconds));
            f64::from(left) * own.unwrap_or(overall)
        });
        Some(Duration::from_secs_f64(
            left.sum::<f64>() / jobs.max(1) as f64,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_run_has_its_own_pace() {
        let run = |scenario, seed| RunId {
            number: 1,
            scenario,
            arm: 0,
            seed,
        };
        let runs = [run(0, 1), run(0, 2), run(1, 1), run(1, 2), run(2, 1)];
        let mut pace = Pace::of(&runs);
        assert_eq!(pace.left(2), None);
        pace.note(&run(0, 1), Some(Duration::from_secs(2)));
        pace.note(&run(1, 1), Some(Duration::from_secs(10)));
        // Remaining: one of 2 s, one of 10 s, and one of a new kind, expected to take 6 s.
        assert_eq!(pace.left(2), Some(Duration::from_secs(9)));
        pace.note(&run(2, 1), None);
        assert_eq!(pace.left(1), Some(Duration::from_secs(12)));
    }
}
