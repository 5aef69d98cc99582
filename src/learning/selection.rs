//! Softmax selection that switches to epsilon-greedy selection (Thesis Eq. 2.12, 3.1).

use pulp::{Arch, Simd, WithSimd};
use rand::RngExt;

use super::exponential::exponentials;
use crate::random::Stream;
use crate::scenario::LearningSettings;

/// Lanes of a vector. There are few children and few actions: more lanes would mostly be
/// empty.
const LANES: usize = 8;
/// Room for the most children and actions of the scenarios that the program ships. More take an
/// allocation for each choice.
const MANY: usize = 4 * LANES;

/// The rule by which one of several children or actions is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectionRule {
    /// There is only one to choose.
    OnlyChoice,
    /// All are equally likely: the control `composite_choice: random`.
    Uniform,
    /// Softmax (Thesis Eq. 2.12).
    Softmax,
    /// Epsilon-greedy, because the largest softmax probability exceeds the limit.
    EpsilonGreedy,
}

/// Softmax selection, replaced by epsilon-greedy selection where the largest probability
/// exceeds a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softmax {
    /// The largest probability that softmax may give (rho limit).
    pub probability_limit: f32,
    /// The probability of a random choice in epsilon-greedy selection.
    pub epsilon: f32,
}

impl Softmax {
    /// Makes the selection of a scenario.
    #[must_use]
    pub fn new(settings: &LearningSettings) -> Self {
        Self {
            probability_limit: settings.probability_limit as f32,
            epsilon: settings.epsilon as f32,
        }
    }

    /// Chooses one of `values` at a temperature, with one random number. `values` must not
    /// be empty.
    #[inline]
    pub fn choose(&self, values: &[f32], temperature: f32, rng: &mut Stream) -> usize {
        let draw = rng.random::<f32>();
        if values.len() <= LANES {
            self.pick(values, &mut in_lanes::<LANES>(values), temperature, draw)
        } else if values.len() <= MANY {
            let lanes = &mut in_lanes::<MANY>(values)[..whole_lanes(values)];
            self.pick(values, lanes, temperature, draw)
        } else {
            self.pick(values, &mut in_new_lanes(values), temperature, draw)
        }
    }

    /// Writes the probability of choosing each of `values` to `out`, and returns the rule.
    pub fn probabilities(
        &self,
        values: &[f32],
        temperature: f32,
        out: &mut [f32],
    ) -> SelectionRule {
        if values.len() <= LANES {
            self.weigh(values, &mut in_lanes::<LANES>(values), temperature, out)
        } else if values.len() <= MANY {
            let lanes = &mut in_lanes::<MANY>(values)[..whole_lanes(values)];
            self.weigh(values, lanes, temperature, out)
        } else {
            self.weigh(values, &mut in_new_lanes(values), temperature, out)
        }
    }

    /// Writes the probabilities of `values`. `weights` holds the same values in whole lanes.
    fn weigh(
        &self,
        values: &[f32],
        weights: &mut [f32],
        temperature: f32,
        out: &mut [f32],
    ) -> SelectionRule {
        let count = values.len() as f32;
        boltzmann(weights, temperature);
        let sum = weights.iter().sum();
        if self.is_greedy(sum) {
            out.fill(self.epsilon / count);
            out[greedy(values)] += 1.0 - self.epsilon;
            SelectionRule::EpsilonGreedy
        } else {
            for (probability, weight) in out.iter_mut().zip(weights) {
                *probability = *weight / sum;
            }
            SelectionRule::Softmax
        }
    }

    /// Returns whether the largest probability exceeds the limit. Its weight is 1.
    fn is_greedy(&self, sum: f32) -> bool {
        1.0 / sum > self.probability_limit
    }

    /// Chooses one of `values`. `weights` holds the same values in whole lanes.
    #[inline(always)]
    fn pick(&self, values: &[f32], weights: &mut [f32], temperature: f32, draw: f32) -> usize {
        boltzmann(weights, temperature);
        let mut sum = 0.0;
        for weight in &mut *weights {
            sum += *weight;
            *weight = sum;
        }
        if self.is_greedy(sum) {
            return if draw < self.epsilon {
                uniform(draw / self.epsilon, values.len())
            } else {
                greedy(values)
            };
        }
        // Counted, not searched: the end of a search could not be predicted.
        let passed = weights
            .iter()
            .map(|&sum_so_far| usize::from(sum_so_far <= draw * sum));
        passed.sum::<usize>().min(values.len() - 1)
    }
}

/// Returns the index that a uniform draw from [0, 1) falls on.
#[inline(always)]
pub(super) fn uniform(draw: f32, count: usize) -> usize {
    ((draw * count as f32) as usize).min(count - 1)
}

/// Returns the values in whole lanes. Empty lanes have probability 0.
fn in_new_lanes(values: &[f32]) -> Vec<f32> {
    let mut lanes = values.to_vec();
    lanes.resize(whole_lanes(values), f32::NEG_INFINITY);
    lanes
}

/// Returns the number of values, rounded up to whole vectors.
fn whole_lanes(values: &[f32]) -> usize {
    values.len().next_multiple_of(LANES)
}

/// The same for at most `N` values, without an allocation.
#[inline(always)]
fn in_lanes<const N: usize>(values: &[f32]) -> [f32; N] {
    let mut lanes = [f32::NEG_INFINITY; N];
    for (lane, value) in lanes.iter_mut().zip(values) {
        *lane = *value;
    }
    lanes
}

/// Replaces values in whole lanes by the weights exp((value - largest) / temperature).
#[inline]
fn boltzmann(values: &mut [f32], temperature: f32) {
    Arch::new().dispatch(Boltzmann {
        values,
        temperature,
    });
}

struct Boltzmann<'a> {
    values: &'a mut [f32],
    temperature: f32,
}

impl WithSimd for Boltzmann<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let larger = |a: f32, &b: &f32| if b > a { b } else { a };
        let largest = self.values.iter().fold(f32::NEG_INFINITY, larger);
        let largest = simd.splat_f32s(largest);
        let coldness = simd.splat_f32s(1.0 / self.temperature);
        for values in S::as_mut_simd_f32s(self.values).0 {
            let exponents = simd.mul_f32s(simd.sub_f32s(*values, largest), coldness);
            *values = exponentials(simd, exponents);
        }
    }
}

/// Returns the index of the largest value, the first of equals.
#[inline(always)]
fn greedy(values: &[f32]) -> usize {
    let mut best = 0;
    for (index, &value) in values.iter().enumerate() {
        best = if value > values[best] { index } else { best };
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Purpose, stream};

    const SOFTMAX: Softmax = Softmax {
        probability_limit: 0.98,
        epsilon: 0.02,
    };

    fn frequencies(values: &[f32], temperature: f32) -> Vec<f64> {
        let mut rng = stream(1, 0, 0, Purpose::Trials);
        let mut counts = vec![0.0; values.len()];
        for _ in 0..200_000 {
            counts[SOFTMAX.choose(values, temperature, &mut rng)] += 1.0 / 200_000.0;
        }
        counts
    }

    fn probabilities(values: &[f32], temperature: f32) -> Vec<f32> {
        let mut out = vec![0.0; values.len()];
        SOFTMAX.probabilities(values, temperature, &mut out);
        out
    }

    #[test]
    fn probabilities_are_boltzmann_until_the_limit() {
        let p = probabilities(&[-1.0, 0.0, -2.0], 2.0);
        let weights = [-0.5_f64, 0.0, -1.0].map(f64::exp);
        let sum: f64 = weights.iter().sum();
        for (p, weight) in p.iter().zip(weights) {
            assert!((f64::from(*p) - weight / sum).abs() < 1e-6);
        }
        // At temperature 0.05 the best would have probability 0.9999...
        let p = probabilities(&[-1.0, 0.0], 0.05);
        assert!((p[0] - 0.01).abs() < 1e-6 && (p[1] - 0.99).abs() < 1e-6);
    }

    #[test]
    fn choices_follow_the_probabilities() {
        let many: Vec<f32> = (0..40).map(|i| -(i as f32) / 20.0).collect();
        for (values, temperature) in [
            (&[-1.0, 0.0, -2.0][..], 2.0),
            (&[-1.0, 0.0][..], 0.05),
            (&[0.5; 5][..], 0.1),
            (&many[..], 1.0),
        ] {
            let expected = probabilities(values, temperature);
            for (frequency, p) in frequencies(values, temperature).iter().zip(expected) {
                assert!((frequency - f64::from(p)).abs() < 0.005);
            }
        }
    }
}
