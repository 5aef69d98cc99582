//! Genetic programming of hierarchies (Thesis 3.2, Algorithm 3.1).
mod experiment;
mod parallel;
pub use experiment::{Experiment, ExperimentError, TreeError, read_tree};
pub use parallel::Workers;
