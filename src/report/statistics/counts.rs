//! Counts: exact intervals of a share, and the exact test of two.

use serde::Serialize;

use super::Interval;

/// How many of `n` show something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Count {
    /// Those that show it.
    pub shown: u64,
    /// All.
    pub n: u64,
}

impl Count {
    /// Counts.
    #[must_use]
    pub fn of(shows: impl IntoIterator<Item = bool>) -> Self {
        let (mut shown, mut n) = (0, 0);
        for one in shows {
            shown += u64::from(one);
            n += 1;
        }
        Self { shown, n }
    }

    /// The share; NaN of none.
    #[must_use]
    pub fn share(self) -> f64 {
        self.shown as f64 / self.n as f64
    }

    /// The exact 95 % interval of the share (C. J. Clopper and E. S. Pearson, Biometrika
    /// 26, 1934).
    #[must_use]
    pub fn interval(self) -> Interval {
        let Self { shown, n } = self;
        let tail = 0.025;
        let low = match shown {
            0 => 0.0,
            // The smallest share under which so many or more are not too rare.
            _ => bisect(|share| 1.0 - at_most(shown - 1, n, share) < tail),
        };
        let high = match shown == n {
            true => 1.0,
            false => bisect(|share| at_most(shown, n, share) > tail),
        };
        Interval { low, high }
    }
}

/// The largest share in [0, 1] for which `holds`, which holds for those below it.
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

/// Probability of at most `shown` of `n`, each with probability `share`.
fn at_most(shown: u64, n: u64, share: f64) -> f64 {
    let term = |k: u64| {
        let (k_, n_) = (k as f64, n as f64);
        libm::exp(ln_choose(n, k) + k_ * libm::log(share) + (n_ - k_) * libm::log1p(-share))
    };
    (0..=shown).map(term).sum()
}

/// Logarithm of the number of ways to choose `k` of `n`.
fn ln_choose(n: u64, k: u64) -> f64 {
    let ln_factorial = |m: u64| libm::lgamma(m as f64 + 1.0);
    ln_factorial(n) - ln_factorial(k) - ln_factorial(n - k)
}

/// Fisher's exact test, two-sided: the probability, if both shares were one, of a table
/// with these margins that is as improbable as this one or more. 1 where one is empty.
#[must_use]
pub fn fisher(a: Count, b: Count) -> f64 {
    let shown = a.shown + b.shown;
    let all = a.n + b.n;
    let probability =
        |k: u64| libm::exp(ln_choose(a.n, k) + ln_choose(b.n, shown - k) - ln_choose(all, shown));
    let observed = probability(a.shown);
    // As probable up to rounding is as probable.
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
    fn intervals_are_those_of_scipy() {
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
    fn the_test_is_that_of_scipy() {
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
