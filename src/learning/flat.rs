//! Learning without a hierarchy: TD(0), Q-learning, and Q-learning with RBF features
//! (Thesis Algorithms 2.1 to 2.3).
//!
//! All three are one loop with linear features: a table gives the lookup tables of
//! Algorithms 2.1 and 2.2, Gaussians give Algorithm 2.3.

use rand::RngExt;

use super::features::{Encoder, Features};
use super::gate::{Gate, Stopped};
use super::linear::value;
use super::selection::Softmax;
use crate::random::Stream;
use crate::scenario::LearningSettings;
use crate::worlds::mdp::{Mdp, PolicyTable};
use crate::worlds::{MapId, World};

/// The algorithm of a flat learner.
#[derive(Clone, Debug)]
pub enum FlatMethod {
    /// TD(0): learns V of the given policy (Algorithm 2.1).
    Td0(PolicyTable),
    /// Q-learning: learns Q of the optimal policy and chooses by softmax or epsilon-greedily
    /// (Algorithms 2.2 and 2.3).
    QLearning,
}

/// The result of an episode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Episode {
    /// Time steps.
    pub steps: u32,
    /// Whether a terminal state was reached.
    pub done: bool,
    /// The sum of the rewards.
    pub reward: f64,
}

/// A learner of values over the primitive actions of a finite world.
#[derive(Clone, Debug)]
pub struct FlatLearner<'r, W: World> {
    world: &'r W,
    encoder: &'r Encoder,
    settings: &'r LearningSettings,
    finite: &'r Mdp<W::Percept>,
    map: MapId,
    method: FlatMethod,
    softmax: Softmax,
    temperature: f32,
    /// Parameter vectors: one for each action, or a single one for V.
    theta: Vec<Vec<f32>>,
    /// Features of the present state; `next` has those of the next state.
    now: Features,
    next: Features,
}

impl<'r, W: World> FlatLearner<'r, W> {
    /// Makes a learner that has learned nothing, with the features of `map`.
    #[must_use]
    pub fn new(
        world: &'r W,
        encoder: &'r Encoder,
        settings: &'r LearningSettings,
        finite: &'r Mdp<W::Percept>,
        map: MapId,
        method: FlatMethod,
    ) -> Self {
        let width = world.catalogue().maps[map.index()].width();
        let mut vector = vec![settings.initial_parameter as f32; width];
        vector.resize(encoder.width(map), 0.0);
        let vectors = match method {
            FlatMethod::Td0(_) => 1,
            FlatMethod::QLearning => finite.actions.len(),
        };
        Self {
            world,
            encoder,
            settings,
            finite,
            map,
            method,
            softmax: Softmax::new(settings),
            temperature: settings.initial_temperature as f32,
            theta: vec![vector; vectors],
            now: encoder.features(),
            next: encoder.features(),
        }
    }

    /// Runs an episode of at most `step_limit` time steps: lines 3 to 9 of Algorithms 2.1 and
    /// 2.2, lines 3 to 21 of Algorithm 2.3.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn run_episode(
        &mut self,
        start: &W::Start,
        step_limit: u32,
        rng: &mut Stream,
        gate: &Gate,
    ) -> Result<Episode, Stopped> {
        let terminal = self.world.catalogue().terminal();
        let mut state = self.world.begin(start, rng);
        let mut episode = Episode {
            steps: 0,
            done: self.world.state_type(&state) == terminal,
            reward: 0.0,
        };
        self.now.load(self.world.percept(&state).as_ref());
        while !episode.done && episode.steps < step_limit {
            let action = self.choose(rng);
            let (primitive, own) = self.finite.actions[action];
            let reward = self.world.step(&mut state, primitive, own, rng);
            episode.steps += 1;
            episode.reward += f64::from(reward);
            episode.done = self.world.state_type(&state) == terminal;
            self.next.load(self.world.percept(&state).as_ref());
            self.learn(action, reward, episode.done);
            std::mem::swap(&mut self.now, &mut self.next);
            if episode.steps.is_multiple_of(Gate::STRIDE) {
                gate.pass(Gate::STRIDE)?;
            }
        }
        gate.pass(episode.steps % Gate::STRIDE)?;
        let cooled = self.temperature * self.settings.temperature_decrease as f32;
        self.temperature = cooled.max(self.settings.temperature_limit as f32);
        Ok(episode)
    }

    /// Chooses an action in the present state: by the given policy under TD(0), else by the
    /// learned values.
    fn choose(&mut self, rng: &mut Stream) -> usize {
        let FlatMethod::Td0(policy) = &self.method else {
            let values = values(&self.theta, self.encoder.encode(self.map, &mut self.now));
            return self.softmax.choose(&values, self.temperature, rng);
        };
        let features = self.encoder.encode(self.finite.table, &mut self.now);
        let state = features.iter().position(|&feature| feature > 0.0);
        let shares = state.map_or(&[][..], |state| &policy[state]);
        let mut draw: f64 = rng.random();
        let passed = shares.iter().take_while(|&&share| {
            draw -= share;
            draw >= 0.0
        });
        passed.count().min(self.finite.actions.len() - 1)
    }

    /// theta <- theta + alpha [r + gamma max Q(s') - Q(s, a)] phi(s), or the same with V.
    fn learn(&mut self, action: usize, reward: f32, done: bool) {
        let ahead = if done {
            0.0
        } else {
            let features = self.encoder.encode(self.map, &mut self.next);
            let values = values(&self.theta, features);
            values.into_iter().fold(f32::NEG_INFINITY, f32::max)
        };
        let features = self.encoder.encode(self.map, &mut self.now);
        let theta = match self.method {
            FlatMethod::Td0(_) => &mut self.theta[0],
            FlatMethod::QLearning => &mut self.theta[action],
        };
        let target = reward + self.settings.discount as f32 * ahead;
        let step = self.settings.learning_rate as f32 * (target - value(theta, features));
        for (parameter, feature) in theta.iter_mut().zip(features) {
            *parameter += step * feature;
        }
    }

    /// Returns Q of every action for a percept; under [`FlatMethod::Td0`] V alone.
    #[must_use]
    pub fn values(&mut self, percept: &W::Percept) -> Vec<f32> {
        self.next.load(percept.as_ref());
        values(&self.theta, self.encoder.encode(self.map, &mut self.next))
    }
}

fn values(theta: &[Vec<f32>], features: &[f32]) -> Vec<f32> {
    theta.iter().map(|vector| value(vector, features)).collect()
}
