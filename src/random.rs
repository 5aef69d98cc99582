//! Random streams that depend on what they are for and on nothing else.
//!
//! A stream is named by the seed of the run, the generation, the individual and
//! the [`Purpose`]; these four numbers are the key of a ChaCha8 generator. No
//! stream is ever shared between individuals or threads, so the order in which
//! individuals are computed cannot change a bit of the result.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The generator behind every random decision: portable and, keyed as here,
/// independent between streams. Eight rounds are far beyond what a simulation
/// can tell from chance, and twice as fast as twenty.
pub type Stream = ChaCha8Rng;

/// What a random stream is used for.
///
/// The discriminants are part of the meaning of a seed: changing one changes the
/// result of every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Training of one primitive subtask before evolution starts.
    PrimitiveTraining = 1,
    /// The states at which selection probabilities are measured.
    PolicySamples = 2,
    /// The start poses of a generation's trials.
    StartPoses = 3,
    /// One individual's generation: the order of its trials, noise and choices.
    Trials = 4,
    /// Selection and crossover after a generation.
    Breeding = 5,
    /// The chance that replaces fitness under `selection: random`.
    RandomRank = 6,
    /// One repeat of `evaluate`.
    Evaluation = 7,
    /// A rollout that somebody watches.
    Watching = 8,
    /// The noise of readings all over a policy map.
    PolicyMap = 9,
    /// Resampling for the interval of a statistic.
    Bootstrap = 10,
}

/// The stream for `purpose` in the given run, generation and individual.
///
/// `individual` is whatever numbers the parallel pieces of work: an individual,
/// a primitive subtask, a repeat.
#[must_use]
pub fn stream(seed: u64, generation: u64, individual: u64, purpose: Purpose) -> Stream {
    let mut key = [0; 32];
    let words = [seed, generation, individual, purpose as u64];
    for (bytes, word) in key.chunks_exact_mut(8).zip(words) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    Stream::from_seed(key)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;
    use std::collections::HashSet;

    #[test]
    fn neighbouring_streams_differ_and_repeat() {
        let mut seen = HashSet::new();
        for seed in 0..4 {
            for generation in 0..4 {
                for individual in 0..4 {
                    let mut rng = stream(seed, generation, individual, Purpose::Trials);
                    assert!(seen.insert(rng.next_u64()));
                }
            }
        }
        let first = stream(7, 1, 2, Purpose::Breeding).next_u64();
        assert_eq!(first, stream(7, 1, 2, Purpose::Breeding).next_u64());
        assert_ne!(first, stream(7, 1, 2, Purpose::StartPoses).next_u64());
    }
}
