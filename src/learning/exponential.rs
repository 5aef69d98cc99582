//! The exponential function on many single-precision numbers at once.
//!
//! `libm::expf` takes one number at a time and would be a third of a control step.
//! This is the same method - range reduction by ln 2, then a polynomial - written
//! so that the compiler turns it into vector instructions, with results that are
//! the same on every processor.

/// Numbers computed at once where there are many.
pub(super) const LANES: usize = 16;

/// Below this the exponential counts as its value here, about 1e-38.
const SMALLEST: f32 = -87.0;
/// Above this it would overflow.
const LARGEST: f32 = 88.0;
/// Adding and subtracting 1.5 * 2^23 rounds a small number to the nearest integer.
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
    5.000_000_1e-1,
];

/// Replaces every number by its exponential, to within two units in the last place
/// between -87 and 88; arguments outside are moved to these bounds.
#[inline(always)]
pub(super) fn exponentials<const N: usize>(numbers: &mut [f32; N]) {
    for number in numbers {
        let x = number.clamp(SMALLEST, LARGEST);
        let shifted = x * std::f32::consts::LOG2_E + ROUNDING;
        let power = shifted - ROUNDING;
        let r = x - power * LN2_HIGH - power * LN2_LOW;
        let mut p = POLYNOMIAL[0];
        for coefficient in &POLYNOMIAL[1..] {
            p = p * r + coefficient;
        }
        let mantissa = p * r * r + r + 1.0;
        // The low bits of `shifted` are the power as an integer.
        let exponent = shifted.to_bits().wrapping_add(127) << 23;
        *number = mantissa * f32::from_bits(exponent);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm_to_two_units_in_the_last_place() {
        let mut worst = 0.0_f64;
        for i in 0..200_000 {
            let x = -87.0 + 175.0 * (i as f32 / 200_000.0);
            let mut numbers = [x; LANES];
            exponentials(&mut numbers);
            let exact = libm::exp(f64::from(x));
            worst = worst.max((f64::from(numbers[3]) / exact - 1.0).abs());
        }
        assert!(worst < 2.0 * f64::from(f32::EPSILON), "{worst:e}");
        let mut numbers = [0.0; LANES];
        exponentials(&mut numbers);
        assert_eq!(numbers, [1.0; LANES]);
    }
}
