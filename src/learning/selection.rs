//! Softmax action selection with the epsilon-greedy switch (Thesis Eq. 2.12, 3.1).

use pulp::{Arch, Simd, WithSimd};
use rand::RngExt;

use super::exponential::exponentials;
use crate::random::Stream;
use crate::scenario::LearningSettings;

/// Few children, few actions: more lanes would mostly be empty.
const LANES: usize = 8;

/// How one of several is chosen in a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectionRule {
    /// There is no other.
    OnlyChoice,
    /// All alike: the control `composite_choice: random`.
    Uniform,
    /// By softmax (Thesis Eq. 2.12).
    Softmax,
    /// Epsilon-greedy, as the largest softmax probability exceeds the limit.
    EpsilonGreedy,
}

/// Softmax selection that gives way to epsilon-greedy selection where the largest
/// probability exceeds a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softmax {
    /// Largest probability (rho limit) that softmax may give.
    pub probability_limit: f32,
    /// Probability of a random choice otherwise.
    pub epsilon: f32,
}

impl Softmax {
    /// The selection of a scenario.
    #[must_use]
    pub fn new(settings: &LearningSettings) -> Self {
        Self {
            probability_limit: settings.probability_limit as f32,
            epsilon: settings.epsilon as f32,
        }
    }

    /// Chooses one of `values` at a temperature; one random number is drawn.
    /// `values` is not empty.
    #[inline]
    pub fn choose(&self, values: &[f32], temperature: f32, rng: &mut Stream) -> usize {
        let draw = rng.random::<f32>();
        if values.len() > LANES {
            return self.pick(values, &mut in_lanes(values), temperature, draw);
        }
        self.pick(values, &mut few_in_lanes(values), temperature, draw)
    }

    /// Writes the probability with which each of `values` is chosen, and says by which
    /// rule.
    pub fn probabilities(
        &self,
        values: &[f32],
        temperature: f32,
        out: &mut [f32],
    ) -> SelectionRule {
        match values.len() > LANES {
            true => self.weigh(values, &mut in_lanes(values), temperature, out),
            false => self.weigh(values, &mut few_in_lanes(values), temperature, out),
        }
    }

    /// Writes the probabilities of `values`, which `weights` holds in whole lanes.
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

    /// Whether the largest probability, which has weight 1, exceeds the limit.
    fn is_greedy(&self, sum: f32) -> bool {
        1.0 / sum > self.probability_limit
    }

    /// Chooses one of `values`, which `weights` holds in whole lanes.
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
        // Counted, not searched: no processor can predict where a search would end.
        let passed = weights
            .iter()
            .map(|&sum_so_far| usize::from(sum_so_far <= draw * sum));
        passed.sum::<usize>().min(values.len() - 1)
    }
}

/// The index that a uniform draw from [0, 1) falls on.
#[inline(always)]
pub(super) fn uniform(draw: f32, count: usize) -> usize {
    ((draw * count as f32) as usize).min(count - 1)
}

/// The values in whole lanes, the empty ones as unlikely as can be.
fn in_lanes(values: &[f32]) -> Vec<f32> {
    let mut lanes = values.to_vec();
    lanes.resize(values.len().next_multiple_of(LANES), f32::NEG_INFINITY);
    lanes
}

/// The same for no more values than lanes, without asking for memory.
#[inline(always)]
fn few_in_lanes(values: &[f32]) -> [f32; LANES] {
    let mut lanes = [f32::NEG_INFINITY; LANES];
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

/// The place of the largest value, the first of equals.
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
