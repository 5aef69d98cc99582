//! What an active composite child has visited: the states that its parent learns from
//! when it returns.

use std::ops::Range;

use super::features::Encoder;
use super::plan::Plan;
use super::state_values::StateValues;
use crate::scenario::{CompletionBootstrap, LearningSettings};
use crate::worlds::{MapId, StateType};

/// The states since the root's present child was invoked, most recent last
/// (`childSeq` of all active subtasks).
#[derive(Clone, Debug, Default)]
pub(super) struct Visited<P> {
    pub(super) types: Vec<StateType>,
    /// Feature vectors for each map that a completion function of a composite child uses.
    features: Vec<LoggedFeatures>,
    /// Percepts, where the bootstrap value is taken in the updated state.
    pub(super) percepts: Option<Vec<P>>,
}

/// The feature vectors of one map, one state after the other.
#[derive(Clone, Debug)]
struct LoggedFeatures {
    map: MapId,
    width: usize,
    vectors: Vec<f32>,
}

impl<P> Visited<P> {
    pub(super) fn new(plan: &Plan, settings: &LearningSettings) -> Self {
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
            percepts: (settings.completion_bootstrap == CompletionBootstrap::AsPrinted)
                .then(Vec::new),
        }
    }

    pub(super) fn clear(&mut self) {
        self.types.clear();
        for logged in &mut self.features {
            logged.vectors.clear();
        }
        if let Some(percepts) = &mut self.percepts {
            percepts.clear();
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
