//! The exponential function on vectors of single-precision numbers.
//!
//! `libm::expf` takes one number at a time and would cost a third of a control step. This
//! is the same method on vectors: range reduction by ln 2, then a polynomial. Results are
//! the same on every processor.

use pulp::Simd;
use pulp::bytemuck::cast;

/// Smaller arguments are raised to this one, where the exponential is about 1e-38.
const SMALLEST: f32 = -87.0;
/// Larger arguments are lowered to this one. Their exponentials would overflow.
const LARGEST: f32 = 88.0;
/// 1.5 * 2^23: adding and subtracting it rounds a small number to the nearest integer.
const ROUNDING: f32 = 12_582_912.0;
/// ln 2 in two parts, the first with so few bits that its small multiples are exact.
const LN2_HIGH: f32 = 0.693_359_4;
const LN2_LOW: f32 = -2.121_944_4e-4;
/// Minimax polynomial of (exp(r) - 1 - r) / r^2 on [-ln 2 / 2, ln 2 / 2], highest
/// power first; the coefficients are those of the Cephes library's `expf`.
const POLYNOMIAL: [f32; 6] = [
    1.987_569_1e-4,
    1.398_199_9e-3,
    8.333_452e-3,
    4.166_579_6e-2,
    1.666_666_5e-1,
    5e-1,
];

/// Returns the exponentials of `numbers`, to within two units in the last place.
///
/// Arguments outside -87 to 88 are moved to these bounds.
#[inline(always)]
pub(super) fn exponentials<S: Simd>(simd: S, numbers: S::f32s) -> S::f32s {
    let splat = |number| simd.splat_f32s(number);
    let times = |a, b| simd.mul_f32s(a, b);
    let plus = |a, b| simd.add_f32s(a, b);
    let x = simd.min_f32s(simd.max_f32s(numbers, splat(SMALLEST)), splat(LARGEST));
    let shifted = plus(times(x, splat(std::f32::consts::LOG2_E)), splat(ROUNDING));
    let power = simd.sub_f32s(shifted, splat(ROUNDING));
    let r = simd.sub_f32s(x, times(power, splat(LN2_HIGH)));
    let r = simd.sub_f32s(r, times(power, splat(LN2_LOW)));
    let mut p = splat(POLYNOMIAL[0]);
    for &coefficient in &POLYNOMIAL[1..] {
        p = plus(times(p, r), splat(coefficient));
    }
    let mantissa = plus(plus(times(times(p, r), r), r), splat(1.0));
    // The low bits of `shifted` are the power as an integer.
    let biased = simd.add_u32s(cast(shifted), simd.splat_u32s(127));
    let exponent = simd.wrapping_dyn_shl_u32s(biased, simd.splat_u32s(23));
    times(mantissa, cast(exponent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Arch, Scalar, WithSimd};

    struct Map<'a>(&'a mut [f32]);

    impl WithSimd for Map<'_> {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            for numbers in S::as_mut_simd_f32s(self.0).0 {
                *numbers = exponentials(simd, *numbers);
            }
        }
    }

    #[test]
    fn agrees_with_libm_to_two_units_in_the_last_place() {
        let arguments: Vec<f32> = (0..200_000)
            .map(|i| -87.0 + 175.0 * (i as f32 / 2e5))
            .collect();
        let mut numbers = arguments.clone();
        Map(&mut numbers).with_simd(Scalar);
        let mut worst = 0.0_f64;
        for (number, x) in numbers.iter().zip(&arguments) {
            worst = worst.max((f64::from(*number) / libm::exp(f64::from(*x)) - 1.0).abs());
        }
        assert!(worst < 2.0 * f64::from(f32::EPSILON), "{worst:e}");
        let mut wide = arguments;
        Arch::new().dispatch(Map(&mut wide));
        assert_eq!(numbers, wide, "every vector width gives the same bits");
        assert_eq!(exponentials(Scalar, 0.0), 1.0);
    }
}
