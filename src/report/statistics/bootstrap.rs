//! Means and their bootstrap intervals.

use rand::RngExt;

use super::Interval;
use crate::random::{Purpose, stream};

/// Resamples behind an interval: its ends then vary by about a fiftieth of its width.
pub const RESAMPLES: usize = 5000;

/// Mean of `values`; NaN of none.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Median of `values`; NaN of none.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    quantile(&sorted(values), 0.5)
}

/// Interquartile mean: the mean of what is left when a quarter of the values, rounded
/// down, is left out at either end; NaN of none.
#[must_use]
pub fn iqm(values: &[f64]) -> f64 {
    let sorted = sorted(values);
    let cut = sorted.len() / 4;
    mean(&sorted[cut..sorted.len() - cut])
}

/// The percentile-bootstrap 95 % interval of a statistic: every stratum is resampled by
/// itself, with replacement, [`RESAMPLES`] times. The same strata give the same bits.
#[must_use]
pub fn bootstrap<T: Clone>(strata: &[Vec<T>], statistic: impl Fn(&[Vec<T>]) -> f64) -> Interval {
    let mut rng = stream(0, 0, 0, Purpose::Bootstrap);
    let mut room = strata.to_vec();
    let mut values: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            for (drawn, stratum) in room.iter_mut().zip(strata) {
                for place in drawn {
                    *place = stratum[rng.random_range(0..stratum.len())].clone();
                }
            }
            statistic(&room)
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

/// The quantile of sorted values, interpolated between neighbours; NaN of none.
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
    fn means_are_those_of_scipy() {
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
    fn the_interval_of_a_mean_is_that_of_scipy_and_repeats() {
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
    fn strata_are_resampled_by_themselves() {
        // Two strata without spread: whatever is drawn, their difference is the same.
        let strata = [vec![1.0; 5], vec![4.0; 3]];
        let found = bootstrap(&strata, |strata| mean(&strata[1]) - mean(&strata[0]));
        assert_eq!((found.low, found.high), (3.0, 3.0));
    }
}
