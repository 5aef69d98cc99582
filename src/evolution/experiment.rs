//! A scenario that is ready to run.

use thiserror::Error;

use super::parallel::Workers;
use super::turns::PooledTask;
use crate::hierarchy::{self, TextError, Tree, TypingError};
use crate::learning::{Agent, Encoder, Gate, Hierarchy, PrimitiveSet, PrimitiveTrainer, Stopped};
use crate::random::{Purpose, stream};
use crate::scenario::Scenario;
use crate::worlds::{Catalogue, World};

/// Control steps in one turn of a primitive subtask's training: few compared with the
/// training, many compared with the cost of a turn.
const TRAINING_TURN_STEPS: u32 = 1000;

/// A scenario with its world, its feature maps and its initial population.
#[derive(Clone, Debug)]
pub struct Experiment<W> {
    /// The scenario.
    pub scenario: Scenario,
    /// Its world.
    pub world: W,
    /// The feature maps of the world's subtasks.
    pub encoder: Encoder,
    /// The hand-coded initial population.
    pub initial_population: Vec<Tree>,
}

/// Why a hierarchy cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TreeError {
    /// It is not the text form of a hierarchy.
    #[error(transparent)]
    Text(#[from] TextError),
    /// It breaks a typing rule.
    #[error(transparent)]
    Typing(#[from] TypingError),
}

/// Why a scenario cannot run although all its settings are in range.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("evolution.initial_population[{index}]: {source}")]
pub struct ExperimentError {
    /// Index of the hierarchy in the initial population.
    pub index: usize,
    /// The error.
    pub source: TreeError,
}

impl<W: World> Experiment<W> {
    /// Prepares a scenario and its world.
    ///
    /// # Errors
    /// When a hierarchy of the initial population is malformed or breaks a rule.
    pub fn new(scenario: Scenario, world: W) -> Result<Self, ExperimentError> {
        let catalogue = world.catalogue();
        let depth = scenario.evolution.maximum_depth;
        let texts = scenario.evolution.initial_population.iter().enumerate();
        let trees = texts.map(|(index, text)| {
            read_tree(text, catalogue, depth).map_err(|source| ExperimentError { index, source })
        });
        Ok(Self {
            initial_population: trees.collect::<Result<_, _>>()?,
            encoder: Encoder::new(catalogue),
            scenario,
            world,
        })
    }

    /// Returns the subtasks of the world.
    #[must_use]
    pub fn catalogue(&self) -> &Catalogue {
        self.world.catalogue()
    }

    /// Makes a hierarchy that has learned nothing.
    #[must_use]
    pub fn untrained(&self, tree: Tree) -> Hierarchy {
        Hierarchy::new(tree, self.catalogue(), &self.scenario.learning)
    }

    /// Makes an agent for the scenario's trials.
    #[must_use]
    pub fn agent(&self, hierarchy: Hierarchy, primitives: PrimitiveSet) -> Agent<'_, W> {
        let learning = &self.scenario.learning;
        let limit = self.scenario.evolution.trial_step_limit;
        Agent::new(
            &self.world,
            &self.encoder,
            learning,
            hierarchy,
            primitives,
            limit,
        )
    }

    /// Trains a primitive set. Each number of a `primitive_set` gives an independent training.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn train(
        &self,
        seed: u64,
        primitive_set: u64,
        workers: &Workers,
        gate: &Gate,
    ) -> Result<PrimitiveSet, Stopped> {
        let tasks = self.catalogue().primitives().enumerate();
        let tasks = tasks.map(|(index, primitive)| {
            let rng = stream(
                seed,
                primitive_set,
                index as u64,
                Purpose::PrimitiveTraining,
            );
            let learning = &self.scenario.learning;
            let trainer =
                PrimitiveTrainer::new(&self.world, &self.encoder, learning, primitive, rng);
            TrainingTask { trainer, gate }
        });
        let trained = workers.finish(tasks.collect())?.into_iter();
        let primitives = trained.map(|task| task.trainer.into_values()).collect();
        let primitives = PrimitiveSet::new(primitives, self.catalogue());
        Ok(primitives.unwrap_or_else(|| unreachable!("every primitive subtask was trained")))
    }
}

/// The training of a primitive subtask, in turns.
struct TrainingTask<'t, W: World> {
    trainer: PrimitiveTrainer<'t, W>,
    gate: &'t Gate,
}

impl<W: World> PooledTask for TrainingTask<'_, W> {
    type Error = Stopped;

    /// Returns the control steps left.
    fn left(&self) -> Option<f64> {
        let left = self.trainer.left();
        (left > 0).then_some(f64::from(left))
    }

    fn turn(&mut self) -> Result<(), Stopped> {
        self.trainer.train(TRAINING_TURN_STEPS, self.gate)
    }
}

/// Reads a hierarchy and checks the typing rules.
///
/// # Errors
/// When the text is malformed or breaks a rule.
pub fn read_tree(text: &str, catalogue: &Catalogue, depth: usize) -> Result<Tree, TreeError> {
    let tree = hierarchy::parse(text, catalogue)?;
    hierarchy::check(&tree, catalogue, depth)?;
    Ok(tree)
}
