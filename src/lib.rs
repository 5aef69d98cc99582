//! maxq-lab: a terminal lab bench for evolving the task hierarchies of hierarchical
//! reinforcement learning.
//!
//! A population of MAXQ hierarchies competes inside one agent: each learns by MAXQ-Q
//! with RBF function approximation while it acts, and typed crossover mixes the best.
//! The method is that of S. Elfwing, *An Evolutionary Approach to Automatic
//! Construction of the Structure in Hierarchical Reinforcement Learning* (KTH 2003),
//! called "Thesis" throughout. "Dietterich 2000" is T. G. Dietterich, *Hierarchical
//! Reinforcement Learning with the MAXQ Value Function Decomposition*, JAIR 13.
//!
//! # The rooms of the house
//!
//! Imports point one way, from the top of this table to its bottom; [`random`],
//! [`files`] and [`rules`] serve all.
//!
//! | room | what is in it |
//! | --- | --- |
//! | [`cli`] | one file per command |
//! | [`report`] | plans, studies, statistics, figures, exports |
//! | [`dashboard`] | the terminal: what a person sees of a run, and can do with it |
//! | [`lab`] | one run: evolution thread, events, commands, run folder, checkpoint |
//! | [`evolution`] | population, selection, crossover, the generation loop (Algorithm 3.1) |
//! | [`learning`] | RBF features, action selection, primitive subtasks, MAXQ-Q |
//! | [`hierarchy`] | trees of subtasks, typing rules, text form, structural difference |
//! | [`scenario`] | what an experiment is: the JSON model, its defaults, its rules |
//! | [`worlds`] | where agents act, and the subtasks that they have there; a folder each |

#![deny(missing_docs)]

#[cfg(not(unix))]
compile_error!(
    "maxq-lab runs on Unix systems only (Linux, macOS, BSD): it relies on their signals, \
     process groups and terminals"
);

pub mod cli;
pub mod dashboard;
pub mod evolution;
pub mod files;
pub mod hierarchy;
pub mod lab;
pub mod learning;
pub mod random;
pub mod report;
pub mod rules;
pub mod scenario;
pub mod worlds;
