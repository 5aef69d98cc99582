//! The evolutionary scheme (Thesis Algorithm 3.1).

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rand::RngExt;

use super::breeding::{breed, random_individuals};
use super::experiment::Experiment;
use super::individual::{Individual, Origin};
use super::measure::Measurement;
use super::parallel::Workers;
use super::record::GenerationRecord;
use super::trials::{Generation, IndividualTrials, TrialResults, TrialStarts, is_experienced};
use crate::learning::{Gate, PolicySamples, PrimitiveSet, Stopped};
use crate::random::{Purpose, stream};
use crate::scenario::{EvolutionSettings, PrimitiveLearning, Selection, Variation};
use crate::worlds::World;

/// The state of an evolution: with the scenario and the seed, all that is needed to
/// continue.
#[derive(Clone, Debug, PartialEq)]
pub struct EvolutionState {
    /// Finished generations; 0 before the initial population has run its trials.
    pub generation: u64,
    /// The population: from best to worst, or in the scenario's order before the first
    /// generation.
    pub individuals: Vec<Individual>,
    /// The primitive set of the population.
    pub primitives: PrimitiveSet,
    /// The id of the next new individual.
    pub next_id: u64,
    /// Control steps so far, with the training of the primitive subtasks.
    pub control_steps: u64,
    /// Whether the better half has one structure.
    pub converged: bool,
}

impl EvolutionState {
    /// Returns whether evolution has ended: converged, or at a limit.
    #[must_use]
    pub fn is_over(&self, evolution: &EvolutionSettings) -> bool {
        let spent = |limit| self.control_steps >= limit;
        self.converged
            || self.generation >= evolution.generation_limit
            || evolution.control_step_limit.is_some_and(spent)
    }
}

/// A running evolution.
#[derive(Debug)]
pub struct Evolution<'e, W: World> {
    experiment: &'e Experiment<W>,
    workers: &'e Workers,
    seed: u64,
    samples: PolicySamples<W::Percept>,
    state: Arc<EvolutionState>,
}

impl<'e, W: World> Evolution<'e, W> {
    /// Begins an evolution (line 1): trains the primitive subtasks and makes the initial
    /// population.
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

    /// Resumes an evolution from a state.
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

    /// Returns the present state. A snapshot of it costs nothing.
    #[must_use]
    pub fn state(&self) -> &Arc<EvolutionState> {
        &self.state
    }

    /// Returns whether evolution has ended: converged, or at a limit.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.state.is_over(&self.experiment.scenario.evolution)
    }

    /// Runs one generation: lines 8 and 9, except before the first generation, then lines 3
    /// to 5.
    ///
    /// `progress` is called with the number of individuals finished, computed as trials
    /// finished / trials per individual: all individuals advance in turns and end together.
    ///
    /// # Errors
    /// When the gate is stopped. Then the state has not changed.
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
        let new_steps: u64 = results.iter().map(|one| one.control_steps).sum();
        let mut pairs: Vec<_> = population.into_iter().zip(results).map(Some).collect();
        let ranked: Vec<_> = ranks
            .iter()
            .filter_map(|&index| pairs[index].take())
            .collect();
        let control_steps = self.state.control_steps + new_steps;
        let own = experiment.scenario.learning.primitive_learning == PrimitiveLearning::Individual;
        let measurement = Measurement {
            experiment,
            workers: self.workers,
            samples: &self.samples,
            gate,
        };
        let record = measurement.record(generation, &ranked, &primitives, control_steps)?;
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

    /// Line 3: all individuals run their trials.
    fn run_trials(
        &self,
        population: &[Individual],
        generation: u64,
        gate: &Gate,
        progress: impl Fn(usize) + Sync,
    ) -> Result<(Vec<TrialResults>, PrimitiveSet), Stopped> {
        let starts = TrialStarts::draw(self.experiment, self.seed, generation);
        let trials = self.experiment.scenario.evolution.trials_per_generation;
        // An experienced individual skips half of the trials: they count as finished.
        let experienced = population.iter().filter(|one| is_experienced(one)).count();
        let trials_finished = AtomicUsize::new(experienced * trials / 2);
        let trial_ended = || {
            let finished = trials_finished.fetch_add(1, Ordering::Relaxed) + 1;
            if finished.is_multiple_of(trials) {
                progress(finished / trials);
            }
        };
        let generation = Generation {
            experiment: self.experiment,
            starts: &starts,
            seed: self.seed,
            number: generation,
            gate,
            trial_ended: &trial_ended,
        };
        if self.experiment.scenario.learning.primitive_learning == PrimitiveLearning::Shared {
            let mut primitives = self.state.primitives.clone();
            let mut all = Vec::with_capacity(population.len());
            for individual in population {
                let results = IndividualTrials::new(&generation, individual, &primitives).run()?;
                primitives = results.primitives.clone();
                all.push(results);
            }
            return Ok((all, primitives));
        }
        let tasks = population.iter().map(|individual| {
            let primitives = individual
                .primitives
                .as_ref()
                .unwrap_or(&self.state.primitives);
            IndividualTrials::new(&generation, individual, primitives)
        });
        let finished = self.workers.finish(tasks.collect())?;
        let results = finished
            .into_iter()
            .map(IndividualTrials::into_results)
            .collect();
        Ok((results, self.state.primitives.clone()))
    }

    /// Line 4: returns the individuals' indices from best to worst.
    ///
    /// Of equals, the one that stands first in the population ranks first: reproduced
    /// individuals by their old ranks, then the others by id.
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
}

/// Returns the hand-coded individuals, or as many random ones for random search.
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
