//! Features of inputs: normalised Gaussians (Thesis Eq. 2.22), or tables.
//!
//! On a full grid with one width for each axis, the normalised features are products of
//! Gaussians over a few inputs each: five proximity sensors with two centres each need
//! 8 + 4 exponentials, not 32. A map whose last axes are those of another map starts from
//! the features of that map.
//!
//! A table is one-hot: the value is one parameter, and an update changes that one only.

use pulp::Arch;

use super::grid::{Compute, Grid, Group};
use super::linear::padded;
use crate::worlds::{Catalogue, FeatureKind, FeatureMap, Index, MapId};

/// Computes feature vectors from inputs.
#[derive(Clone, Debug)]
pub struct Encoder {
    maps: Vec<Map>,
}

/// A feature map, prepared for computation.
#[derive(Clone, Debug)]
enum Map {
    Gaussian(Grid),
    Table(Table),
}

/// One feature for each combination of the values of some inputs.
#[derive(Clone, Debug)]
struct Table {
    /// Padded number of features.
    width: usize,
    indices: Vec<Index>,
}

/// The feature vectors of one state. Each is computed once, when it is first needed.
#[derive(Clone, Debug)]
pub struct Features {
    inputs: Vec<f32>,
    /// Room for the Gaussians of one map, each group in whole lanes.
    gaussians: Vec<f32>,
    maps: Vec<Vec<f32>>,
    /// One bit for each map: whether its vector has been computed.
    ready: u64,
}

impl Encoder {
    /// Prepares the feature maps of a catalogue.
    #[must_use]
    pub fn new(catalogue: &Catalogue) -> Self {
        let maps = &catalogue.maps;
        let prepare = |map: &FeatureMap| match &map.kind {
            FeatureKind::Gaussian(_) => Map::Gaussian(Grid::new(map, maps)),
            FeatureKind::Table(indices) => Map::Table(Table {
                width: padded(map.width()),
                indices: indices.clone(),
            }),
        };
        Self {
            maps: maps.iter().map(prepare).collect(),
        }
    }

    /// Returns the length of a map's feature vectors, which are padded with zeros to whole
    /// lanes.
    #[must_use]
    pub fn width(&self, map: MapId) -> usize {
        self.maps[map.index()].width()
    }

    /// Makes room for the features of a state.
    #[must_use]
    pub fn features(&self) -> Features {
        let gaussians = self.maps.iter().map(|map| match map {
            Map::Gaussian(grid) => grid.groups.iter().map(Group::lanes).sum(),
            Map::Table(_) => 0,
        });
        Features {
            inputs: Vec::new(),
            gaussians: vec![0.0; gaussians.max().unwrap_or(0)],
            maps: self.maps.iter().map(|map| vec![0.0; map.width()]).collect(),
            ready: 0,
        }
    }

    /// Returns the feature vector of a map in the state that `features` holds.
    #[inline]
    pub fn encode<'f>(&self, map: MapId, features: &'f mut Features) -> &'f [f32] {
        let bit = 1 << map.0;
        if features.ready & bit == 0 {
            features.ready |= bit;
            self.compute(map, features);
        }
        &features.maps[map.index()]
    }

    fn compute(&self, map: MapId, features: &mut Features) {
        let grid = match &self.maps[map.index()] {
            Map::Gaussian(grid) => grid,
            Map::Table(table) => {
                table.compute(&features.inputs, &mut features.maps[map.index()]);
                return;
            }
        };
        if let Some((base, _)) = grid.base {
            self.encode(base, features);
        }
        // Taken out, so that the features of the base map can be read at the same time.
        let mut out = std::mem::take(&mut features.maps[map.index()]);
        Arch::new().dispatch(Compute {
            grid,
            inputs: &features.inputs,
            base: grid
                .base
                .map(|(base, width)| &features.maps[base.index()][..width]),
            gaussians: &mut features.gaussians,
            out: &mut out,
        });
        features.maps[map.index()] = out;
    }
}

impl Map {
    fn width(&self) -> usize {
        match self {
            Self::Gaussian(grid) => grid.width,
            Self::Table(table) => table.width,
        }
    }
}

impl Table {
    fn compute(&self, inputs: &[f32], out: &mut [f32]) {
        out.fill(0.0);
        out[self.feature(inputs)] = 1.0;
    }

    /// Returns the index of the feature that is 1. An input that is out of range counts as
    /// its largest value.
    fn feature(&self, inputs: &[f32]) -> usize {
        let indices = self.indices.iter();
        indices.fold(0, |place, index| {
            let value = (inputs[index.input] as usize).min(index.values - 1);
            place * index.values + value
        })
    }
}

impl Features {
    /// Returns the inputs of the state.
    pub(super) fn inputs(&self) -> &[f32] {
        &self.inputs
    }

    /// Loads the inputs of another state.
    #[inline]
    pub fn load(&mut self, inputs: &[f32]) {
        self.inputs.clear();
        self.inputs.extend_from_slice(inputs);
        self.ready = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Scenario;
    use crate::worlds::foraging::{ForagingWorld, INPUTS, RbfWidth};
    use crate::worlds::{Axis, World, WorldSettings};
    use proptest::prelude::*;

    fn world(width: RbfWidth, proximity_centres: usize) -> ForagingWorld {
        let WorldSettings::Foraging(mut settings) = Scenario::load("environment-1").unwrap().world
        else {
            unreachable!("it is a foraging scenario");
        };
        settings.features.rbf_width = width;
        settings.features.proximity_centres = proximity_centres;
        ForagingWorld::new(&settings).unwrap()
    }

    /// Equation 2.22 as printed, on the whole grid.
    fn by_definition(axes: &[Axis], inputs: &[f32]) -> Vec<f64> {
        let mut features = vec![1.0];
        for axis in axes {
            let gaussian = |k: usize| {
                let centre = k as f64 / (axis.centres - 1) as f64;
                let distance = f64::from(inputs[axis.input]) - centre;
                (-distance * distance / (2.0 * axis.sigma * axis.sigma)).exp()
            };
            features = features
                .iter()
                .flat_map(|f| (0..axis.centres).map(move |k| f * gaussian(k)))
                .collect();
        }
        let sum: f64 = features.iter().sum();
        features.iter().map(|feature| feature / sum).collect()
    }

    proptest! {
        #[test]
        fn the_factorised_features_are_those_of_the_definition(
            inputs in prop::array::uniform8(0.0..=1.0_f32),
            variance in any::<bool>(),
            proximity_centres in 2..=3_usize,
        ) {
            let width = if variance { RbfWidth::Variance } else { RbfWidth::Spacing };
            let world = world(width, proximity_centres);
            let encoder = Encoder::new(world.catalogue());
            let mut features = encoder.features();
            prop_assert_eq!(inputs.len(), INPUTS);
            // Two states, so that a vector left over from the first would show.
            features.load(&[0.3; INPUTS]);
            encoder.encode(MapId(1), &mut features);
            features.load(&inputs);
            for (index, map) in world.catalogue().maps.iter().enumerate() {
                let encoded = encoder.encode(MapId(index as u8), &mut features);
                let expected = by_definition(map.axes(), &inputs);
                for (feature, expected) in encoded.iter().zip(&expected) {
                    prop_assert!((f64::from(*feature) - expected).abs() < 1e-6);
                }
                prop_assert!(encoded[expected.len()..].iter().all(|&padding| padding == 0.0));
            }
        }
    }
}
