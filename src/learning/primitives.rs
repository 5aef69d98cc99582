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
    /// One parameter vector for each action.
    parameters: Vec<f32>,
    /// The same parameters for evaluation: for every eight actions one row for each feature,
    /// in whole strides.
    rows: Vec<Row>,
}

/// The learned values of all primitive subtasks: the one copy that a population shares
/// (Thesis 3.1), or an individual's own.
#[derive(Clone, Debug, PartialEq)]
pub struct PrimitiveSet {
    primitives: Vec<PrimitiveValues>,
}

impl PrimitiveValues {
    /// Makes the values of a subtask that has learned nothing: every parameter is `initial`.
    #[must_use]
    pub fn new(subtask: SubtaskId, catalogue: &Catalogue, initial: f32) -> Self {
        let width = catalogue.width(subtask);
        let actions = catalogue.subtask(subtask).actions();
        let vector = vec![initial; width];
        Self::from_vectors(subtask, catalogue, &vec![vector; actions])
            .unwrap_or_else(|| unreachable!("the vectors have the catalogue's lengths"))
    }

    /// Makes the values of a subtask from parameter vectors, one for each action.
    ///
    /// Returns `None` if their number or lengths do not fit the catalogue.
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

    /// Returns the parameter vectors, one for each action.
    pub fn vectors(&self) -> impl Iterator<Item = &[f32]> {
        self.parameters.chunks_exact(self.width)
    }

    /// Returns whether every parameter is finite. Otherwise learning has diverged.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.parameters
            .iter()
            .all(|parameter| parameter.is_finite())
    }

    /// Makes room for Q_prim of every action.
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

    /// Takes one gradient step on an action's value (Thesis Eq. 3.6).
    pub(super) fn learn(&mut self, action: usize, features: &[f32], step: f32) {
        let group = action / ROW * self.rows_per_group();
        let vector = &mut self.parameters[action * self.width..][..self.width];
        let rows = &mut self.rows[group..];
        for ((parameter, row), feature) in vector.iter_mut().zip(rows).zip(features) {
            *parameter += step * feature;
            row[action % ROW] = *parameter;
        }
    }

    /// Returns Q_prim of every action for the inputs of a state.
    #[must_use]
    pub fn action_values(&self, encoder: &Encoder, inputs: &[f32]) -> Vec<f32> {
        let mut features = encoder.features();
        features.load(inputs);
        let features = encoder.encode(self.map, &mut features);
        self.evaluate(features, &mut self.values()).to_vec()
    }
}

impl PrimitiveSet {
    /// Makes a set of the values of every primitive subtask, in the catalogue's order.
    ///
    /// Returns `None` if a subtask is missing, surplus or out of order.
    #[must_use]
    pub fn new(primitives: Vec<PrimitiveValues>, catalogue: &Catalogue) -> Option<Self> {
        let complete = primitives
            .iter()
            .map(|primitive| primitive.subtask)
            .eq(catalogue.primitives());
        complete.then_some(Self { primitives })
    }

    /// Makes a set that has learned nothing.
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

    /// Returns the values of all primitive subtasks, in the catalogue's order.
    #[must_use]
    pub fn all(&self) -> &[PrimitiveValues] {
        &self.primitives
    }

    /// Returns the values at a place in that order.
    pub(super) fn at_mut(&mut self, index: usize) -> &mut PrimitiveValues {
        &mut self.primitives[index]
    }
}
