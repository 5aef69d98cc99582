//! Training of the primitive subtasks before evolution starts (Thesis 3.1, 4.2).

use rand::RngExt;

use super::features::{Encoder, Features};
use super::gate::{Gate, Stopped};
use super::linear::Row;
use super::primitives::PrimitiveValues;
use super::selection::{Softmax, uniform};
use crate::random::Stream;
use crate::scenario::{LearningSettings, PrimitiveLearning};
use crate::worlds::{Exploration, TrainingSettings};
use crate::worlds::{SubtaskId, World};

/// Trains one primitive subtask alone by Thesis Eq. 3.6: the value of an action is the
/// reward of the next step, without prediction.
///
/// The world decides where an episode starts. It ends after a number of steps or when the
/// world ends it. With softmax exploration the temperature falls after each *episode*. If it
/// fell at every step, it would be low before rare inputs had been seen, such as targets at
/// the edge of the field of view.
///
/// Where the world has no training for the subtask, it learns nothing. If it does not learn
/// later either, its values are 0.
#[derive(Debug)]
pub struct PrimitiveTrainer<'t, W: World> {
    world: &'t W,
    encoder: &'t Encoder,
    settings: &'t LearningSettings,
    softmax: Softmax,
    primitive: PrimitiveValues,
    rng: Stream,
    temperature: f32,
    /// Control steps left.
    left: u32,
    features: Features,
    room: Vec<Row>,
}

impl<'t, W: World> PrimitiveTrainer<'t, W> {
    /// Starts the training of a primitive subtask that has learned nothing.
    #[must_use]
    pub fn new(
        world: &'t W,
        encoder: &'t Encoder,
        settings: &'t LearningSettings,
        subtask: SubtaskId,
        rng: Stream,
    ) -> Self {
        let training = world.training(subtask);
        let learns = settings.primitive_learning != PrimitiveLearning::Frozen;
        let initial = if training.is_some() || learns {
            settings.initial_parameter as f32
        } else {
            0.0
        };
        let primitive = PrimitiveValues::new(subtask, world.catalogue(), initial);
        Self {
            world,
            encoder,
            settings,
            softmax: Softmax::new(settings),
            rng,
            temperature: settings.initial_temperature as f32,
            left: training.map_or(0, |training| training.steps),
            features: encoder.features(),
            room: primitive.values(),
            primitive,
        }
    }

    /// Returns the number of control steps left.
    #[must_use]
    pub fn left(&self) -> u32 {
        self.left
    }

    /// Trains for at least `steps` control steps, up to the end of an episode or of the
    /// training.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn train(&mut self, steps: u32, gate: &Gate) -> Result<(), Stopped> {
        let end = self.left.saturating_sub(steps);
        let Some(training) = self.world.training(self.primitive.subtask) else {
            return Ok(());
        };
        while self.left > end {
            let begun = self.left;
            match self
                .world
                .begin_training(self.primitive.subtask, &mut self.rng)
            {
                Some(state) => self.episode(state, training),
                None => self.left = 0,
            }
            gate.pass(begun - self.left)?;
            let cooled = self.temperature * training.temperature_decrease as f32;
            self.temperature = cooled.max(self.settings.temperature_limit as f32);
        }
        Ok(())
    }

    /// Returns the learned values.
    #[must_use]
    pub fn into_values(self) -> PrimitiveValues {
        self.primitive
    }

    fn episode(&mut self, mut state: W::State, training: &TrainingSettings) {
        let subtask = self.primitive.subtask;
        let actions = self.world.catalogue().subtask(subtask).actions();
        for _ in 0..training.episode_steps.min(self.left) {
            self.features.load(self.world.percept(&state).as_ref());
            let features = self.encoder.encode(self.primitive.map, &mut self.features);
            let values = self.primitive.evaluate(features, &mut self.room);
            let rng = &mut self.rng;
            let action = match training.exploration {
                Exploration::Uniform => uniform(rng.random(), actions),
                Exploration::Softmax => self.softmax.choose(values, self.temperature, rng),
            };
            let before = state.clone();
            let reward = self.world.step(&mut state, subtask, action, rng);
            let error = reward - values[action];
            let step = self.settings.learning_rate as f32 * error;
            self.primitive.learn(action, features, step);
            self.left -= 1;
            if !self.world.training_goes_on(subtask, &before, &mut state) {
                break;
            }
        }
    }
}
