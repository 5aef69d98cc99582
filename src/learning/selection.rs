//! Softmax action selection with the epsilon-greedy switch (Thesis Eq. 2.12, 3.1).

use rand::RngExt;

use super::exponential::{LANES, exponentials};
use crate::random::Stream;
use crate::scenario::LearningModel;

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
    pub fn new(model: &LearningModel) -> Self {
        Self {
            probability_limit: model.probability_limit as f32,
            epsilon: model.epsilon as f32,
        }
    }

    /// Chooses one of `values` at a temperature; one random number is drawn.
    /// `values` is not empty.
    #[inline]
    pub fn choose(&self, values: &[f32], temperature: f32, rng: &mut Stream) -> usize {
        let draw = rng.random::<f32>();
        if values.len() <= LANES {
            let mut weights = [0.0; LANES];
            let (sum, greedy) = boltzmann(values, temperature, &mut weights);
            return self.pick(&weights[..values.len()], sum, greedy, draw);
        }
        let mut weights = vec![0.0; values.len()];
        let (sum, greedy) = boltzmann(values, temperature, &mut weights);
        self.pick(&weights, sum, greedy, draw)
    }

    /// Writes the probability with which each of `values` is chosen.
    pub fn probabilities(&self, values: &[f32], temperature: f32, out: &mut [f32]) {
        let count = values.len() as f32;
        let (sum, greedy) = boltzmann(values, temperature, out);
        if self.is_greedy(sum) {
            out.fill(self.epsilon / count);
            out[greedy] += 1.0 - self.epsilon;
        } else {
            for probability in out {
                *probability /= sum;
            }
        }
    }

    /// Whether the largest probability, which has weight 1, exceeds the limit.
    fn is_greedy(&self, sum: f32) -> bool {
        1.0 / sum > self.probability_limit
    }

    #[inline(always)]
    fn pick(&self, weights: &[f32], sum: f32, greedy: usize, draw: f32) -> usize {
        let last = weights.len() - 1;
        if self.is_greedy(sum) {
            return if draw < self.epsilon {
                uniform(draw / self.epsilon, weights.len())
            } else {
                greedy
            };
        }
        let mut left = draw * sum;
        for (index, weight) in weights.iter().enumerate() {
            left -= weight;
            if left < 0.0 {
                return index;
            }
        }
        last
    }
}

/// The index that a uniform draw from [0, 1) falls on.
#[inline(always)]
pub(super) fn uniform(draw: f32, count: usize) -> usize {
    ((draw * count as f32) as usize).min(count - 1)
}

/// Weights exp((value - largest) / temperature), their sum, and the index of the
/// largest value, the first of equals.
#[inline(always)]
fn boltzmann(values: &[f32], temperature: f32, weights: &mut [f32]) -> (f32, usize) {
    let mut greedy = 0;
    for (index, &value) in values.iter().enumerate() {
        if value > values[greedy] {
            greedy = index;
        }
    }
    let (largest, coldness) = (values[greedy], 1.0 / temperature);
    let mut sum = 0.0;
    for (values, weights) in values.chunks(LANES).zip(weights.chunks_mut(LANES)) {
        let mut lanes = [0.0; LANES];
        for (lane, value) in lanes.iter_mut().zip(values) {
            *lane = (value - largest) * coldness;
        }
        exponentials(&mut lanes);
        for ((weight, lane), _) in weights.iter_mut().zip(lanes).zip(values) {
            *weight = lane;
            sum += lane;
        }
    }
    (sum, greedy)
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
        let mut rng = stream(1, 0, 0, Purpose::Life);
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
