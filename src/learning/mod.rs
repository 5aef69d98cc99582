//! Learning: features, action selection, primitive subtasks, MAXQ-Q.
//!
//! The room is generic over [`World`](crate::worlds::World). Learned values are
//! single precision. Every sum has a fixed order, no operation is left to the
//! processor's or the platform's taste (`libm`, no fused multiply-add), so the same
//! seed gives the same bits everywhere.

mod agent;
mod explain;
mod exponential;
mod features;
mod flat;
mod gate;
mod grid;
mod hierarchy;
mod lessons;
mod linear;
mod observe;
mod plan;
mod policy;
mod selection;
mod situation;
mod skills;
mod training;
mod verdict;
mod visited;

pub use agent::{Agent, Trial};
pub use explain::{ActionChoice, Change, Choice, Explanation, Lesson, Level, Termination};
pub use features::{Encoder, Features};
pub use flat::{Episode, Flat, FlatLesson};
pub use gate::{Gate, Stopped};
pub use hierarchy::{CompositeValues, Hierarchy};
pub use observe::{Observer, Update};
pub use policy::{PolicySamples, SelectionProbabilities, average};
pub use selection::{Rule, Softmax};
pub use skills::{Skill, Skills};
pub use training::Trainee;
pub use verdict::Policy;
