//! The learned values of the primitive subtasks.

use super::features::Encoder;
use super::linear::{ROW, Row, STRIDE, values};
use crate::scenario::LearningSettings;
use crate::worlds::{Catalogue, MapId, SubtaskId};

/// The action values Q_prim of one primitive subtask (Thesis Eq. 3.1, 3.9).
#[derive(Clone, Debug, PartialEq)]
pub struct PrimitiveValues {
    /// The subtask.
    pub subtask: SubtaskId,
    pub(super) map: MapId,
    /// Number of features.
    width: usize,
    actions: usize,
    /// One parameter vector an action.
    parameters: Vec<f32>,
    /// The same parameters for evaluation: for every eight actions one row a feature,
    /// in whole strides.
    rows: Vec<Row>,
}

/// All primitive subtasks: the one copy that a population shares (Thesis 3.1), or an
/// individual's own.
#[derive(Clone, Debug, PartialEq)]
pub struct PrimitiveSet {
    primitives: Vec<PrimitiveValues>,
}

impl PrimitiveValues {
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
        let mut primitive = Self {
            subtask,
            map: catalogue.subtask(subtask).map,
            width,
            actions: vectors.len(),
            parameters: vectors.concat(),
            rows: Vec::new(),
        };
        let groups = vectors.len().div_ceil(ROW);
        primitive.rows = vec![[0.0; ROW]; groups * primitive.rows_per_group()];
        for (action, vector) in vectors.iter().enumerate() {
            primitive.copy_to_rows(action, vector);
        }
        fits.then_some(primitive)
    }

    /// The parameter vectors, one an action.
    pub fn vectors(&self) -> impl Iterator<Item = &[f32]> {
        self.parameters.chunks_exact(self.width)
    }

    /// Whether every parameter is a finite number; otherwise learning has diverged.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.parameters
            .iter()
            .all(|parameter| parameter.is_finite())
    }

    /// Room for Q_prim of every action.
    pub(super) fn values(&self) -> Vec<Row> {
        vec![[0.0; ROW]; self.actions.div_ceil(ROW)]
    }

    /// Computes Q_prim of every action.
    #[inline]
    pub(super) fn evaluate<'v>(&self, features: &[f32], room: &'v mut [Row]) -> &'v [f32] {
        let mut rest = &*self.rows;
        for room in &mut *room {
            let (rows, others) = rest.split_at(self.rows_per_group());
            *room = values(rows, features);
            rest = others;
        }
        &room.as_flattened()[..self.actions]
    }

    fn rows_per_group(&self) -> usize {
        self.width.next_multiple_of(STRIDE)
    }

    fn copy_to_rows(&mut self, action: usize, vector: &[f32]) {
        let group = action / ROW * self.rows_per_group();
        for (row, parameter) in self.rows[group..].iter_mut().zip(vector) {
            row[action % ROW] = *parameter;
        }
    }

    /// One gradient step on an action's value (Thesis Eq. 3.6).
    pub(super) fn learn(&mut self, action: usize, features: &[f32], step: f32) {
        let group = action / ROW * self.rows_per_group();
        let vector = &mut self.parameters[action * self.width..][..self.width];
        let rows = &mut self.rows[group..];
        for ((parameter, row), feature) in vector.iter_mut().zip(rows).zip(features) {
            *parameter += step * feature;
            row[action % ROW] = *parameter;
        }
    }

    /// Q_prim of every action for the inputs of a state.
    #[must_use]
    pub fn action_values(&self, encoder: &Encoder, inputs: &[f32]) -> Vec<f32> {
        let mut features = encoder.features();
        features.load(inputs);
        let features = encoder.encode(self.map, &mut features);
        self.evaluate(features, &mut self.values()).to_vec()
    }
}

impl PrimitiveSet {
    /// The given primitives, one for each primitive subtask of the catalogue; `None` if
    /// they are not these.
    #[must_use]
    pub fn new(primitives: Vec<PrimitiveValues>, catalogue: &Catalogue) -> Option<Self> {
        let complete = primitives
            .iter()
            .map(|primitive| primitive.subtask)
            .eq(catalogue.primitives());
        complete.then_some(Self { primitives })
    }

    /// PrimitiveSet that have learned nothing.
    #[must_use]
    pub fn untrained(catalogue: &Catalogue, settings: &LearningSettings) -> Self {
        let initial = settings.initial_parameter as f32;
        let primitives = catalogue.primitives();
        Self {
            primitives: primitives
                .map(|subtask| PrimitiveValues::new(subtask, catalogue, initial))
                .collect(),
        }
    }

    /// All primitives in the order of the catalogue's primitive subtasks.
    #[must_use]
    pub fn all(&self) -> &[PrimitiveValues] {
        &self.primitives
    }

    /// The primitive at a place in that order.
    pub(super) fn at_mut(&mut self, index: usize) -> &mut PrimitiveValues {
        &mut self.primitives[index]
    }
}
