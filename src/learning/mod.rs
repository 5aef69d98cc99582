#![doc = include_str!("README.md")]

mod agent;
mod explain;
mod explanation;
mod exponential;
mod features;
mod flat;
mod gate;
mod grid;
mod hierarchy;
mod history;
mod linear;
mod maxq_q;
mod plan;
mod policy;
mod policy_samples;
mod primitives;
mod selection;
mod state_values;
mod targets;
mod training;

pub use agent::{Agent, Observer, Trial, Update};
pub use explanation::{
    ActionChoice, Change, Choice, Exit, Explanation, Level, NodeTermination, Replayed, UpdateTrace,
};
pub use features::{Encoder, Features};
pub use flat::{Episode, FlatLearner, FlatMethod};
pub use gate::{Gate, Stopped};
pub use hierarchy::{CompositeValues, Hierarchy};
pub use policy::Policy;
pub use policy_samples::{PolicySamples, SelectionProbabilities, average};
pub use primitives::{PrimitiveSet, PrimitiveValues};
pub use selection::{SelectionRule, Softmax};
pub use training::PrimitiveTrainer;
