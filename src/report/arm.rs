//! The arms of a study: what is done with each scenario.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hierarchy::{Tree, complete, flat, to_text};
use crate::lab::{SetupError, experiment};
use crate::scenario::{
    CompositeChoice, Inheritance, Scenario, ScenarioError, Selection, Variation,
};
use crate::worlds::Catalogue;

/// One arm: a base and named settings.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Arm {
    /// Its name, used in folders; of the letters that scenario names are made of.
    #[schemars(regex(pattern = r"^[a-z0-9_][a-z0-9_.-]{0,63}$"))]
    pub name: String,
    /// What it does.
    #[serde(default)]
    pub base: Base,
    /// Changes to the scenario, `key=value` as for `run --set`.
    #[serde(default)]
    pub settings: Vec<String>,
}

/// What an arm does with a scenario.
///
/// The arms without crossover have no end of their own. They get as many generations as
/// the evolved run of the same scenario, settings and seed has, and with as many
/// individuals and trials in each: a *matched* budget.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Base {
    /// The method: evolution as the scenario says.
    #[default]
    Evolved,
    /// Chance in the place of fitness: the control that tells selection from drift.
    RandomSelection,
    /// Composite subtasks choose uniformly among the children that can act: the control
    /// that tells what learning between children adds.
    RandomChoice,
    /// The complete hierarchy (Thesis Figure 4.2) in every place of the population; all
    /// learn on, generation after generation. Matched budget.
    HandDesigned,
    /// The places that crossover would fill get fresh random hierarchies; the best are
    /// kept and scored again, as evolution does. Matched budget.
    RandomSearch,
    /// Offspring inherit structure only: Darwinian instead of Lamarckian.
    NoLearningInheritance,
    /// A root that chooses among all primitive subtasks, learning as under
    /// `hand_designed`. Matched budget.
    Flat,
}

impl Base {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Evolved,
        Self::RandomSelection,
        Self::RandomChoice,
        Self::HandDesigned,
        Self::RandomSearch,
        Self::NoLearningInheritance,
        Self::Flat,
    ];

    /// Its name in plans.
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

    /// The base with this name.
    #[must_use]
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|base| base.name() == name)
    }

    /// The names of all, for messages.
    #[must_use]
    pub fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }

    /// Whether its budget is that of the evolved run of the same seed.
    #[must_use]
    pub fn is_matched(self) -> bool {
        matches!(self, Self::HandDesigned | Self::RandomSearch | Self::Flat)
    }
}

/// Why an arm cannot be applied to a scenario.
#[derive(Debug, thiserror::Error)]
pub enum ArmError {
    /// A setting cannot be made.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The scenario cannot be made ready.
    #[error(transparent)]
    Setup(#[from] SetupError),
}

impl Arm {
    /// The arm that is nothing but its base.
    #[must_use]
    pub fn of(base: Base) -> Self {
        Self {
            name: base.name().to_owned(),
            base,
            settings: Vec::new(),
        }
    }

    /// The scenario under this arm; its generation limit is still the scenario's own.
    ///
    /// # Errors
    /// When a setting does not fit the scenario, or the result cannot be made ready.
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
