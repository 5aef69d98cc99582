#![doc = include_str!("README.md")]

mod breeding;
mod crossover;
mod evolve;
mod experiment;
mod individual;
mod measure;
mod mutation;
mod parallel;
mod record;
mod trials;
mod turns;

pub use crossover::crossover;
pub use evolve::{Evolution, EvolutionState};
pub use experiment::{Experiment, ExperimentError, TreeError, read_tree};
pub use individual::{Individual, Inherited, Mutation, Origin, Parent};
pub use mutation::mutated;
pub use parallel::{Workers, processors};
pub use record::{GenerationRecord, MOST_LISTED, RankedRecord, TrialRecord, UnlistedTrials};
