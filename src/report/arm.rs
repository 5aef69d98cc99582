//! The arms of a study: the variants of a scenario that are compared.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hierarchy::{Tree, complete, flat, to_text};
use crate::lab::{SetupError, experiment};
use crate::scenario::{
    CompositeChoice, Inheritance, Scenario, ScenarioError, Selection, Variation,
};
use crate::worlds::Catalogue;

/// One arm: a base, and settings on top of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Arm {
    /// Name, used in the names of folders. It follows the rules for names of scenarios.
    #[schemars(regex(pattern = r"^[a-z0-9_][a-z0-9_.-]{0,63}$"))]
    pub name: String,
    /// What is done with the scenario.
    #[serde(default)]
    pub base: Base,
    /// Changes of the scenario, `KEY=VALUE` as for `run --set`.
    #[serde(default)]
    pub settings: Vec<String>,
}

/// What an arm does with a scenario.
///
/// An arm without crossover never converges. It has a *matched budget*: as many generations,
/// individuals and trials as the evolved run of the same scenario, settings and seed, or as many
/// control steps where the scenario limits them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Base {
    /// Evolution as the scenario says.
    #[default]
    Evolved,
    /// Individuals are ranked at random instead of by fitness: the control that tells selection
    /// from drift.
    RandomSelection,
    /// Composite subtasks choose at random among the children that can act: the control that
    /// shows what learning to choose adds.
    RandomChoice,
    /// Every individual has the complete hierarchy (Thesis Figure 4.2) and only learns.
    /// Matched budget.
    HandDesigned,
    /// Random hierarchies are drawn where evolution would use crossover. The best are kept and
    /// scored again, as in evolution. Matched budget.
    RandomSearch,
    /// Offspring inherit structure only (Darwinian instead of Lamarckian inheritance).
    NoLearningInheritance,
    /// Every individual has a root that chooses among all primitive subtasks, and only learns.
    /// Matched budget.
    Flat,
}

impl Base {
    /// All bases.
    pub const ALL: [Self; 7] = [
        Self::Evolved,
        Self::RandomSelection,
        Self::RandomChoice,
        Self::HandDesigned,
        Self::RandomSearch,
        Self::NoLearningInheritance,
        Self::Flat,
    ];

    /// Returns its name in plans.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Evolved => "evolved",
            Self::RandomSelection => "random_selection",
            Self::RandomChoice => "random_choice",
            Self::HandDesigned => "hand_designed",
            Self::RandomSearch => "random_search",
            Self::NoLearningInheritance => "no_learning_inheritance",
            Self::Flat => "flat",
        }
    }

    /// Returns the base with a name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|base| base.name() == name)
    }

    /// Returns the names of all bases, for messages.
    #[must_use]
    pub fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }

    /// Returns whether it has a matched budget.
    #[must_use]
    pub fn is_matched(self) -> bool {
        matches!(self, Self::HandDesigned | Self::RandomSearch | Self::Flat)
    }
}

/// Why an arm cannot be applied to a scenario.
#[derive(Debug, thiserror::Error)]
pub enum ArmError {
    /// A setting does not fit the scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The experiment of the scenario cannot be built.
    #[error(transparent)]
    Setup(#[from] SetupError),
}

impl Arm {
    /// Creates the arm of a base without settings, named like the base.
    #[must_use]
    pub fn of(base: Base) -> Self {
        Self {
            name: base.name().to_owned(),
            base,
            settings: Vec::new(),
        }
    }

    /// Returns the scenario under this arm. Its generation limit does not change, even if the
    /// arm has a matched budget.
    ///
    /// # Errors
    /// When a setting does not fit the scenario, or the experiment of the result cannot be
    /// built.
    pub fn apply(&self, scenario: &Scenario) -> Result<Scenario, ArmError> {
        let mut scenario = scenario.clone().with_settings(&self.settings)?;
        let evolution = &mut scenario.evolution;
        match self.base {
            Base::Evolved => {}
            Base::RandomSelection => evolution.selection = Selection::Random,
            Base::RandomChoice => scenario.learning.composite_choice = CompositeChoice::Random,
            Base::NoLearningInheritance => evolution.inheritance = Inheritance::Darwinian,
            Base::RandomSearch => evolution.variation = Variation::RandomTrees,
            Base::HandDesigned => learning_only(&mut scenario, complete)?,
            Base::Flat => learning_only(&mut scenario, flat)?,
        }
        experiment(scenario.clone(), 0)?;
        Ok(scenario)
    }
}

/// Gives every individual the hierarchy `design`, which then only learns.
fn learning_only(
    scenario: &mut Scenario,
    design: fn(&Catalogue) -> Tree,
) -> Result<(), SetupError> {
    let experiment = experiment(scenario.clone(), 0)?;
    let catalogue = experiment.catalogue();
    let text = to_text(&design(catalogue), catalogue);
    let evolution = &mut scenario.evolution;
    evolution.variation = Variation::None;
    evolution.initial_population = vec![text; evolution.population_size];
    Ok(())
}
