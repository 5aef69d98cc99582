//! Selection probabilities: how often a hierarchy ends in each primitive subtask (Thesis
//! 4.5.4).

use super::features::Encoder;
use super::gate::{Gate, Stopped};
use super::hierarchy::Hierarchy;
use super::policy::Policy;
use super::primitives::PrimitiveSet;
use crate::random::Stream;
use crate::scenario::LearningSettings;
use crate::worlds::World;

/// Sampled states of each type, in which selection probabilities are computed.
#[derive(Clone, Debug)]
pub struct PolicySamples<P> {
    by_type: Vec<Vec<P>>,
}

/// For each state type the probability of selecting each primitive subtask, in the
/// catalogue's order; `None` where no state of the type was found.
pub type SelectionProbabilities = Vec<Option<Vec<f64>>>;

impl<P: Copy + AsRef<[f32]>> PolicySamples<P> {
    /// Samples `count` states of each type, or fewer where states are hard to find.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn draw<W: World<Percept = P>>(
        world: &W,
        count: usize,
        rng: &mut Stream,
        gate: &Gate,
    ) -> Result<Self, Stopped> {
        let mut by_type = Vec::new();
        for state_type in world.catalogue().types() {
            let mut percepts = Vec::with_capacity(count);
            while percepts.len() < count {
                gate.pass(0)?;
                match world.sample(state_type, rng) {
                    Some(percept) => percepts.push(percept),
                    None => break,
                }
            }
            by_type.push(percepts);
        }
        Ok(Self { by_type })
    }

    /// Returns the selection probabilities of a hierarchy, averaged over the sampled states.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn probabilities<W: World<Percept = P>>(
        &self,
        world: &W,
        encoder: &Encoder,
        settings: &LearningSettings,
        hierarchy: &Hierarchy,
        primitives: &PrimitiveSet,
        gate: &Gate,
    ) -> Result<SelectionProbabilities, Stopped> {
        let catalogue = world.catalogue();
        let mut policy = Policy::new(catalogue, encoder, settings, hierarchy, primitives);
        let mut by_type = Vec::with_capacity(self.by_type.len());
        for (state_type, percepts) in catalogue.types().zip(&self.by_type) {
            let mut totals = vec![0.0; primitives.all().len()];
            for percepts in percepts.chunks(Gate::STRIDE as usize) {
                gate.pass(0)?;
                for percept in percepts {
                    policy.look(state_type, percept.as_ref());
                    policy.add_probabilities(&mut totals);
                }
            }
            let count = percepts.len() as f64;
            let shares = totals.iter().map(|total| total / count);
            by_type.push((!percepts.is_empty()).then(|| shares.collect()));
        }
        Ok(by_type)
    }
}

/// Returns the average of several hierarchies' selection probabilities.
#[must_use]
pub fn average(all: &[SelectionProbabilities]) -> SelectionProbabilities {
    let Some(first) = all.first() else {
        return Vec::new();
    };
    let types = 0..first.len();
    types
        .map(|state_type| {
            let rows: Option<Vec<_>> = all.iter().map(|each| each[state_type].as_ref()).collect();
            rows.map(|rows| {
                let primitives = 0..rows[0].len();
                let mean = |primitive: usize| {
                    rows.iter().map(|row| row[primitive]).sum::<f64>() / rows.len() as f64
                };
                primitives.map(mean).collect()
            })
        })
        .collect()
}
