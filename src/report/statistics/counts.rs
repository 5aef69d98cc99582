//! Proportions: exact intervals, and the exact test of a difference between two.

use serde::Serialize;

use super::Interval;

/// A count out of `n`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Number of observations that show the property.
    pub shown: u64,
    /// Number of observations.
    pub n: u64,
}

impl Count {
    /// Counts the observations that show a property.
    #[must_use]
    pub fn of(shows: impl IntoIterator<Item = bool>) -> Self {
        let (mut shown, mut n) = (0, 0);
        for one in shows {
            shown += u64::from(one);
            n += 1;
        }
        Self { shown, n }
    }

    /// Returns the proportion, or NaN if there are no observations.
    #[must_use]
    pub fn share(self) -> f64 {
        self.shown as f64 / self.n as f64
    }

    /// Returns the exact 95 % interval of the proportion (C. J. Clopper and E. S. Pearson,
    /// Biometrika 26, 1934).
    #[must_use]
    pub fn interval(self) -> Interval {
        let Self { shown, n } = self;
        let tail = 0.025;
        let low = match shown {
            0 => 0.0,
            // The smallest proportion for which `shown` or more is not too improbable.
            _ => bisect(|share| 1.0 - at_most(shown - 1, n, share) < tail),
        };
        let high = if shown == n {
            1.0
        } else {
            bisect(|share| at_most(shown, n, share) > tail)
        };
        Interval { low, high }
    }
}

/// Returns the largest number in [0, 1] for which `holds`, given that it holds for all smaller
/// ones.
fn bisect(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}

/// Returns the probability of at most `shown` successes in `n` trials with success probability
/// `share`.
fn at_most(shown: u64, n: u64, share: f64) -> f64 {
    let term = |k: u64| {
        let (k_, n_) = (k as f64, n as f64);
        libm::exp(ln_choose(n, k) + k_ * libm::log(share) + (n_ - k_) * libm::log1p(-share))
    };
    (0..=shown).map(term).sum()
}

/// Returns the logarithm of the binomial coefficient `n` over `k`.
fn ln_choose(n: u64, k: u64) -> f64 {
    let ln_factorial = |m: u64| libm::lgamma(m as f64 + 1.0);
    ln_factorial(n) - ln_factorial(k) - ln_factorial(n - k)
}

/// Returns the two-sided p-value of Fisher's exact test that two proportions are equal: the
/// total probability, given the margins, of all tables that are at most as probable as the
/// observed one. 1 if either count is out of none.
#[must_use]
pub fn fisher(a: Count, b: Count) -> f64 {
    let shown = a.shown + b.shown;
    let all = a.n + b.n;
    let probability =
        |k: u64| libm::exp(ln_choose(a.n, k) + ln_choose(b.n, shown - k) - ln_choose(all, shown));
    let observed = probability(a.shown);
    // Tables with the same probability must count despite rounding.
    let limit = observed * (1.0 + 1e-7);
    let possible = shown.saturating_sub(b.n)..=shown.min(a.n);
    let sum: f64 = possible.map(probability).filter(|&p| p <= limit).sum();
    sum.min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(shown: u64, n: u64) -> Count {
        Count { shown, n }
    }

    #[test]
    fn intervals_agree_with_scipy() {
        // scipy.stats.binomtest(k, n).proportion_ci(method='exact')
        for (shown, n, low, high) in [
            (4, 20, 0.057_333_997_05, 0.436_614_002_997),
            (0, 30, 0.0, 0.115_703_308_222),
            (30, 30, 0.884_296_691_778, 1.0),
            (13, 20, 0.407_811_465_467, 0.846_090_795_215),
            (1, 3, 0.008_403_758_66, 0.905_700_675_949),
        ] {
            let found = count(shown, n).interval();
            assert!((found.low - low).abs() < 1e-9, "{shown} of {n}: {found:?}");
            assert!(
                (found.high - high).abs() < 1e-9,
                "{shown} of {n}: {found:?}"
            );
        }
    }

    #[test]
    fn the_test_agrees_with_scipy() {
        // scipy.stats.fisher_exact([[k, n - k], [m, l - m]])
        for (a, b, p) in [
            // The lady tasting tea.
            (count(3, 4), count(1, 4), 0.485_714_285_714),
            // Convictions of twins (R, ?fisher.test).
            (count(2, 12), count(15, 18), 5.367_241_191e-4),
            (count(13, 20), count(7, 20), 0.112_833_775_483),
            (count(19, 20), count(8, 20), 4.316_250_145e-4),
            (count(30, 30), count(12, 30), 1.870_064_011e-7),
            (count(0, 30), count(0, 30), 1.0),
        ] {
            let found = fisher(a, b);
            assert!((found - p).abs() < 1e-9 * (1.0 + p), "{a:?} {b:?}: {found}");
        }
        assert_eq!(fisher(count(0, 0), count(3, 5)), 1.0);
    }
}
