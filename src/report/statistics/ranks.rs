//! Comparison of two samples by ranks.

/// Total sample size up to which the test is exact. Above it, the normal approximation is as
/// good.
const MAX_EXACT: usize = 120;

/// Returns the probability that a random value of `a` is smaller, and so better, than a random
/// value of `b`. Ties count half. NaN if either sample is empty.
#[must_use]
pub fn probability_of_improvement(a: &[f64], b: &[f64]) -> f64 {
    let one = |x: f64, y: f64| match x.total_cmp(&y) {
        std::cmp::Ordering::Less => 1.0,
        std::cmp::Ordering::Equal => 0.5,
        std::cmp::Ordering::Greater => 0.0,
    };
    let pairs = a.iter().flat_map(|&x| b.iter().map(move |&y| one(x, y)));
    pairs.sum::<f64>() / (a.len() * b.len()) as f64
}

/// Returns the two-sided p-value of the Mann-Whitney test: the probability, if both samples come
/// from one distribution, of a rank sum at least as far from its expectation as the observed
/// one.
///
/// For up to 120 values in total the p-value is exact, conditional on the ties. For more it is
/// the normal approximation with corrections for ties and continuity. 1 if either sample is
/// empty.
#[must_use]
pub fn mann_whitney(a: &[f64], b: &[f64]) -> f64 {
    if a.is_empty() || b.is_empty() {
        return 1.0;
    }
    let ranks = doubled_ranks(&[a, b].concat());
    let observed: usize = ranks[..a.len()].iter().sum();
    if ranks.len() <= MAX_EXACT {
        exact(&ranks, a.len(), observed)
    } else {
        approximate(&ranks, a.len(), observed)
    }
}

/// Returns twice the mid-rank of each value, which is an integer.
fn doubled_ranks(values: &[f64]) -> Vec<usize> {
    let count = |of: &dyn Fn(&f64) -> bool| values.iter().filter(|&v| of(v)).count();
    let rank = |value: &f64| {
        let below = count(&|other| other.total_cmp(value).is_lt());
        let equal = count(&|other| other.total_cmp(value).is_eq());
        2 * below + equal + 1
    };
    values.iter().map(rank).collect()
}

/// Returns the share, among all choices of `size` of the ranks, of those whose sum is at least
/// as far from the expectation as `observed`.
fn exact(ranks: &[usize], size: usize, observed: usize) -> f64 {
    let total: usize = ranks.iter().sum();
    // ways[k][s]: number of choices of k of the ranks so far with sum s.
    let mut ways = vec![vec![0.0_f64; total + 1]; size + 1];
    ways[0][0] = 1.0;
    for &rank in ranks {
        for chosen in (1..=size).rev() {
            let (fewer, more) = ways.split_at_mut(chosen);
            let (from, to) = (&fewer[chosen - 1], &mut more[0]);
            for sum in rank..=total {
                to[sum] += from[sum - rank];
            }
        }
    }
    // Distances from the expectation, times the number of ranks, are integers.
    let distance = |sum: usize| (sum * ranks.len()).abs_diff(size * total);
    let far = distance(observed);
    let all: f64 = ways[size].iter().sum();
    let sums = ways[size].iter().enumerate();
    let as_far: f64 = sums
        .filter(|(sum, _)| distance(*sum) >= far)
        .map(|(_, ways)| ways)
        .sum();
    as_far / all
}

fn approximate(ranks: &[usize], size: usize, observed: usize) -> f64 {
    let n = ranks.len() as f64;
    let (m, l) = (size as f64, n - size as f64);
    let mut sorted = ranks.to_vec();
    sorted.sort_unstable();
    let ties = sorted.chunk_by(|x, y| x == y).map(|tied| {
        let t = tied.len() as f64;
        t * t * t - t
    });
    let variance = m * l / 12.0 * (n + 1.0 - ties.sum::<f64>() / (n * (n - 1.0)));
    if variance <= 0.0 {
        return 1.0;
    }
    let expected = m * (n + 1.0) / 2.0;
    let away = ((observed as f64 / 2.0 - expected).abs() - 0.5).max(0.0);
    libm::erfc(away / (2.0 * variance).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_test_agrees_with_scipy() {
        // Hollander and Wolfe (1973), p. 69f.; scipy.stats.mannwhitneyu(method='exact').
        let a = [0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46];
        let b = [1.15, 0.88, 0.90, 0.74, 1.21];
        assert!((mann_whitney(&a, &b) - 0.254_412_254_412).abs() < 1e-10);
        // With ties: all 6435 choices, counted by numpy.
        let a = [4.0, 4.0, 5.0, 5.0, 5.0, 3.0, 2.0, 6.0];
        let b = [4.0, 5.0, 6.0, 6.0, 7.0, 7.0, 5.0];
        assert!((mann_whitney(&a, &b) - 0.059_984_459_985).abs() < 1e-10);
        assert_eq!(mann_whitney(&[1.0; 30], &[1.0; 30]), 1.0);
        assert_eq!(mann_whitney(&[], &[1.0]), 1.0);
    }

    #[test]
    fn the_exact_and_the_approximate_test_agree() {
        let a: Vec<_> = (1..=60).map(f64::from).collect();
        let b: Vec<_> = a.iter().map(|value| value + 12.5).collect();
        let ranks = doubled_ranks(&[a.clone(), b.clone()].concat());
        let observed = ranks[..60].iter().sum();
        // scipy: method='exact' and method='asymptotic'.
        assert!((exact(&ranks, 60, observed) - 3.586_997_4e-4).abs() < 1e-9);
        assert!((approximate(&ranks, 60, observed) - 4.243_453_4e-4).abs() < 1e-9);
        let ranks = doubled_ranks(&[
            4.0, 4.0, 5.0, 5.0, 5.0, 3.0, 2.0, 6.0, 4.0, 5.0, 6.0, 6.0, 7.0, 7.0, 5.0,
        ]);
        let observed = ranks[..8].iter().sum();
        assert!((approximate(&ranks, 8, observed) - 0.049_884_436_98).abs() < 1e-9);
    }

    #[test]
    fn a_smaller_value_is_an_improvement() {
        assert_eq!(probability_of_improvement(&[1.0, 2.0], &[3.0]), 1.0);
        assert_eq!(probability_of_improvement(&[3.0], &[3.0]), 0.5);
        assert_eq!(probability_of_improvement(&[1.0, 4.0], &[2.0, 3.0]), 0.5);
    }
}
