//! Where an individual comes from.

use std::collections::BTreeMap;

use crate::evolution::{GenerationRecord, Origin};

/// An individual as it came into the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Ancestor {
    /// Its id.
    pub id: u64,
    /// The generation that it was made for.
    pub born: u64,
    /// The last generation that it lived in, as far as is known.
    pub last_seen: u64,
    /// How it was made: what was inherited from whom, and what was reset.
    pub origin: Origin,
    /// Its hierarchy as text; it never changes.
    pub tree: String,
    /// Its rank in its first generation, from 1.
    pub rank: usize,
    /// Its fitness there: time steps over the scored trials.
    pub fitness_steps: u64,
}

impl Ancestor {
    /// The individuals that it was made of: the one that gave the tree from the root
    /// down comes first.
    #[must_use]
    pub fn parents(&self) -> Vec<u64> {
        match &self.origin {
            Origin::HandCoded | Origin::Random | Origin::Reproduced => Vec::new(),
            Origin::Copied { from, .. } => vec![*from],
            Origin::Crossover {
                receiver, donor, ..
            } => vec![receiver.id, donor.id],
        }
    }
}

/// All ancestors of an individual.
#[derive(Clone, Debug, PartialEq)]
pub struct Lineage {
    /// The individual.
    pub id: u64,
    /// It and all its ancestors, by id; parents have smaller ids than their children.
    pub ancestors: BTreeMap<u64, Ancestor>,
}

impl Lineage {
    /// The line along which the tree was handed down from the root: the individual,
    /// the parent whose tree it received, and so on back to the start.
    pub fn line(&self) -> impl Iterator<Item = &Ancestor> {
        let first = self.ancestors.get(&self.id);
        std::iter::successors(first, |ancestor| {
            let receiver = ancestor.parents().into_iter().next()?;
            self.ancestors.get(&receiver)
        })
    }
}

/// The lineage of an individual from the records of the generations up to one that it
/// lived in; `None` if it is in none of them. Where records are missing, it ends.
#[must_use]
pub fn lineage<'r>(
    records: impl IntoIterator<Item = &'r GenerationRecord>,
    id: u64,
) -> Option<Lineage> {
    let mut known: BTreeMap<u64, Ancestor> = BTreeMap::new();
    for record in records {
        for individual in &record.individuals {
            let ancestor = known.entry(individual.id).or_insert_with(|| Ancestor {
                id: individual.id,
                born: record.generation,
                last_seen: record.generation,
                origin: individual.origin.clone(),
                tree: individual.tree.clone(),
                rank: individual.rank,
                fitness_steps: individual.fitness_steps,
            });
            ancestor.last_seen = record.generation;
        }
    }
    let mut ancestors = BTreeMap::new();
    let mut wanted = vec![id];
    while let Some(id) = wanted.pop() {
        if let Some(ancestor) = known.remove(&id) {
            wanted.extend(ancestor.parents());
            ancestors.insert(id, ancestor);
        }
    }
    ancestors
        .contains_key(&id)
        .then_some(Lineage { id, ancestors })
}
