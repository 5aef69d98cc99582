//! The states that children have visited, `childSeq` of Algorithm 2.4, and with replay the
//! whole trial.

use std::ops::Range;

use super::features::Encoder;
use super::plan::{Plan, Situation};
use super::state_values::StateValues;
use crate::scenario::LearningSettings;
use crate::worlds::MapId;

/// A child that has returned to its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Return {
    /// The parent.
    pub(super) node: usize,
    pub(super) child: usize,
    /// The first of the states in which the child acted.
    pub(super) first: usize,
    /// The state in which it returned, the one after the last in which it acted.
    pub(super) end: usize,
}

/// The states visited so far, the most recent last, since the root invoked its active child or
/// since the trial began.
///
/// It holds the `childSeq` of every active subtask: each is an end of this list.
#[derive(Clone, Debug)]
pub(super) struct History {
    /// Whether a state is kept although only the root is active.
    keeps_all: bool,
    /// Whether the whole trial is kept.
    keeps_trial: bool,
    situations: Vec<Situation>,
    /// The reward of the step from each state, as composite subtasks count it.
    pub(super) rewards: Vec<f32>,
    /// Feature vectors for each map that updates need.
    features: Vec<LoggedFeatures>,
    /// The inputs in each state of the trial, one state after the other.
    inputs: Vec<f32>,
    /// The children that returned in the trial, in order.
    pub(super) returns: Vec<Return>,
}

/// The feature vectors of one map in the states in which it is needed.
#[derive(Clone, Debug)]
struct LoggedFeatures {
    map: MapId,
    width: usize,
    /// Whether it is needed in states of each type.
    needed: Vec<bool>,
    /// The vectors, one state after the other.
    vectors: Vec<f32>,
    /// For each state of the list the place of its vector.
    places: Vec<u32>,
}

/// A history of more states than this is given back when its trial is over, so that not every
/// individual of a population holds the room of its longest trial.
const KEPT_STATES: usize = 256;

impl History {
    pub(super) fn new(plan: &Plan, settings: &LearningSettings) -> Self {
        let keeps_trial = settings.replay > 0;
        let keeps_all = keeps_trial || settings.persistence > 1;
        let mut features: Vec<LoggedFeatures> = Vec::new();
        for node in plan
            .nodes
            .iter()
            .filter(|node| keeps_all || node.primitive.is_none())
        {
            let Some(parent) = node.parent else { continue };
            let completion = &node.completion;
            let known = features
                .iter()
                .position(|logged| logged.map == completion.map);
            let known = known.unwrap_or_else(|| {
                features.push(LoggedFeatures {
                    map: completion.map,
                    width: completion.stride,
                    needed: vec![false; plan.types()],
                    vectors: Vec::new(),
                    places: Vec::new(),
                });
                features.len() - 1
            });
            for (state_type, needed) in plan.state_types().zip(&mut features[known].needed) {
                *needed |= plan.can_act(parent, state_type);
            }
        }
        Self {
            keeps_all,
            keeps_trial,
            situations: Vec::new(),
            rewards: Vec::new(),
            features,
            inputs: Vec::new(),
            returns: Vec::new(),
        }
    }

    /// Returns the number of states.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.situations.len()
    }

    /// Returns whether a state is kept while `active` composite subtasks are. Where only the
    /// root is active, the one state before the step is enough.
    #[inline(always)]
    pub(super) fn keeps(&self, active: usize) -> bool {
        self.keeps_all || active > 1
    }

    /// Forgets the trial.
    pub(super) fn forget_trial(&mut self) {
        let is_long = self.len() > KEPT_STATES;
        self.clear();
        if is_long {
            self.release();
        }
    }

    /// Forgets the states after the root's child has returned, unless the trial is kept.
    #[inline]
    pub(super) fn root_returned(&mut self) {
        if !self.keeps_trial {
            self.clear();
        }
    }

    fn clear(&mut self) {
        self.situations.clear();
        self.rewards.clear();
        self.inputs.clear();
        self.returns.clear();
        for logged in &mut self.features {
            logged.vectors.clear();
            logged.places.clear();
        }
    }

    fn release(&mut self) {
        self.situations = Vec::new();
        self.rewards = Vec::new();
        self.inputs = Vec::new();
        self.returns = Vec::new();
        for logged in &mut self.features {
            logged.vectors = Vec::new();
            logged.places = Vec::new();
        }
    }

    /// Adds a state.
    #[inline]
    pub(super) fn push(&mut self, encoder: &Encoder, now: &mut StateValues) {
        self.situations.push(now.situation);
        let state_type = usize::from(now.situation.state_type.0);
        for logged in &mut self.features {
            logged.places.push(logged.vectors.len() as u32);
            if logged.needed[state_type] {
                let features = encoder.encode(logged.map, &mut now.features);
                logged.vectors.extend_from_slice(features);
            }
        }
        if self.keeps_trial {
            self.inputs.extend_from_slice(now.features.inputs());
        }
    }

    /// Adds the reward of the step from the last state.
    #[inline(always)]
    pub(super) fn rewarded(&mut self, reward: f32) {
        if self.keeps_all {
            self.rewards.push(reward);
        }
    }

    /// Adds the return of a child in the present state, if the trial is kept.
    #[inline]
    pub(super) fn returned(&mut self, returned: Return) {
        if self.keeps_trial {
            self.returns.push(returned);
        }
    }

    /// Loads the state at a place of the list.
    pub(super) fn load(&self, place: usize, values: &mut StateValues) {
        let width = self.inputs.len() / self.situations.len();
        let inputs = &self.inputs[place * width..(place + 1) * width];
        values.load(self.situations[place], inputs);
    }

    /// Returns the situation of a state.
    #[inline(always)]
    pub(super) fn situation(&self, place: usize) -> Situation {
        self.situations[place]
    }

    /// Returns where the last states before `end` begin that are all in one situation. It is not
    /// before `first`.
    #[inline(always)]
    pub(super) fn first_alike(&self, first: usize, end: usize) -> usize {
        let states = &self.situations[first..end];
        let last = self.situations[end - 1];
        end - states
            .iter()
            .rev()
            .take_while(|&&state| state == last)
            .count()
    }

    /// Returns the feature vectors of some states, one after the other. The map must be needed
    /// in all of them.
    #[inline(always)]
    pub(super) fn features(&self, map: MapId, states: Range<usize>) -> &[f32] {
        let logged = self.features.iter().find(|logged| logged.map == map);
        logged.map_or(&[], |logged| {
            let from = logged.places[states.start] as usize;
            &logged.vectors[from..from + states.len() * logged.width]
        })
    }
}
