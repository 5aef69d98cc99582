//! The algorithms that a single learner can learn by.

use crate::hierarchy::Tree;

/// A learning algorithm.
#[derive(Clone, Debug)]
pub enum Algorithm {
    /// TD(0) on a table (Thesis Algorithm 2.1).
    Td0(GivenPolicy),
    /// Q-learning on a table (Thesis Algorithm 2.2).
    QLearning,
    /// Q-learning with normalised Gaussian features (Thesis Algorithm 2.3).
    QLearningRbf,
    /// MAXQ-Q on a hierarchy (Thesis Algorithm 2.4).
    MaxqQ(Tree),
}

/// The policy whose values TD(0) learns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GivenPolicy {
    /// The optimal policy; of equally good actions all alike.
    Optimal,
    /// All actions alike.
    Random,
}
