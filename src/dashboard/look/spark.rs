//! The course of a value in a few cells.

use super::signs::Signs;

/// Values from left to right as bars of a range, in at most so many columns: the mean of
/// the values that share a cell. Fewer values take fewer columns.
#[must_use]
pub fn sparkline(values: &[f64], [low, high]: [f64; 2], columns: usize, signs: &Signs) -> String {
    let cells = values.len().min(columns);
    let bars = (0..cells).map(|cell| {
        let from = cell * values.len() / cells;
        let part = &values[from..(cell + 1) * values.len() / cells];
        let mean = part.iter().sum::<f64>() / part.len() as f64;
        let share = (mean - low) / (high - low);
        let levels = signs.bars.len() - 2;
        let level = match share.is_finite() {
            true => (share.clamp(0.0, 1.0) * levels as f64).round() as usize,
            false => 0,
        };
        // What is there is never a blank.
        signs.bars[1 + level.min(levels)]
    });
    bars.collect()
}

#[cfg(test)]
mod tests {
    use super::super::signs::UNICODE;
    use super::*;

    #[test]
    fn the_range_is_from_the_lowest_bar_to_the_highest() {
        let line = |values: &[f64], columns| sparkline(values, [0.0, 7.0], columns, &UNICODE);
        assert_eq!(
            line(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], 20),
            "▁▂▃▄▅▆▇█"
        );
        assert_eq!(line(&[0.0, 0.0, 7.0, 7.0, 0.0, 0.0], 3), "▁█▁");
        assert_eq!(line(&[-9.0, 99.0, f64::NAN], 3), "▁█▁");
        assert_eq!(line(&[], 3), "");
        assert_eq!(line(&[1.0], 0), "");
        assert_eq!(sparkline(&[5.0, 5.0], [5.0, 5.0], 9, &UNICODE), "▁▁");
    }
}
