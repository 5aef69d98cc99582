//! Means, and bootstrap intervals of statistics.

use rand::RngExt;

use super::Interval;
use crate::random::{Purpose, stream};

/// Number of bootstrap resamples. With it, the ends of an interval vary by about 2 % of its
/// width.
pub const RESAMPLES: usize = 5000;

/// Returns the mean of `values`, or NaN if there are none.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the median of `values`, or NaN if there are none.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    quantile(&sorted(values), 0.5)
}

/// Returns the interquartile mean: the mean of `values` without the lowest and the highest
/// quarter, each rounded down to whole values. NaN if there are no values.
#[must_use]
pub fn iqm(values: &[f64]) -> f64 {
    let sorted = sorted(values);
    let cut = sorted.len() / 4;
    mean(&sorted[cut..sorted.len() - cut])
}

/// Returns the percentile-bootstrap 95 % interval of a statistic. Each stratum is resampled
/// separately, with replacement, [`RESAMPLES`] times.
///
/// The random stream is fixed, so the same strata give the same bits.
#[must_use]
pub fn bootstrap<T: Clone>(strata: &[Vec<T>], statistic: impl Fn(&[Vec<T>]) -> f64) -> Interval {
    let mut rng = stream(0, 0, 0, Purpose::Bootstrap);
    let mut resample = strata.to_vec();
    let mut values: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            for (drawn, stratum) in resample.iter_mut().zip(strata) {
                for place in drawn {
                    *place = stratum[rng.random_range(0..stratum.len())].clone();
                }
            }
            statistic(&resample)
        })
        .collect();
    values.sort_unstable_by(f64::total_cmp);
    Interval {
        low: quantile(&values, 0.025),
        high: quantile(&values, 0.975),
    }
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted
}

/// Returns a quantile of sorted values, interpolated linearly between neighbours. NaN if there
/// are no values.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_agree_with_scipy() {
        // scipy.stats.trim_mean(..., 0.25)
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 100.0];
        assert_eq!(iqm(&values), 5.5);
        assert_eq!(iqm(&[3.0, 1.0, 2.0]), 2.0);
        assert!(iqm(&[]).is_nan());
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        // numpy.percentile([1, 2, 3, 4, 10], [2.5, 97.5])
        let sorted = [1.0, 2.0, 3.0, 4.0, 10.0];
        assert!((quantile(&sorted, 0.025) - 1.1).abs() < 1e-12);
        assert!((quantile(&sorted, 0.975) - 9.4).abs() < 1e-12);
    }

    #[test]
    fn the_interval_of_a_mean_agrees_with_scipy_and_repeats() {
        let values = vec![
            12.0, 15.0, 9.0, 22.0, 30.0, 8.0, 11.0, 17.0, 25.0, 13.0, 40.0, 19.0,
        ];
        let strata = [values];
        let of_mean = |strata: &[Vec<f64>]| mean(&strata[0]);
        let found = bootstrap(&strata, of_mean);
        // scipy.stats.bootstrap(..., method='percentile', n_resamples=200000)
        assert!((found.low - 13.67).abs() < 0.25, "{found:?}");
        assert!((found.high - 23.92).abs() < 0.35, "{found:?}");
        assert_eq!(found, bootstrap(&strata, of_mean));
    }

    #[test]
    fn strata_are_resampled_separately() {
        // Neither stratum has any spread, so every resample has the same difference.
        let strata = [vec![1.0; 5], vec![4.0; 3]];
        let found = bootstrap(&strata, |strata| mean(&strata[1]) - mean(&strata[0]));
        assert_eq!((found.low, found.high), (3.0, 3.0));
    }
}
