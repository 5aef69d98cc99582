//! The states that composite children have visited: `childSeq` of Algorithm 2.4.

use std::ops::Range;

use super::features::Encoder;
use super::plan::Plan;
use super::state_values::StateValues;
use crate::worlds::{MapId, StateType};

/// The states visited since the root invoked its active child, the most recent last.
///
/// It holds the `childSeq` of every active subtask: each is an end of this list.
#[derive(Clone, Debug, Default)]
pub(super) struct Visited {
    pub(super) types: Vec<StateType>,
    /// Feature vectors for each map that a completion function of a composite child uses.
    features: Vec<LoggedFeatures>,
}

/// The feature vectors of one map, one state after the other.
#[derive(Clone, Debug)]
struct LoggedFeatures {
    map: MapId,
    width: usize,
    vectors: Vec<f32>,
}

impl Visited {
    pub(super) fn new(plan: &Plan) -> Self {
        let mut features: Vec<LoggedFeatures> = Vec::new();
        for node in plan.nodes.iter().filter(|node| node.primitive.is_none()) {
            let completion = &node.completion;
            let known = features.iter().any(|logged| logged.map == completion.map);
            if node.parent.is_some() && !known {
                features.push(LoggedFeatures {
                    map: completion.map,
                    width: completion.stride,
                    vectors: Vec::new(),
                });
            }
        }
        Self {
            types: Vec::new(),
            features,
        }
    }

    pub(super) fn clear(&mut self) {
        self.types.clear();
        for logged in &mut self.features {
            logged.vectors.clear();
        }
    }

    #[inline]
    pub(super) fn push(&mut self, encoder: &Encoder, now: &mut StateValues) {
        self.types.push(now.state_type);
        for logged in &mut self.features {
            let features = encoder.encode(logged.map, &mut now.features);
            logged.vectors.extend_from_slice(features);
        }
    }

    /// The feature vectors of some states, one after the other.
    #[inline(always)]
    pub(super) fn features(&self, map: MapId, states: Range<usize>) -> &[f32] {
        let logged = self.features.iter().find(|logged| logged.map == map);
        logged.map_or(&[], |logged| {
            &logged.vectors[states.start * logged.width..states.end * logged.width]
        })
    }
}
