//! Normalised Gaussian RBF features (Thesis Eq. 2.22).
//!
//! On a full grid with one width per axis the normalised features factorise into
//! products of one-dimensional normalised features: five proximity sensors with two
//! centres each need five exponentials, not 32. On one axis, with d the offset of
//! the input from its nearest centre j, spacing h and width sigma,
//!
//! ```text
//! exp(-(x - c_k)^2 / 2 sigma^2)  ~  r^(k - j) g(k - j),
//! r = exp(d h / sigma^2),  g(m) = exp(-(m h)^2 / 2 sigma^2)
//! ```
//!
//! up to a factor that normalisation removes: one exponential per axis.

use super::exponential::{LANES, exponentials};
use super::linear::padded;
use crate::worlds::{Axis, Catalogue, MapId};

/// An axis of a feature map, prepared.
#[derive(Clone, Debug, PartialEq)]
struct AxisTable {
    axis: Axis,
    /// Number of centres minus 1: the inverse of their spacing.
    intervals: f32,
    /// h / sigma^2.
    slope: f32,
    /// g(0), g(1), ...
    decay: Vec<f32>,
    /// Where the axis's features start among those of all axes.
    offset: usize,
}

/// Computes features from inputs.
#[derive(Clone, Debug)]
pub struct Encoder {
    axes: Vec<AxisTable>,
    /// For each map its axes, the first varying slowest.
    maps: Vec<Vec<usize>>,
    widths: Vec<usize>,
}

/// The features of one state: each is computed when first asked for, and once.
#[derive(Clone, Debug)]
pub struct Features {
    inputs: Vec<f32>,
    along_axes: Vec<f32>,
    axes_ready: u64,
    maps: Vec<Vec<f32>>,
    maps_ready: u64,
}

impl Encoder {
    /// Prepares the feature maps of a catalogue.
    #[must_use]
    pub fn new(catalogue: &Catalogue) -> Self {
        let mut axes: Vec<AxisTable> = Vec::new();
        let mut offset = 0;
        let mut shared = |axis: &Axis| {
            if let Some(known) = axes.iter().position(|table| table.axis == *axis) {
                return known;
            }
            axes.push(AxisTable::new(*axis, offset));
            offset += axis.centres;
            axes.len() - 1
        };
        let maps = catalogue.maps.iter();
        let maps = maps
            .map(|map| map.axes.iter().map(&mut shared).collect())
            .collect();
        Self {
            axes,
            maps,
            widths: catalogue
                .maps
                .iter()
                .map(|map| padded(map.width()))
                .collect(),
        }
    }

    /// Length of the feature vectors of a map, padded with zeros to whole lanes.
    #[must_use]
    pub fn width(&self, map: MapId) -> usize {
        self.widths[map.index()]
    }

    /// Room for the features of a state.
    #[must_use]
    pub fn features(&self) -> Features {
        let along_axes = self.axes.iter().map(|table| table.axis.centres).sum();
        Features {
            inputs: Vec::new(),
            along_axes: vec![0.0; along_axes],
            axes_ready: 0,
            maps: self.widths.iter().map(|&width| vec![0.0; width]).collect(),
            maps_ready: 0,
        }
    }

    /// The feature vector of a map in the state that `features` holds.
    #[inline]
    pub fn encode<'f>(&self, map: MapId, features: &'f mut Features) -> &'f [f32] {
        let bit = 1 << map.0;
        if features.maps_ready & bit == 0 {
            features.maps_ready |= bit;
            self.compute(map, features);
        }
        &features.maps[map.index()]
    }

    fn compute(&self, map: MapId, features: &mut Features) {
        let axes = &self.maps[map.index()];
        self.compute_axes(axes, features);
        let out = &mut features.maps[map.index()];
        out[0] = 1.0;
        let mut width = 1;
        for &axis in axes.iter().rev() {
            let table = &self.axes[axis];
            let factors = &features.along_axes[table.offset..][..table.axis.centres];
            width = extend(out, width, factors);
        }
    }

    /// Computes the features along those of the given axes that are not ready.
    fn compute_axes(&self, axes: &[usize], features: &mut Features) {
        for axes in axes.chunks(LANES) {
            let mut ratios = [0.0; LANES];
            let mut nearest = [0; LANES];
            for ((&axis, ratio), nearest) in axes.iter().zip(&mut ratios).zip(&mut nearest) {
                let table = &self.axes[axis];
                (*nearest, *ratio) = table.locate(features.inputs[table.axis.input]);
            }
            exponentials(&mut ratios);
            for ((&axis, ratio), nearest) in axes.iter().zip(ratios).zip(nearest) {
                let table = &self.axes[axis];
                if features.axes_ready & (1 << axis) == 0 {
                    features.axes_ready |= 1 << axis;
                    let out = &mut features.along_axes[table.offset..][..table.axis.centres];
                    table.fill(out, nearest, ratio);
                }
            }
        }
    }
}

impl Features {
    /// Holds another state from now on.
    #[inline]
    pub fn load(&mut self, inputs: &[f32]) {
        self.inputs.clear();
        self.inputs.extend_from_slice(inputs);
        self.axes_ready = 0;
        self.maps_ready = 0;
    }
}

/// Multiplies the first `width` numbers by each factor, one block a factor, and
/// returns the new width.
#[inline(always)]
fn extend(out: &mut [f32], width: usize, factors: &[f32]) -> usize {
    let (base, rest) = out.split_at_mut(width);
    for (block, factor) in rest.chunks_exact_mut(width).zip(&factors[1..]) {
        for (product, value) in block.iter_mut().zip(&*base) {
            *product = value * factor;
        }
    }
    for value in base {
        *value *= factors[0];
    }
    width * factors.len()
}

impl AxisTable {
    fn new(axis: Axis, offset: usize) -> Self {
        let spacing = 1.0 / (axis.centres - 1) as f64;
        let variance = axis.sigma * axis.sigma;
        let decay = |m| {
            let distance = m as f64 * spacing;
            libm::exp(-distance * distance / (2.0 * variance)) as f32
        };
        Self {
            axis,
            intervals: (axis.centres - 1) as f32,
            slope: (spacing / variance) as f32,
            decay: (0..axis.centres).map(decay).collect(),
            offset,
        }
    }

    /// The nearest centre, and the logarithm of r.
    #[inline(always)]
    fn locate(&self, input: f32) -> (usize, f32) {
        let position = input * self.intervals;
        let nearest = ((position + 0.5) as usize).min(self.axis.centres - 1);
        let offset = (position - nearest as f32) / self.intervals;
        (nearest, offset * self.slope)
    }

    /// The normalised features, from r and the nearest centre.
    #[inline(always)]
    fn fill(&self, out: &mut [f32], nearest: usize, ratio: f32) {
        let inverse = 1.0 / ratio;
        let (below, above) = out.split_at_mut(nearest);
        let mut sum = 0.0;
        let mut power = 1.0;
        for (feature, decay) in above.iter_mut().zip(&self.decay) {
            *feature = power * decay;
            sum += *feature;
            power *= ratio;
        }
        let mut power = inverse;
        for (feature, decay) in below.iter_mut().rev().zip(&self.decay[1..]) {
            *feature = power * decay;
            sum += *feature;
            power *= inverse;
        }
        let scale = 1.0 / sum;
        for feature in out {
            *feature *= scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{RbfWidth, Scenario, WorldModel};
    use crate::worlds::World;
    use crate::worlds::foraging::{ForagingWorld, INPUTS};
    use proptest::prelude::*;

    fn world(width: RbfWidth, proximity_centres: usize) -> ForagingWorld {
        let WorldModel::Foraging(mut model) = Scenario::load("environment-1").unwrap().world;
        model.features.rbf_width = width;
        model.features.proximity_centres = proximity_centres;
        ForagingWorld::new(&model).unwrap()
    }

    /// Equation 2.22 as it is printed, on the whole grid.
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
            inputs in prop::array::uniform7(0.0..=1.0_f32),
            variance in any::<bool>(),
            proximity_centres in 2..=3_usize,
        ) {
            let width = if variance { RbfWidth::Variance } else { RbfWidth::Spacing };
            let world = world(width, proximity_centres);
            let encoder = Encoder::new(world.catalogue());
            let mut features = encoder.features();
            prop_assert_eq!(inputs.len(), INPUTS);
            // Twice, so that nothing is left over from another state.
            features.load(&[0.3; INPUTS]);
            encoder.encode(MapId(1), &mut features);
            features.load(&inputs);
            for (index, map) in world.catalogue().maps.iter().enumerate() {
                let encoded = encoder.encode(MapId(index as u8), &mut features);
                let expected = by_definition(&map.axes, &inputs);
                for (feature, expected) in encoded.iter().zip(&expected) {
                    prop_assert!((f64::from(*feature) - expected).abs() < 1e-6);
                }
                prop_assert!(encoded[expected.len()..].iter().all(|&padding| padding == 0.0));
            }
        }
    }
}
