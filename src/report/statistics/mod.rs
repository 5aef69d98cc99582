//! Statistics for few, noisy runs.
//!
//! The unit of observation is the seed. Estimates have percentile-bootstrap intervals over
//! seeds, as recommended by R. Agarwal et al., *Deep Reinforcement Learning at the Edge of the
//! Statistical Precipice* (NeurIPS 2021). Proportions have exact intervals. Differences are
//! tested exactly where that is feasible. Every interval is reported with its n.

mod bootstrap;
mod counts;
mod ranks;

pub use bootstrap::{RESAMPLES, bootstrap, iqm, mean, median};
pub use counts::{Count, fisher};
pub use ranks::{mann_whitney, probability_of_improvement};

use serde::Serialize;

/// A 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// An estimate of a statistic from `n` values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Number of values.
    pub n: usize,
    /// The estimate.
    pub value: f64,
    /// Its 95 % interval; `None` if any stratum has a single value.
    pub interval: Option<Interval>,
}

impl Estimate {
    /// Estimates a statistic of `values` with its bootstrap interval.
    ///
    /// Returns `None` if there are no values.
    #[must_use]
    pub fn of(values: &[f64], statistic: fn(&[f64]) -> f64) -> Option<Self> {
        let strata = [values.to_vec()];
        Self::stratified(&strata, |strata| statistic(&strata[0]))
    }

    /// Estimates a statistic of strata with its bootstrap interval. Each stratum is resampled
    /// separately.
    ///
    /// Returns `None` if there are no strata or one is empty.
    #[must_use]
    pub fn stratified<T: Clone>(
        strata: &[Vec<T>],
        statistic: impl Fn(&[Vec<T>]) -> f64,
    ) -> Option<Self> {
        if strata.is_empty() || strata.iter().any(Vec::is_empty) {
            return None;
        }
        let repeated = strata.iter().all(|stratum| stratum.len() > 1);
        Some(Self {
            n: strata.iter().map(Vec::len).sum(),
            value: statistic(strata),
            interval: repeated.then(|| bootstrap(strata, statistic)),
        })
    }
}
