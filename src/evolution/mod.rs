//! Genetic programming of hierarchies (Thesis 3.2, Algorithm 3.1).

mod breeding;
mod crossover;
mod evolve;
mod experiment;
mod individual;
mod life;
mod mutation;
mod newborn;
mod parallel;
mod record;
mod turns;

pub use crossover::crossover;
pub use evolve::{Evolution, State};
pub use experiment::{Experiment, ExperimentError, TreeError, read_tree};
pub use individual::{Individual, Inherited, Mutation, Origin, Parent};
pub use mutation::mutated;
pub use parallel::Workers;
pub use record::{GenerationRecord, RankedRecord, TrialRecord};
