//! The speed of a run, and an upper bound of the time left.

use std::collections::VecDeque;
use std::time::Duration;

/// Time window over which the rate of control steps is averaged.
const WINDOW: Duration = Duration::from_secs(3);

/// The speed of a run, measured in the time of ticks while evolution is not paused.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    running: Duration,
    steps: VecDeque<(Duration, u64)>,
    generations: Option<[(Duration, u64); 2]>,
}

impl Pace {
    /// Adds time in which evolution was running.
    pub(in crate::dashboard) fn tick(&mut self, elapsed: Duration) {
        self.running += elapsed;
    }

    /// Records the number of control steps computed so far.
    pub(in crate::dashboard) fn steps(&mut self, steps: u64) {
        let now = self.running;
        match self.steps.back_mut() {
            Some((at, last)) if *at == now => *last = steps,
            _ => self.steps.push_back((now, steps)),
        }
        while self.steps.len() > 2 && self.steps.front().is_some_and(|(at, _)| now - *at > WINDOW) {
            self.steps.pop_front();
        }
    }

    /// Records the end of a generation.
    pub(in crate::dashboard) fn generation(&mut self, number: u64) {
        let now = (self.running, number);
        self.generations = Some(match self.generations {
            // Generations that arrive at once are the past of a resumed run.
            Some([first, _]) if first.0 < now.0 => [first, now],
            _ => [now, now],
        });
    }

    /// Returns control steps per second, or `None` before there is anything to measure.
    #[must_use]
    pub fn steps_per_second(&self) -> Option<f64> {
        let ((from, first), (to, last)) = (self.steps.front()?, self.steps.back()?);
        let seconds = to.checked_sub(*from)?.as_secs_f64();
        (seconds > 0.0).then(|| last.saturating_sub(*first) as f64 / seconds)
    }

    /// Returns the time until the end of a generation, at the pace so far.
    #[must_use]
    pub fn time_to(&self, generation: u64) -> Option<Duration> {
        let [(from, first), (to, last)] = self.generations?;
        let lived = last.checked_sub(first).filter(|&lived| lived > 0)?;
        let each = (to - from).as_secs_f64() / lived as f64;
        let left = each * generation.saturating_sub(last) as f64;
        Duration::try_from_secs_f64(left).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waiting_does_not_count_and_the_past_says_nothing() {
        let mut pace = Pace::default();
        for generation in 1..=5 {
            pace.generation(generation);
        }
        assert_eq!(pace.time_to(20), None);
        pace.steps(1000);
        pace.tick(Duration::from_secs(2));
        pace.steps(5000);
        pace.generation(6);
        assert_eq!(pace.steps_per_second(), Some(2000.0));
        assert_eq!(pace.time_to(16), Some(Duration::from_secs(20)));
    }
}
