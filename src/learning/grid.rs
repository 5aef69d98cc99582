//! One feature map as products of Gaussians over a few inputs each.

use pulp::{Simd, WithSimd};

use super::exponential::exponentials;
use super::linear::{padded, total};
use crate::worlds::{Axis, FeatureMap, MapId};

/// Gaussians that are computed at once.
///
/// Axes form one group as long as they have no more Gaussians than this: enough to fill
/// a vector, few enough to save exponentials.
const LANES: usize = 8;

/// The term that one input adds to the exponents of eight Gaussians.
#[derive(Clone, Debug)]
struct Term {
    input: usize,
    /// Infinity in lanes without a Gaussian.
    centres: [f32; LANES],
    /// -1 / (2 sigma^2).
    exponent: f32,
}

/// Gaussians over the axes of a group, the last axis varying fastest.
#[derive(Clone, Debug)]
pub(super) struct Group {
    size: usize,
    /// For every eight Gaussians one term for each axis.
    terms: Vec<Vec<Term>>,
}

/// A feature map, prepared for computation.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Padded number of features.
    pub(super) width: usize,
    /// The map whose features the grid starts from, and their number.
    pub(super) base: Option<(MapId, usize)>,
    /// The remaining axes in groups, the fastest varying group first.
    pub(super) groups: Vec<Group>,
}

impl Grid {
    pub(super) fn new(map: &FeatureMap, maps: &[FeatureMap]) -> Self {
        let all = map.axes();
        let ends_in = |(_, other): &(usize, &FeatureMap)| {
            let axes = other.axes();
            (1..all.len()).contains(&axes.len()) && all.ends_with(axes)
        };
        let base = maps.iter().enumerate().filter(ends_in);
        let base = base.max_by_key(|(_, other)| other.axes().len());
        let own = all.len() - base.map_or(0, |(_, other)| other.axes().len());
        let mut groups = Vec::new();
        let mut axes = &all[..own];
        while !axes.is_empty() {
            let group = |count| &axes[axes.len() - count..];
            let fits = |&count: &usize| count == 1 || size(group(count)) <= LANES;
            let count = (1..=axes.len()).take_while(fits).count();
            groups.push(Group::new(group(count)));
            axes = &axes[..axes.len() - count];
        }
        Self {
            width: padded(map.width()),
            base: base.map(|(index, other)| (MapId(index as u8), other.width())),
            groups,
        }
    }
}

/// Returns the number of Gaussians on the grid of some axes.
fn size(axes: &[Axis]) -> usize {
    axes.iter().map(|axis| axis.centres).product()
}

impl Group {
    fn new(axes: &[Axis]) -> Self {
        let size = size(axes);
        let term = |first: usize, axis: usize| {
            let period: usize = self::size(&axes[axis + 1..]);
            let axis = &axes[axis];
            let centre = |gaussian: usize| {
                if gaussian < size {
                    (gaussian / period % axis.centres) as f32 / (axis.centres - 1) as f32
                } else {
                    f32::INFINITY
                }
            };
            Term {
                input: axis.input,
                centres: std::array::from_fn(|lane| centre(first + lane)),
                exponent: (-0.5 / (axis.sigma * axis.sigma)) as f32,
            }
        };
        let terms = (0..size).step_by(LANES);
        Self {
            size,
            terms: terms
                .map(|first| (0..axes.len()).map(|axis| term(first, axis)).collect())
                .collect(),
        }
    }

    /// Returns the number of Gaussians, padded to whole lanes.
    pub(super) fn lanes(&self) -> usize {
        self.terms.len() * LANES
    }

    /// Computes the Gaussians and returns their sum.
    #[inline(always)]
    fn evaluate<S: Simd>(&self, simd: S, inputs: &[f32], gaussians: &mut [f32]) -> f32 {
        let mut sums = [simd.splat_f32s(0.0); LANES];
        let lanes = gaussians.as_chunks_mut::<LANES>().0;
        for (lanes, terms) in lanes.iter_mut().zip(&self.terms) {
            let registers = S::as_mut_simd_f32s(lanes).0.iter_mut().enumerate();
            for (register, gaussians) in registers {
                let mut exponents = simd.splat_f32s(0.0);
                for term in terms {
                    let input = simd.splat_f32s(inputs[term.input]);
                    let centres = S::as_simd_f32s(&term.centres).0[register];
                    let offset = simd.sub_f32s(input, centres);
                    let square = simd.mul_f32s(offset, offset);
                    let exponent = simd.splat_f32s(term.exponent);
                    exponents = simd.add_f32s(exponents, simd.mul_f32s(square, exponent));
                }
                *gaussians = exponentials(simd, exponents);
                sums[register] = simd.add_f32s(sums[register], *gaussians);
            }
        }
        total(simd, &mut sums[..LANES / S::F32_LANES])
    }
}

/// Computes the features of one map.
pub(super) struct Compute<'a> {
    pub(super) grid: &'a Grid,
    pub(super) inputs: &'a [f32],
    /// The features that the grid starts from.
    pub(super) base: Option<&'a [f32]>,
    pub(super) gaussians: &'a mut [f32],
    pub(super) out: &'a mut [f32],
}

impl WithSimd for Compute<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { grid, out, .. } = self;
        let mut sum = 1.0;
        let mut rest = &mut *self.gaussians;
        for group in &grid.groups {
            let (gaussians, others) = rest.split_at_mut(group.lanes());
            sum *= group.evaluate(simd, self.inputs, gaussians);
            rest = others;
        }
        let Some((group, groups)) = grid.groups.split_first() else {
            return;
        };
        // One division normalises along all axes.
        let scale = 1.0 / sum;
        let (gaussians, mut rest) = self.gaussians.split_at(group.lanes());
        let gaussians = &gaussians[..group.size];
        let mut width = group.size;
        if let Some(base) = self.base {
            let mut out = &mut *out;
            for gaussian in gaussians {
                let (block, others) = out.split_at_mut(base.len());
                scaled(simd, block, base, gaussian * scale);
                out = others;
            }
            width *= base.len();
        } else {
            scaled(simd, &mut out[..width], gaussians, scale);
        }
        for group in groups {
            let (gaussians, others) = rest.split_at(group.lanes());
            extend(simd, out, width, &gaussians[..group.size]);
            width *= group.size;
            rest = others;
        }
    }
}

/// Multiplies the first `width` numbers by each factor, giving one block for each factor.
#[inline(always)]
fn extend<S: Simd>(simd: S, out: &mut [f32], width: usize, factors: &[f32]) {
    let (base, mut rest) = out.split_at_mut(width);
    for &factor in &factors[1..] {
        let (block, others) = rest.split_at_mut(width);
        scaled(simd, block, base, factor);
        rest = others;
    }
    for number in base {
        *number *= factors[0];
    }
}

/// `out = numbers * factor`, for vectors of the same length.
#[inline(always)]
fn scaled<S: Simd>(simd: S, out: &mut [f32], numbers: &[f32], factor: f32) {
    let (out_vectors, out_rest) = S::as_mut_simd_f32s(out);
    let (vectors, rest) = S::as_simd_f32s(numbers);
    let splat = simd.splat_f32s(factor);
    for (out, vector) in out_vectors.iter_mut().zip(vectors) {
        *out = simd.mul_f32s(*vector, splat);
    }
    for (out, number) in out_rest.iter_mut().zip(rest) {
        *out = number * factor;
    }
}
