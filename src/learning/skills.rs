//! The learned values of the primitive subtasks.

use super::features::Encoder;
use super::linear::padded;
use crate::worlds::{Catalogue, MapId, SubtaskId};

/// The action values Q_prim of one primitive subtask (Thesis Eq. 3.1, 3.9).
#[derive(Clone, Debug, PartialEq)]
pub struct Skill {
    /// The subtask.
    pub subtask: SubtaskId,
    pub(super) map: MapId,
    /// Number of features.
    width: usize,
    /// One padded parameter vector an action.
    parameters: Vec<f32>,
}

/// The one copy of the primitive subtasks that a population shares (Thesis 3.1).
#[derive(Clone, Debug, PartialEq)]
pub struct Skills {
    skills: Vec<Skill>,
}

impl Skill {
    /// A subtask that has learned nothing: every parameter at its initial value.
    #[must_use]
    pub fn new(subtask: SubtaskId, catalogue: &Catalogue, initial: f32) -> Self {
        let width = catalogue.width(subtask);
        let actions = catalogue.subtask(subtask).actions();
        let vector = vec![initial; width];
        Self::from_vectors(subtask, catalogue, &vec![vector; actions])
            .unwrap_or_else(|| unreachable!("the vectors were made to measure"))
    }

    /// A subtask with the given parameter vectors, one an action; `None` if their
    /// number or lengths are not those of the catalogue.
    #[must_use]
    pub fn from_vectors(
        subtask: SubtaskId,
        catalogue: &Catalogue,
        vectors: &[Vec<f32>],
    ) -> Option<Self> {
        let width = catalogue.width(subtask);
        let fits = vectors.len() == catalogue.subtask(subtask).actions()
            && vectors.iter().all(|vector| vector.len() == width);
        let mut parameters = Vec::with_capacity(vectors.len() * padded(width));
        for vector in vectors {
            parameters.extend_from_slice(vector);
            parameters.resize(parameters.len().next_multiple_of(padded(width)), 0.0);
        }
        fits.then_some(Self {
            subtask,
            map: catalogue.subtask(subtask).map,
            width,
            parameters,
        })
    }

    /// The parameter vectors, one an action.
    pub fn vectors(&self) -> impl Iterator<Item = &[f32]> {
        self.padded().map(|vector| &vector[..self.width])
    }

    /// The parameter vectors padded to whole lanes, one an action.
    pub(super) fn padded(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.parameters.chunks_exact(padded(self.width))
    }

    /// Q_prim of every action.
    pub(super) fn evaluate(&self, features: &[f32], values: &mut [f32]) {
        super::linear::values(&self.parameters, features, values);
    }

    /// One gradient step on an action's value (Thesis Eq. 3.6).
    pub(super) fn learn(&mut self, action: usize, features: &[f32], step: f32) {
        let stride = features.len();
        let vector = &mut self.parameters[action * stride..][..stride];
        super::linear::learn(vector, features, step);
    }

    /// Q_prim of every action for the inputs of a state.
    #[must_use]
    pub fn action_values(&self, encoder: &Encoder, inputs: &[f32]) -> Vec<f32> {
        let mut features = encoder.features();
        features.load(inputs);
        let features = encoder.encode(self.map, &mut features);
        self.padded()
            .map(|vector| super::linear::value(vector, features))
            .collect()
    }
}

impl Skills {
    /// The given skills, one for each primitive subtask of the catalogue; `None` if
    /// they are not these.
    #[must_use]
    pub fn new(skills: Vec<Skill>, catalogue: &Catalogue) -> Option<Self> {
        let complete = skills
            .iter()
            .map(|skill| skill.subtask)
            .eq(catalogue.primitives());
        complete.then_some(Self { skills })
    }

    /// All skills in the order of the catalogue's primitive subtasks.
    #[must_use]
    pub fn all(&self) -> &[Skill] {
        &self.skills
    }

    /// The skill at a place in that order.
    pub(super) fn at_mut(&mut self, index: usize) -> &mut Skill {
        &mut self.skills[index]
    }
}
