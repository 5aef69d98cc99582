//! The ancestors of an individual.

use std::collections::BTreeMap;

use crate::evolution::{GenerationRecord, Origin};

/// An individual in its first generation.
#[derive(Clone, Debug, PartialEq)]
pub struct Ancestor {
    /// Its id.
    pub id: u64,
    /// Its first generation.
    pub born: u64,
    /// Its last generation in the records.
    pub last_seen: u64,
    /// How it was created: what it inherited from whom, and what was reset.
    pub origin: Origin,
    /// Its hierarchy as text, which never changes.
    pub tree: String,
    /// Its rank in its first generation, from 1.
    pub rank: usize,
    /// Its fitness there: time steps of all scored trials.
    pub fitness_steps: u64,
}

impl Ancestor {
    /// Returns the ids of its parents. The parent that gave the tree with the root comes first.
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

/// An individual and its ancestors.
#[derive(Clone, Debug, PartialEq)]
pub struct Lineage {
    /// The individual.
    pub id: u64,
    /// The individual and all its ancestors, by id. Parents have smaller ids than their children.
    pub ancestors: BTreeMap<u64, Ancestor>,
}

impl Lineage {
    /// Returns the mean length of the scored trials of the line of descent in each generation:
    /// what was inherited along it. `records` are those that the lineage was made of.
    pub fn course<'r>(
        &self,
        records: impl IntoIterator<Item = &'r GenerationRecord>,
    ) -> Vec<(u64, f64)> {
        let line: Vec<_> = self.line().collect();
        let of = |record: &GenerationRecord| {
            // The line begins with the latest.
            let born = |ancestor: &&&Ancestor| ancestor.born <= record.generation;
            let id = line.iter().find(born)?.id;
            let mut individuals = record.individuals.iter();
            let individual = individuals.find(|individual| individual.id == id)?;
            Some((record.generation, individual.mean_steps()))
        };
        records.into_iter().filter_map(of).collect()
    }

    /// Returns the line of descent of the root: the individual, the parent that gave its root, and so on
    /// back to the start.
    pub fn line(&self) -> impl Iterator<Item = &Ancestor> {
        let first = self.ancestors.get(&self.id);
        std::iter::successors(first, |ancestor| {
            let receiver = ancestor.parents().into_iter().next()?;
            self.ancestors.get(&receiver)
        })
    }
}

/// Returns the lineage of an individual; `None` if no record holds it.
///
/// `records` are those of the generations up to one that holds the individual. Where records are
/// missing, the lineage ends.
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
