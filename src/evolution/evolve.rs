//! The evolutionary scheme (Thesis Algorithm 3.1).

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rand::RngExt;

use super::breeding::{breed, random_individuals};
use super::experiment::Experiment;
use super::individual::{Individual, Origin};
use super::parallel::Workers;
use super::record::{GenerationRecord, RankedRecord};
use super::trials::{Generation, IndividualTrials, TrialResults, TrialStarts, is_experienced};
use crate::hierarchy::{Summary, canonical, structural_difference};
use crate::learning::{
    Gate, PolicySamples, PrimitiveSet, SelectionProbabilities, Stopped, average,
};
use crate::random::{Purpose, stream};
use crate::scenario::{PrimitiveLearning, Selection, Variation};
use crate::worlds::World;

/// All that an evolution has come to: with the scenario and the seed, everything
/// needed to go on.
#[derive(Clone, Debug, PartialEq)]
pub struct EvolutionState {
    /// Generations lived through; 0 before the initial population has lived.
    pub generation: u64,
    /// After a generation from best to worst; before the first in the scenario's order.
    pub individuals: Vec<Individual>,
    /// The one copy of the primitive subtasks.
    pub primitives: PrimitiveSet,
    /// Id of the next new individual.
    pub next_id: u64,
    /// Control steps so far, training of the primitive subtasks included.
    pub control_steps: u64,
    /// Whether the better half has one structure.
    pub converged: bool,
}

impl EvolutionState {
    /// Whether evolution is over: converged, or at the generation limit.
    #[must_use]
    pub fn is_over(&self, generation_limit: u64) -> bool {
        self.converged || self.generation >= generation_limit
    }
}

/// An evolution under way.
#[derive(Debug)]
pub struct Evolution<'e, W: World> {
    experiment: &'e Experiment<W>,
    workers: &'e Workers,
    seed: u64,
    samples: PolicySamples<W::Percept>,
    state: Arc<EvolutionState>,
}

impl<'e, W: World> Evolution<'e, W> {
    /// Line 1: the initial population, with freshly trained primitive subtasks.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn begin(
        experiment: &'e Experiment<W>,
        workers: &'e Workers,
        seed: u64,
        gate: &Gate,
    ) -> Result<Self, Stopped> {
        let primitives = experiment.train(seed, 0, workers, gate)?;
        let individuals = first_population(experiment, seed);
        let trained = experiment.catalogue().primitives();
        let state = EvolutionState {
            generation: 0,
            next_id: individuals.len() as u64,
            individuals,
            primitives,
            control_steps: trained
                .filter_map(|primitive| experiment.world.training(primitive))
                .map(|training| u64::from(training.steps))
                .sum(),
            converged: false,
        };
        Self::resume(experiment, workers, seed, state, gate)
    }

    /// Goes on from a state.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn resume(
        experiment: &'e Experiment<W>,
        workers: &'e Workers,
        seed: u64,
        state: EvolutionState,
        gate: &Gate,
    ) -> Result<Self, Stopped> {
        let mut rng = stream(seed, 0, 0, Purpose::PolicySamples);
        let count = experiment.scenario.evolution.policy_samples;
        Ok(Self {
            samples: PolicySamples::draw(&experiment.world, count, &mut rng, gate)?,
            experiment,
            workers,
            seed,
            state: Arc::new(state),
        })
    }

    /// What the evolution has come to; a snapshot costs nothing.
    #[must_use]
    pub fn state(&self) -> &Arc<EvolutionState> {
        &self.state
    }

    /// Whether evolution is over: converged, or at the generation limit.
    #[must_use]
    pub fn is_over(&self) -> bool {
        let limit = self.experiment.scenario.evolution.generation_limit;
        self.state.is_over(limit)
    }

    /// Only crossover can make one structure of many; without it the limit is the end.
    fn may_converge(&self) -> bool {
        self.experiment.scenario.evolution.variation == Variation::Crossover
    }

    /// One turn of the loop: lines 8 and 9 but before the first generation, then lines
    /// 3 to 5. `progress` is told how many results have been lived: as many as all trials
    /// so far make up, for all individuals come to their ends together.
    ///
    /// # Errors
    /// When the gate is stopped; then nothing has changed.
    pub fn step(
        &mut self,
        gate: &Gate,
        progress: impl Fn(usize) + Sync,
    ) -> Result<GenerationRecord, Stopped> {
        let experiment = self.experiment;
        let generation = self.state.generation + 1;
        let mut next_id = self.state.next_id;
        let population = if self.state.generation == 0 {
            self.state.individuals.clone()
        } else {
            let mut rng = stream(self.seed, self.state.generation, 0, Purpose::Breeding);
            let ranked = &self.state.individuals;
            breed(
                ranked,
                &mut next_id,
                &experiment.scenario,
                experiment.catalogue(),
                &mut rng,
                gate,
            )?
        };
        let (results, primitives) = self.run_trials(&population, generation, gate, progress)?;
        let ranks = self.ranks(&results, generation);
        let lived_steps: u64 = results.iter().map(|results| results.control_steps).sum();
        let mut pairs: Vec<_> = population.into_iter().zip(results).map(Some).collect();
        let ranked: Vec<_> = ranks
            .iter()
            .filter_map(|&index| pairs[index].take())
            .collect();
        let control_steps = self.state.control_steps + lived_steps;
        let own = experiment.scenario.learning.primitive_learning == PrimitiveLearning::Individual;
        let record = self.record(generation, &ranked, &primitives, control_steps, gate)?;
        self.state = Arc::new(EvolutionState {
            generation,
            individuals: ranked
                .into_iter()
                .map(|(individual, results)| Individual {
                    hierarchy: results.hierarchy,
                    primitives: own.then_some(results.primitives),
                    id: individual.id,
                    origin: individual.origin,
                })
                .collect(),
            primitives,
            next_id,
            control_steps,
            converged: record.converged,
        });
        Ok(record)
    }

    /// Line 3: all individuals live through the generation.
    fn run_trials(
        &self,
        population: &[Individual],
        generation: u64,
        gate: &Gate,
        progress: impl Fn(usize) + Sync,
    ) -> Result<(Vec<TrialResults>, PrimitiveSet), Stopped> {
        let starts = TrialStarts::draw(self.experiment, self.seed, generation);
        let trials = self.experiment.scenario.evolution.trials_per_generation;
        // Half of the results of an experienced individual is over already.
        let experienced = population.iter().filter(|one| is_experienced(one)).count();
        let trials_over = AtomicUsize::new(experienced * trials / 2);
        let trial_over = || {
            let over = trials_over.fetch_add(1, Ordering::Relaxed) + 1;
            if over.is_multiple_of(trials) {
                progress(over / trials);
            }
        };
        let generation = Generation {
            experiment: self.experiment,
            starts: &starts,
            seed: self.seed,
            number: generation,
            gate,
            trial_over: &trial_over,
        };
        if self.experiment.scenario.learning.primitive_learning == PrimitiveLearning::Shared {
            let mut primitives = self.state.primitives.clone();
            let mut all = Vec::with_capacity(population.len());
            for individual in population {
                let results = IndividualTrials::new(generation, individual, &primitives).run()?;
                primitives = results.primitives.clone();
                all.push(results);
            }
            return Ok((all, primitives));
        }
        let born = population.iter().map(|individual| {
            let primitives = individual
                .primitives
                .as_ref()
                .unwrap_or(&self.state.primitives);
            IndividualTrials::new(generation, individual, primitives)
        });
        let lived = self.workers.finish(born.collect())?;
        let results = lived
            .into_iter()
            .map(IndividualTrials::into_results)
            .collect();
        Ok((results, self.state.primitives.clone()))
    }

    /// Line 4: indices from best to worst; of equals, the one is better that stands first
    /// in the population: the reproduced as they were ranked, then by id.
    fn ranks(&self, results: &[TrialResults], generation: u64) -> Vec<usize> {
        let mut order: Vec<_> = (0..results.len()).collect();
        match self.experiment.scenario.evolution.selection {
            Selection::Fitness => order.sort_by_key(|&index| results[index].fitness()),
            Selection::Random => {
                let mut rng = stream(self.seed, generation, 0, Purpose::RandomRank);
                let chances: Vec<u64> = order.iter().map(|_| rng.random()).collect();
                order.sort_by_key(|&index| chances[index]);
            }
        }
        order
    }

    fn record(
        &self,
        generation: u64,
        ranked: &[(Individual, TrialResults)],
        primitives: &PrimitiveSet,
        control_steps: u64,
        gate: &Gate,
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
                    trials: results.scored.clone(),
                    difference_to_best: structural_difference(tree, best, catalogue),
                }
            })
            .collect();
        let others = &individuals[1..better.len()];
        let difference: i64 = others.iter().map(|other| other.difference_to_best).sum();
        let structure =
            |(_, results): &(_, TrialResults)| canonical(results.hierarchy.tree(), catalogue);
        let first = structure(&ranked[0]);
        Ok(GenerationRecord {
            generation,
            mean_difference: difference as f64 / others.len().max(1) as f64,
            selection_probabilities: self.named(self.probabilities(better, primitives, gate)?),
            converged: self.may_converge() && better.iter().all(|other| structure(other) == first),
            control_steps,
            individuals,
        })
    }

    fn probabilities(
        &self,
        better: &[(Individual, TrialResults)],
        primitives: &PrimitiveSet,
        gate: &Gate,
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
                gate,
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

/// The hand-coded hierarchies, or as many drawn by chance for random search.
fn first_population<W: World>(experiment: &Experiment<W>, seed: u64) -> Vec<Individual> {
    let evolution = &experiment.scenario.evolution;
    if evolution.variation == Variation::RandomTrees {
        let mut rng = stream(seed, 0, 0, Purpose::Breeding);
        let (scenario, catalogue) = (&experiment.scenario, experiment.catalogue());
        return random_individuals(
            evolution.population_size,
            &mut 0,
            scenario,
            catalogue,
            &mut rng,
        );
    }
    let trees = experiment.initial_population.iter().zip(0..);
    let individuals = trees.map(|(tree, id)| Individual {
        id,
        origin: Origin::HandCoded,
        hierarchy: experiment.untrained(tree.clone()),
        primitives: None,
    });
    individuals.collect()
}
