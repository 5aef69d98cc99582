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
mod policy_samples;
mod primitives;
mod selection;
mod state_values;
mod training;
mod visited;

pub use agent::{Agent, Trial};
pub use explain::{ActionChoice, Change, Choice, Explanation, Level, NodeTermination, UpdateTrace};
pub use features::{Encoder, Features};
pub use flat::{Episode, FlatLearner, FlatMethod};
pub use gate::{Gate, Stopped};
pub use hierarchy::{CompositeValues, Hierarchy};
pub use observe::{Observer, Update};
pub use policy::Policy;
pub use policy_samples::{PolicySamples, SelectionProbabilities, average};
pub use primitives::{PrimitiveSet, PrimitiveValues};
pub use selection::{SelectionRule, Softmax};
pub use training::PrimitiveTrainer;
