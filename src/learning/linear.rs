//! The linear approximator: value = parameters . features (Thesis Eq. 2.20).
//!
//! The loops run on the widest vectors of the processor, which `pulp` chooses at run time.
//! Lane l of 32 holds the sum over the features l, l + 32, ..., and the lanes are added in
//! a fixed tree, so the result is the same for every vector width.

use pulp::{Arch, Simd, WithSimd};

/// The number of lanes of a sum, whatever vectors the processor has.
const LANES: usize = 32;

/// Returns `width` rounded up to whole groups of lanes. Vectors are padded with zeros to
/// this length.
pub(super) fn padded(width: usize) -> usize {
    width.next_multiple_of(LANES)
}

/// Returns the value of a parameter vector for a feature vector of the same padded length.
#[inline]
pub(super) fn value(parameters: &[f32], features: &[f32]) -> f32 {
    Arch::new().dispatch(Value {
        parameters,
        features,
    })
}

/// The parameters of several vectors for one feature.
pub(super) type Row = [f32; ROW];

/// Parameter vectors that are evaluated at once.
pub(super) const ROW: usize = 8;

/// Features that are processed at once, in sums that do not depend on each other.
pub(super) const STRIDE: usize = 4;

/// Returns the values of up to eight parameter vectors, which are given as one row for
/// each feature.
#[inline]
pub(super) fn values(rows: &[Row], features: &[f32]) -> Row {
    Arch::new().dispatch(Values { rows, features })
}

struct Value<'a> {
    parameters: &'a [f32],
    features: &'a [f32],
}

impl WithSimd for Value<'_> {
    type Output = f32;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f32 {
        dot(simd, self.parameters, self.features)
    }
}

struct Values<'a> {
    rows: &'a [Row],
    features: &'a [f32],
}

impl WithSimd for Values<'_> {
    type Output = Row;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Row {
        let mut sums = [[simd.splat_f32s(0.0); ROW]; STRIDE];
        let rows = self.rows.as_chunks::<STRIDE>().0;
        let features = self.features.as_chunks::<STRIDE>().0;
        for (rows, features) in rows.iter().zip(features) {
            for ((row, &feature), sums) in rows.iter().zip(features).zip(&mut sums) {
                let feature = simd.splat_f32s(feature);
                for (parameters, sum) in S::as_simd_f32s(row).0.iter().zip(sums) {
                    *sum = simd.add_f32s(*sum, simd.mul_f32s(feature, *parameters));
                }
            }
        }
        let mut values = [0.0; ROW];
        let [a, b, c, d] = sums;
        for (register, value) in S::as_mut_simd_f32s(&mut values).0.iter_mut().enumerate() {
            let (even, odd) = (
                simd.add_f32s(a[register], c[register]),
                simd.add_f32s(b[register], d[register]),
            );
            *value = simd.add_f32s(even, odd);
        }
        values
    }
}

/// Gradient steps on C~ and C of a child, in successive states.
pub(super) struct GradientSteps<'a, F> {
    /// The parameters of C~ and of C.
    pub(super) parameters: [&'a mut [f32]; 2],
    /// The features of the states, the most recent state last.
    pub(super) features: &'a [f32],
    /// The targets of C~ and C in each state, the most recent state first.
    pub(super) targets: &'a [[f32; 2]],
    pub(super) learning_rate: f32,
    /// Called with the number of more recent states and the errors of C~ and C.
    pub(super) watch: F,
}

impl<F: FnMut(usize, [f32; 2])> GradientSteps<'_, F> {
    /// Learns from all states, the most recent first.
    #[inline]
    pub(super) fn run(self) {
        Arch::new().dispatch(self);
    }
}

impl<F: FnMut(usize, [f32; 2])> WithSimd for GradientSteps<'_, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let [inside, outside] = self.parameters;
        let width = inside.len();
        let mut rest = self.features;
        for (recent, target) in self.targets.iter().enumerate() {
            let (others, features) = rest.split_at(rest.len() - width);
            rest = others;
            let errors = [
                target[0] - dot(simd, inside, features),
                target[1] - dot(simd, outside, features),
            ];
            add(simd, inside, features, self.learning_rate * errors[0]);
            add(simd, outside, features, self.learning_rate * errors[1]);
            (self.watch)(recent, errors);
        }
    }
}

/// Returns the number of registers that make up all lanes.
#[inline(always)]
fn registers<S: Simd>() -> usize {
    LANES / S::F32_LANES
}

/// Returns the scalar product of two vectors of the same padded length.
#[inline(always)]
fn dot<S: Simd>(simd: S, parameters: &[f32], features: &[f32]) -> f32 {
    // Written in registers: left alone, the compiler makes half-empty vectors of it.
    let mut sums = [simd.splat_f32s(0.0); LANES];
    let parameters = S::as_simd_f32s(parameters).0;
    let features = S::as_simd_f32s(features).0;
    let groups = parameters
        .chunks_exact(registers::<S>())
        .zip(features.chunks_exact(registers::<S>()));
    for (parameters, features) in groups {
        for ((sum, p), f) in sums.iter_mut().zip(parameters).zip(features) {
            *sum = simd.add_f32s(*sum, simd.mul_f32s(*p, *f));
        }
    }
    total(simd, &mut sums[..registers::<S>()])
}

/// Returns the sum over all lanes of some registers, added in a fixed tree. The number of
/// registers is a power of two.
#[inline(always)]
pub(super) fn total<S: Simd>(simd: S, sums: &mut [S::f32s]) -> f32 {
    let mut width = sums.len();
    while width > 1 {
        width /= 2;
        for register in 0..width {
            sums[register] = simd.add_f32s(sums[register], sums[register + width]);
        }
    }
    let mut lanes = [0.0; LANES];
    let lanes = &mut lanes[..S::F32_LANES];
    lanes.copy_from_slice(pulp::bytemuck::cast_slice(&sums[..1]));
    let mut width = S::F32_LANES;
    while width > 1 {
        width /= 2;
        for lane in 0..width {
            lanes[lane] += lanes[lane + width];
        }
    }
    lanes[0]
}

/// `parameters += step * features`, for vectors of the same padded length.
#[inline(always)]
fn add<S: Simd>(simd: S, parameters: &mut [f32], features: &[f32], step: f32) {
    let step = simd.splat_f32s(step);
    let parameters = S::as_mut_simd_f32s(parameters).0;
    for (p, f) in parameters.iter_mut().zip(S::as_simd_f32s(features).0) {
        *p = simd.add_f32s(*p, simd.mul_f32s(step, *f));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::Scalar;

    #[test]
    fn values_and_steps_agree_with_the_definition() {
        let features: Vec<f32> = (0..320).map(|i| (i % 7) as f32 / 7.0).collect();
        let mut parameters: Vec<f32> = (0..320).map(|i| (i % 5) as f32 - 2.0).collect();
        let exact = |parameters: &[f32]| -> f64 {
            let terms = parameters.iter().zip(&features);
            terms.map(|(&p, &f)| f64::from(p) * f64::from(f)).sum()
        };
        assert!((f64::from(value(&parameters, &features)) - exact(&parameters)).abs() < 1e-4);
        let narrow = dot(Scalar, &parameters, &features);
        assert_eq!(
            value(&parameters, &features),
            narrow,
            "every vector width gives the same bits"
        );
        let expected = exact(&parameters) + 0.5 * exact(&features);
        add(Scalar, &mut parameters, &features, 0.5);
        assert!((exact(&parameters) - expected).abs() < 1e-4);
    }

    #[test]
    fn rows_give_the_values_of_their_columns() {
        let features: Vec<f32> = (0..12).map(|i| i as f32 / 12.0).collect();
        let rows: Vec<Row> = (0..12)
            .map(|i| std::array::from_fn(|column| (i * column) as f32))
            .collect();
        let all = values(&rows, &features);
        for (column, value) in all.iter().enumerate() {
            let terms = rows.iter().zip(&features).map(|(row, f)| row[column] * f);
            assert!((value - terms.sum::<f32>()).abs() < 1e-3);
        }
        let narrow = Values {
            rows: &rows,
            features: &features,
        };
        assert_eq!(
            all,
            narrow.with_simd(Scalar),
            "every vector width gives the same bits"
        );
    }
}
