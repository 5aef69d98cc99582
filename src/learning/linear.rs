//! The linear approximator: value = parameters . features (Thesis Eq. 2.20).

pub(super) use super::exponential::LANES;

/// `width` rounded up to whole groups of lanes; vectors are padded with zeros to it.
pub(super) fn padded(width: usize) -> usize {
    width.next_multiple_of(LANES)
}

/// The value of a parameter vector for a feature vector of the same padded length.
///
/// Sums run over sixteen lanes and are added in a fixed tree, whatever vectors the
/// processor has.
#[inline(always)]
pub(super) fn value(parameters: &[f32], features: &[f32]) -> f32 {
    let mut lanes = [0.0_f32; LANES];
    let groups = parameters
        .as_chunks::<LANES>()
        .0
        .iter()
        .zip(features.as_chunks::<LANES>().0);
    for (p, f) in groups {
        for lane in 0..LANES {
            lanes[lane] += p[lane] * f[lane];
        }
    }
    let mut width = LANES / 2;
    while width > 0 {
        for lane in 0..width {
            lanes[lane] += lanes[lane + width];
        }
        width /= 2;
    }
    lanes[0]
}

/// One gradient step: `parameters += step * features` (Thesis Eq. 2.19, 2.21).
#[inline(always)]
pub(super) fn learn(parameters: &mut [f32], features: &[f32], step: f32) {
    let groups = parameters
        .as_chunks_mut::<LANES>()
        .0
        .iter_mut()
        .zip(features.as_chunks::<LANES>().0);
    for (p, f) in groups {
        for lane in 0..LANES {
            p[lane] += step * f[lane];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_steps_agree_with_the_definition() {
        let features: Vec<f32> = (0..320).map(|i| (i % 7) as f32 / 7.0).collect();
        let mut parameters: Vec<f32> = (0..320).map(|i| (i % 5) as f32 - 2.0).collect();
        let exact = |parameters: &[f32]| -> f64 {
            let terms = parameters.iter().zip(&features);
            terms.map(|(&p, &f)| f64::from(p) * f64::from(f)).sum()
        };
        assert!((f64::from(value(&parameters, &features)) - exact(&parameters)).abs() < 1e-4);
        let expected = exact(&parameters) + 0.5 * exact(&features);
        learn(&mut parameters, &features, 0.5);
        assert!((exact(&parameters) - expected).abs() < 1e-4);
    }
}
