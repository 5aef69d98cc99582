//! Means, standard errors and confidence intervals.

use serde::Serialize;

/// A mean and its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mean {
    /// The mean.
    pub mean: f64,
    /// Half the width of the interval (Student's t); `None` for a single number.
    pub half_width: Option<f64>,
}

/// Returns the mean of `numbers` with its interval; `None` if there are none.
#[must_use]
pub fn mean(numbers: &[f64]) -> Option<Mean> {
    let n = numbers.len() as f64;
    if numbers.is_empty() {
        return None;
    }
    let mean = numbers.iter().sum::<f64>() / n;
    let squares: f64 = numbers.iter().map(|x| (x - mean) * (x - mean)).sum();
    let half_width =
        (numbers.len() > 1).then(|| student_t(n - 1.0) * libm::sqrt(squares / (n - 1.0) / n));
    Some(Mean { mean, half_width })
}

pub(super) fn mean_of(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len() as f64;
    values.sum::<f64>() / n
}

/// Returns the standard error of the mean of `(group, value)` pairs; `None` for fewer than two.
///
/// It follows a one-way random-effects model; a negative variance component counts as 0. With a
/// single group, the variance between groups is unknown and left out.
pub(super) fn standard_error(values: &[(usize, f64)]) -> Option<f64> {
    let n = values.len() as f64;
    if values.len() < 2 {
        return None;
    }
    let mean = values.iter().map(|(_, value)| value).sum::<f64>() / n;
    let total: f64 = values.iter().map(|(_, value)| (value - mean).powi(2)).sum();
    let groups = values
        .iter()
        .map(|(group, _)| group + 1)
        .max()
        .unwrap_or(1)
        .min(values.len());
    let between: f64 = (0..groups)
        .map(|group| {
            let members = values.iter().filter(|(of, _)| *of == group);
            let (count, sum) = members.fold((0.0, 0.0), |(c, s), (_, value)| (c + 1.0, s + value));
            if count == 0.0 {
                0.0
            } else {
                count * (sum / count - mean).powi(2)
            }
        })
        .sum();
    let simple = total / (n - 1.0) / n;
    let grouped = if groups > 1 {
        between / (groups as f64 - 1.0) / n
    } else {
        0.0
    };
    Some(simple.max(grouped).sqrt())
}

/// Returns the 97.5 % quantile of Student's t distribution.
///
/// From four degrees of freedom on it uses the Cornish-Fisher expansion (Abramowitz and Stegun
/// 26.7.5), which is accurate to 0.01; below, their Table 26.10.
fn student_t(degrees: f64) -> f64 {
    const FEW: [f64; 3] = [12.706, 4.303, 3.182];
    if let Some(&quantile) = FEW.get(degrees as usize - 1) {
        return quantile;
    }
    let z: f64 = 1.959_963_985;
    let (z3, z5, z7) = (z.powi(3), z.powi(5), z.powi(7));
    z + (z3 + z) / (4.0 * degrees)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * degrees.powi(2))
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * degrees.powi(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_tables() {
        for (degrees, quantile) in [
            (1.0, 12.706),
            (2.0, 4.303),
            (3.0, 3.182),
            (4.0, 2.776),
            (9.0, 2.262),
            (29.0, 2.045),
            (99.0, 1.984),
        ] {
            assert!((student_t(degrees) - quantile).abs() < 0.01, "{degrees}");
        }
        let five = mean(&[1.0, 2.0, 3.0, 4.0, 5.0]).unwrap();
        assert_eq!(five.mean, 3.0);
        // The standard error is the square root of 2.5 / 5.
        assert!((five.half_width.unwrap() - 2.776 * 0.5_f64.sqrt()).abs() < 0.02);
        assert_eq!(mean(&[7.0]).unwrap().half_width, None);
        assert_eq!(mean(&[]), None);
    }

    #[test]
    fn differences_between_groups_count_in_full() {
        let alike = [(0, 1.0), (1, 1.0), (0, 3.0), (1, 3.0)];
        // Variance 4/3 of four values.
        assert!((standard_error(&alike).unwrap() - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        let apart = [(0, 1.0), (1, 3.0), (0, 1.0), (1, 3.0)];
        // Two groups with means 1 and 3: variance 2 of the group means, over two groups.
        assert!((standard_error(&apart).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(standard_error(&[(0, 5.0)]), None);
    }
}
