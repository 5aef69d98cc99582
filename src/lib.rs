//! maxq-lab: a terminal lab bench for evolving the task hierarchies of hierarchical
//! reinforcement learning.
//!
//! A population of MAXQ hierarchies competes inside one agent: each learns by MAXQ-Q
//! with RBF function approximation while it acts, and typed crossover mixes the best.
//! The method is that of S. Elfwing, *An Evolutionary Approach to Automatic
//! Construction of the Structure in Hierarchical Reinforcement Learning* (KTH 2003),
//! called "Thesis" throughout.

#![deny(missing_docs)]

pub mod cli;
pub mod evolution;
pub mod files;
pub mod hierarchy;
pub mod lab;
pub mod learning;
pub mod random;
pub mod scenario;
pub mod worlds;
