//! The statistics of few, noisy runs.
//!
//! The seed is the unit. Estimates come with percentile-bootstrap intervals over seeds, as
//! R. Agarwal et al., *Deep Reinforcement Learning at the Edge of the Statistical
//! Precipice* (NeurIPS 2021) recommends; counts with exact intervals; differences with
//! exact tests. No interval comes without its n.

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

/// An estimate from `n` values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Values that it is made from.
    pub n: usize,
    /// The estimate.
    pub value: f64,
    /// Its 95 % interval; none from a single value.
    pub interval: Option<Interval>,
}

impl Estimate {
    /// The statistic of `values` with its bootstrap interval; none without values.
    #[must_use]
    pub fn of(values: &[f64], statistic: fn(&[f64]) -> f64) -> Option<Self> {
        let strata = [values.to_vec()];
        Self::stratified(&strata, |strata| statistic(&strata[0]))
    }

    /// A statistic of strata, each resampled by itself, with its bootstrap interval; none
    /// where a stratum is empty.
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
