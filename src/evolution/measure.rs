//! What is measured of a generation when its trials have ended, and whether the run has
//! converged (Algorithm 3.1, line 5).

use std::collections::BTreeMap;

use super::experiment::Experiment;
use super::individual::Individual;
use super::parallel::Workers;
use super::record::{GenerationRecord, RankedRecord};
use super::trials::TrialResults;
use crate::hierarchy::{Summary, canonical, structural_difference};
use crate::learning::{
    Gate, PolicySamples, PrimitiveSet, SelectionProbabilities, Stopped, average,
};
use crate::scenario::{PrimitiveLearning, Variation};
use crate::worlds::World;

/// Everything that a generation is measured with.
pub(super) struct Measurement<'m, W: World> {
    pub(super) experiment: &'m Experiment<W>,
    pub(super) workers: &'m Workers,
    /// The states in which selection probabilities are computed.
    pub(super) samples: &'m PolicySamples<W::Percept>,
    pub(super) gate: &'m Gate,
}

impl<W: World> Measurement<'_, W> {
    /// Returns the record of a generation whose individuals are sorted from best to worst.
    pub(super) fn record(
        &self,
        generation: u64,
        ranked: &[(Individual, TrialResults)],
        primitives: &PrimitiveSet,
        control_steps: u64,
    ) -> Result<GenerationRecord, Stopped> {
        let catalogue = self.experiment.catalogue();
        let better = &ranked[..ranked.len() / 2];
        let best = ranked[0].1.hierarchy.tree();
        let individuals: Vec<_> = ranked
            .iter()
            .enumerate()
            .map(|(index, (individual, results))| {
                let tree = results.hierarchy.tree();
                let summary = Summary::of(tree, catalogue);
                RankedRecord {
                    rank: index + 1,
                    id: individual.id,
                    origin: individual.origin.clone(),
                    tree: summary.tree,
                    composites: summary.composites,
                    primitives: summary.primitives,
                    primitives_by_state_type: summary.primitives_by_state_type,
                    fitness_steps: results.fitness(),
                    trials: results.scored.listed.clone(),
                    unlisted: results.scored.unlisted,
                    difference_to_best: structural_difference(tree, best, catalogue),
                }
            })
            .collect();
        let others = &individuals[1..better.len()];
        let difference: i64 = others.iter().map(|other| other.difference_to_best).sum();
        let structure =
            |(_, results): &(_, TrialResults)| canonical(results.hierarchy.tree(), catalogue);
        let first = structure(&ranked[0]);
        // Only crossover can make one structure of many; all else ends at the limit.
        let evolution = &self.experiment.scenario.evolution;
        let may_converge =
            evolution.stop_on_convergence && evolution.variation == Variation::Crossover;
        Ok(GenerationRecord {
            generation,
            mean_difference: difference as f64 / others.len().max(1) as f64,
            selection_probabilities: self.named(self.probabilities(better, primitives)?),
            converged: may_converge && better.iter().all(|other| structure(other) == first),
            control_steps,
            individuals,
        })
    }

    fn probabilities(
        &self,
        better: &[(Individual, TrialResults)],
        primitives: &PrimitiveSet,
    ) -> Result<SelectionProbabilities, Stopped> {
        let Experiment {
            scenario,
            world,
            encoder,
            ..
        } = self.experiment;
        let all = self.workers.map((0..better.len()).collect(), |index| {
            let results = &better[index].1;
            let learning = &scenario.learning;
            let primitives = match learning.primitive_learning {
                PrimitiveLearning::Individual => &results.primitives,
                PrimitiveLearning::Frozen | PrimitiveLearning::Shared => primitives,
            };
            self.samples.probabilities(
                world,
                encoder,
                learning,
                &results.hierarchy,
                primitives,
                self.gate,
            )
        })?;
        Ok(average(&all))
    }

    fn named(&self, probabilities: SelectionProbabilities) -> Vec<Option<BTreeMap<String, f64>>> {
        let catalogue = self.experiment.catalogue();
        let names = || {
            catalogue
                .primitives()
                .map(|primitive| primitive.name(catalogue).to_owned())
        };
        let by_type = probabilities.into_iter();
        by_type
            .map(|row| row.map(|row| names().zip(row).collect()))
            .collect()
    }
}
