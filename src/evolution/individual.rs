//! Individuals and where they come from.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::learning::{Hierarchy, PrimitiveSet};

/// A member of the population.
#[derive(Clone, Debug, PartialEq)]
pub struct Individual {
    /// Unique in a run, in the order of making. A reproduced individual keeps its id.
    pub id: u64,
    /// How it came into its generation.
    pub origin: Origin,
    /// Its structure and what it has learned.
    pub hierarchy: Hierarchy,
    /// Its own primitive subtasks; `None` where it begins with, or stays with, the copy
    /// of the population.
    pub primitives: Option<PrimitiveSet>,
}

/// How an individual came into its generation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Origin {
    /// From the scenario's initial population.
    HandCoded,
    /// Drawn by chance (`variation: random_trees`).
    Random,
    /// Among the best of the generation before; it lives on.
    Reproduced,
    /// By crossover: the receiver with one subtree replaced by the donor's.
    Crossover {
        /// The parent that gave the tree from the root down.
        receiver: Parent,
        /// The parent that gave the new subtree.
        donor: Parent,
        /// Composite subtasks whose learned values were inherited.
        inherited: Vec<Inherited>,
        /// Composite subtasks that were set back to initial values, or are new.
        reset: Vec<String>,
        /// What mutation changed afterwards.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        mutations: Vec<Mutation>,
    },
    /// A copy with learned values of a parent, made where no crossover of any parents
    /// drawn obeyed the rules.
    Copied {
        /// The individual copied.
        from: u64,
        /// What mutation changed afterwards.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        mutations: Vec<Mutation>,
    },
}

impl Origin {
    /// What mutation changed in it, in order.
    #[must_use]
    pub fn mutations(&self) -> &[Mutation] {
        match self {
            Self::Crossover { mutations, .. } | Self::Copied { mutations, .. } => mutations,
            Self::HandCoded | Self::Random | Self::Reproduced => &[],
        }
    }
}

/// A change of an offspring (Thesis chapter 5).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Mutation {
    /// A child of a composite subtask is gone, with all below it.
    Pruned {
        /// The composite subtask.
        parent: String,
        /// The child, as text.
        subtree: String,
    },
    /// A composite subtask has a child more.
    Grown {
        /// The composite subtask. It and all above it were set back to initial values.
        parent: String,
        /// The child, as text.
        subtree: String,
    },
}

impl fmt::Display for Mutation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pruned { parent, subtree } => write!(f, "{subtree} pruned from {parent}"),
            Self::Grown { parent, subtree } => write!(f, "{subtree} grown on {parent}"),
        }
    }
}

/// A parent and its crossover site.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parent {
    /// Id of the individual.
    pub id: u64,
    /// Its crossover site: the index of the node in preorder, the root being 0.
    pub site: usize,
    /// The subtask there.
    pub subtask: String,
}

/// A composite subtask whose learned values were inherited.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inherited {
    /// The subtask.
    pub subtask: String,
    /// Id of the parent that it was inherited from.
    pub from: u64,
}
