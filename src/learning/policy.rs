//! Which primitive subtasks a hierarchy selects (Thesis 4.5.4).

use super::features::Encoder;
use super::gate::{Gate, Stopped};
use super::hierarchy::Hierarchy;
use super::plan::Plan;
use super::selection::Softmax;
use super::situation::{Completion, Mind, Situation};
use super::skills::Skills;
use crate::random::Stream;
use crate::scenario::{CompositeChoice, LearningModel};
use crate::worlds::World;

/// Sampled states of each type, in which policies are measured.
#[derive(Clone, Debug)]
pub struct PolicySamples<P> {
    by_type: Vec<Vec<P>>,
}

/// For each state type the probability with which each primitive subtask, in the
/// catalogue's order, is selected; `None` where no state of the type was found.
pub type SelectionProbabilities = Vec<Option<Vec<f64>>>;

impl<P: Copy + AsRef<[f32]>> PolicySamples<P> {
    /// Samples `count` states of each type; fewer where they are hard to find.
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

    /// The probabilities with which the policy of a hierarchy, followed from the root
    /// down, ends in each primitive subtask, averaged over the sampled states.
    ///
    /// # Errors
    /// When the gate is stopped.
    pub fn probabilities<W: World<Percept = P>>(
        &self,
        world: &W,
        encoder: &Encoder,
        model: &LearningModel,
        hierarchy: &Hierarchy,
        skills: &Skills,
        gate: &Gate,
    ) -> Result<SelectionProbabilities, Stopped> {
        let catalogue = world.catalogue();
        let (tree, values) = hierarchy.clone().into_parts();
        let mind = Mind {
            encoder,
            plan: Plan::new(&tree, catalogue, |map| encoder.width(map)),
            values,
            skills: skills.clone(),
        };
        let mut walk = Walk {
            now: Situation::new(&mind, catalogue.terminal()),
            mind,
            softmax: Softmax::new(model),
            random: model.composite_choice == CompositeChoice::Random,
            totals: Vec::new(),
        };
        let mut by_type = Vec::with_capacity(self.by_type.len());
        for (state_type, percepts) in catalogue.types().zip(&self.by_type) {
            walk.totals = vec![0.0; skills.all().len()];
            for percepts in percepts.chunks(Gate::STRIDE as usize) {
                gate.pass(0)?;
                for percept in percepts {
                    walk.now.load(state_type, percept.as_ref());
                    walk.descend(0, 1.0);
                }
            }
            let count = percepts.len() as f64;
            let shares = walk.totals.iter().map(|total| total / count);
            by_type.push((!percepts.is_empty()).then(|| shares.collect()));
        }
        Ok(by_type)
    }
}

/// A walk down a hierarchy that splits probability at every choice.
struct Walk<'r> {
    mind: Mind<'r>,
    now: Situation,
    softmax: Softmax,
    random: bool,
    totals: Vec<f64>,
}

impl Walk<'_> {
    fn descend(&mut self, node: usize, probability: f64) {
        if let Some(skill) = self.mind.plan.nodes[node].skill {
            self.totals[skill] += probability;
            return;
        }
        let choices = self.mind.plan.choices(node, self.now.state_type).to_vec();
        let shares = self.shares(node, &choices);
        for (child, share) in choices.into_iter().zip(shares) {
            self.descend(child, probability * share);
        }
    }

    fn shares(&mut self, node: usize, choices: &[usize]) -> Vec<f64> {
        let alike = choices.len() == 1 || self.random || self.leads_to_one_skill(choices);
        if alike {
            return vec![1.0 / choices.len() as f64; choices.len()];
        }
        let mut values = Vec::with_capacity(choices.len());
        for &child in choices {
            let projected = self.mind.projected_value(&mut self.now, child);
            let inside = self
                .mind
                .completion(&mut self.now, node, child, Completion::Inside);
            values.push(projected + inside);
        }
        let mut out = vec![0.0; values.len()];
        self.softmax
            .probabilities(&values, self.mind.temperature(node), &mut out);
        out.into_iter().map(f64::from).collect()
    }

    /// Whether all choices are the same primitive subtask: then no share matters.
    fn leads_to_one_skill(&self, choices: &[usize]) -> bool {
        let skill = |child: &usize| self.mind.plan.nodes[*child].skill;
        let first = choices.first().and_then(skill);
        first.is_some() && choices.iter().all(|child| skill(child) == first)
    }
}

/// The average of several hierarchies' probabilities.
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
                let skills = 0..rows[0].len();
                let mean = |skill: usize| {
                    rows.iter().map(|row| row[skill]).sum::<f64>() / rows.len() as f64
                };
                skills.map(mean).collect()
            })
        })
        .collect()
}
