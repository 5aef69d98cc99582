//! Training of the primitive subtasks before evolution starts (Thesis 3.1, 4.2).

use rand::RngExt;

use super::features::Encoder;
use super::gate::{Gate, Stopped};
use super::selection::{Softmax, uniform};
use super::skills::Skill;
use crate::random::Stream;
use crate::scenario::{Exploration, LearningModel};
use crate::worlds::{SubtaskId, World};

/// Trains one primitive subtask, alone, by Thesis Eq. 3.6: the value of an action is
/// the reward of the next step, without prediction.
///
/// An episode starts where the world lets the subtask be trained and ends after its
/// number of steps or when the world says so. With softmax exploration the
/// temperature falls at the end of each *episode*: falling at every step it would be
/// cold before rare inputs, such as targets at the edge of the view, were seen.
///
/// Where the world has no training for it, the subtask has learned nothing.
///
/// # Errors
/// When the gate is stopped.
pub fn train<W: World>(
    world: &W,
    encoder: &Encoder,
    model: &LearningModel,
    primitive: SubtaskId,
    rng: &mut Stream,
    gate: &Gate,
) -> Result<Skill, Stopped> {
    let catalogue = world.catalogue();
    let map = catalogue.subtask(primitive).map;
    let actions = catalogue.subtask(primitive).actions();
    let untrained = Skill::new(primitive, catalogue, model.initial_parameter as f32);
    let Some(training) = world.training(primitive) else {
        return Ok(untrained);
    };
    let softmax = Softmax::new(model);
    let limit = model.temperature_limit as f32;
    let mut temperature = model.initial_temperature as f32;
    let mut skill = untrained;
    let mut features = encoder.features();
    let mut room = skill.values();
    let mut steps = 0;
    while steps < training.steps {
        let begun = steps;
        let Some(mut state) = world.begin_training(primitive, rng) else {
            return Ok(skill);
        };
        for _ in 0..training.episode_steps.min(training.steps - steps) {
            features.load(world.percept(&state).as_ref());
            let features = encoder.encode(map, &mut features);
            let values = skill.evaluate(features, &mut room);
            let action = match training.exploration {
                Exploration::Uniform => uniform(rng.random(), actions),
                Exploration::Softmax => softmax.choose(values, temperature, rng),
            };
            let before = state.clone();
            let reward = world.step(&mut state, primitive, action, rng);
            let error = reward - values[action];
            skill.learn(action, features, model.learning_rate as f32 * error);
            steps += 1;
            if !world.training_goes_on(primitive, &before, &mut state) {
                break;
            }
        }
        gate.pass(steps - begun)?;
        temperature = (temperature * training.temperature_decrease as f32).max(limit);
    }
    Ok(skill)
}
