//! Individuals and their origins.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::learning::{Hierarchy, PrimitiveSet};

/// A member of the population.
#[derive(Clone, Debug, PartialEq)]
pub struct Individual {
    /// Unique in a run and rising with every new individual. A reproduced individual keeps
    /// its id.
    pub id: u64,
    /// Its origin.
    pub origin: Origin,
    /// Its hierarchy with the learned values.
    pub hierarchy: Hierarchy,
    /// Its own primitive set; `None` where it uses that of the population.
    pub primitives: Option<PrimitiveSet>,
}

/// The origin of an individual in its generation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Origin {
    /// From the scenario's initial population.
    HandCoded,
    /// A random hierarchy (`variation: random_trees`).
    Random,
    /// Reproduced: among the best of the generation before.
    Reproduced,
    /// Made by crossover: the receiver with one subtree replaced by the donor's.
    Crossover {
        /// The parent that gave the tree from the root down.
        receiver: Parent,
        /// The parent that gave the new subtree.
        donor: Parent,
        /// Composite subtasks whose learned values were inherited.
        inherited: Vec<Inherited>,
        /// Composite subtasks that were reset to initial values, or are new.
        reset: Vec<String>,
        /// The mutations that followed.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        mutations: Vec<Mutation>,
    },
    /// A copy of a parent, made where no crossover of the parents drawn obeyed the rules.
    Copied {
        /// Id of the copied individual.
        from: u64,
        /// The mutations that followed.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        mutations: Vec<Mutation>,
    },
}

impl Origin {
    /// Returns the mutations of the individual, in order.
    #[must_use]
    pub fn mutations(&self) -> &[Mutation] {
        match self {
            Self::Crossover { mutations, .. } | Self::Copied { mutations, .. } => mutations,
            Self::HandCoded | Self::Random | Self::Reproduced => &[],
        }
    }
}

/// A mutation of an offspring (Thesis chapter 5).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Mutation {
    /// A composite subtask lost a child and its subtree.
    Pruned {
        /// The composite subtask.
        parent: String,
        /// The child, as text.
        subtree: String,
    },
    /// A composite subtask got one more child.
    Grown {
        /// The composite subtask. It and its ancestors were reset to initial values.
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
    /// Id of the parent from which the values were inherited.
    pub from: u64,
}
