//! The settings of learning and of evolution, which are the same in every world.

use schemars::JsonSchema;
use serde::de::{Deserializer, Error};
use serde::{Deserialize, Serialize};

use super::defaults as d;

/// Settings of MAXQ-Q and of action selection (Thesis 2.2.2, 3.1, Table 4.5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[expect(
    clippy::manual_non_exhaustive,
    reason = "the private field is there for old files, not to hide the constructor"
)]
pub struct LearningSettings {
    /// Learning rate alpha.
    pub learning_rate: f64,
    /// Discount factor gamma per time step.
    pub discount: f64,
    /// Initial temperature of softmax action selection.
    pub initial_temperature: f64,
    /// Lower limit of the temperature.
    pub temperature_limit: f64,
    /// Initial temperature of composite subtasks, where it is another one; `null` for
    /// `initial_temperature`.
    pub composite_temperature: Option<f64>,
    /// Factor by which a composite subtask's temperature is multiplied when it falls
    /// (`cool_on`).
    pub temperature_decrease: f64,
    /// Largest softmax probability (rho limit) up to which selection is softmax; above it,
    /// selection is epsilon-greedy.
    pub probability_limit: f64,
    /// Probability of a uniformly random choice in epsilon-greedy selection.
    pub epsilon: f64,
    /// Initial value of every learned parameter (theta).
    pub initial_parameter: f64,
    /// A setting of earlier versions: files may still state the value that is left.
    #[serde(skip_serializing, deserialize_with = "only_next_state")]
    #[schemars(skip)]
    completion_bootstrap: (),
    /// When a composite subtask's temperature falls.
    pub cool_on: CoolOn,
    /// Transitions that carry a negative pseudo-reward.
    pub pseudo_reward: PseudoReward,
    /// Size of the negative pseudo-reward. A subtask learns to fail rather than to reach its
    /// goal at a higher cost than this.
    pub pseudo_penalty: f64,
    /// What composite subtasks are rewarded for.
    pub composite_reward: CompositeReward,
    /// What the state in which a composite subtask terminates is worth to it.
    pub exit_value: ExitValue,
    /// The value of the next state from which composite subtasks learn.
    pub bootstrap: Bootstrap,
    /// Time steps for which a primitive subtask acts once it was chosen, while the state type
    /// stays the same. With more than 1 the difference between two children becomes larger than
    /// its noise (Baird 1993; Tallec et al. 2019).
    pub persistence: u32,
    /// Times that all updates of a finished trial are repeated, the last decision first
    /// (Lin 1992).
    pub replay: u32,
    /// How a composite subtask chooses among its children.
    pub composite_choice: CompositeChoice,
    /// Whether and how primitive subtasks learn during evolution.
    pub primitive_learning: PrimitiveLearning,
}

impl Default for LearningSettings {
    fn default() -> Self {
        Self {
            learning_rate: d::LEARNING_RATE,
            discount: d::DISCOUNT,
            initial_temperature: d::INITIAL_TEMPERATURE,
            temperature_limit: d::TEMPERATURE_LIMIT,
            composite_temperature: None,
            temperature_decrease: d::TEMPERATURE_DECREASE,
            probability_limit: d::PROBABILITY_LIMIT,
            epsilon: d::EPSILON,
            initial_parameter: d::INITIAL_PARAMETER,
            completion_bootstrap: (),
            cool_on: CoolOn::default(),
            pseudo_reward: PseudoReward::default(),
            pseudo_penalty: d::PSEUDO_PENALTY,
            composite_reward: CompositeReward::default(),
            exit_value: ExitValue::default(),
            bootstrap: Bootstrap::default(),
            persistence: d::PERSISTENCE,
            replay: d::REPLAY,
            composite_choice: CompositeChoice::default(),
            primitive_learning: PrimitiveLearning::default(),
        }
    }
}

/// Reads `completion_bootstrap` and refuses its removed value `as_printed`.
fn only_next_state<'de, D: Deserializer<'de>>(json: D) -> Result<(), D::Error> {
    let value = String::deserialize(json)?;
    if value == "next_state" {
        return Ok(());
    }
    Err(D::Error::custom(format!(
        "found {value:?}; allowed: \"next_state\" (learning by the misprint of Equation 3.4 is no \
         longer part of the program)"
    )))
}

impl LearningSettings {
    /// Returns the initial temperature of composite subtasks.
    #[must_use]
    pub fn initial_composite_temperature(&self) -> f64 {
        self.composite_temperature
            .unwrap_or(self.initial_temperature)
    }
}

/// When the temperature of a composite subtask falls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CoolOn {
    /// Every termination (Thesis 3.1).
    #[default]
    Termination,
    /// Only terminations in a goal state (Dietterich 2000).
    Goal,
    /// The end of each trial, once for every composite subtask. A subtask that terminates often
    /// would otherwise be cold before it has seen much.
    Trial,
}

/// What composite subtasks are rewarded for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompositeReward {
    /// What their primitive subtasks are rewarded for (Thesis Eq. 3.2).
    #[default]
    Subtask,
    /// Time: this reward, below 0, for every time step, whatever primitive subtask acts. The
    /// primitive subtasks keep their own rewards.
    PerStep(f64),
}

/// What the state in which a composite subtask terminates is worth to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ExitValue {
    /// Its pseudo-reward (Thesis Definition 2.1).
    #[default]
    PseudoReward,
    /// What follows: the value of the state to the subtask that goes on, the first on the way up
    /// the call stack. Subtasks then learn policies that are optimal in their hierarchy
    /// (Parr and Russell 1998; Andre and Russell 2002).
    Continuation,
}

/// The value of the next state from which composite subtasks learn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Bootstrap {
    /// That of the child with the largest C~ + V (Thesis Algorithm 2.4).
    #[default]
    Greedy,
    /// The mean over the children that can act, weighted with the probabilities of choosing them
    /// (expected Sarsa: van Seijen et al. 2009). The largest of noisy values is too large (van
    /// Hasselt 2010).
    Expected,
}

/// The transitions that carry a negative pseudo-reward. Transitions into a goal state carry
/// none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PseudoReward {
    /// Transitions into a terminal state that is not a goal (Thesis Definition 2.1).
    #[default]
    Terminal,
    /// Transitions into any state that is not a goal (Thesis 4.2, taken literally).
    All,
}

/// How a composite subtask chooses among the children that are not terminated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompositeChoice {
    /// Softmax over C~ + V (Thesis 3.1).
    #[default]
    Softmax,
    /// Uniformly at random: the control that shows what learning to choose adds.
    Random,
}

/// Whether and how the primitive subtasks learn during evolution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PrimitiveLearning {
    /// They keep the parameters they were trained to before evolution.
    #[default]
    Frozen,
    /// All individuals update one common copy, in turn. Such a run uses one thread.
    Shared,
    /// Each individual updates a copy of its own, which starts from initial values if the
    /// world does not train primitive subtasks. Offspring inherit the copy of the parent whose
    /// root they have.
    Individual,
}

/// Settings of the genetic programming of hierarchies (Thesis 3.2, Algorithm 3.1, Table 4.7).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EvolutionSettings {
    /// Individuals in a generation.
    #[serde(default = "constant::<usize, { d::POPULATION_SIZE }>")]
    pub population_size: usize,
    /// Trials of each individual in a generation. The second half of them is scored.
    #[serde(default = "constant::<usize, { d::TRIALS_PER_GENERATION }>")]
    pub trials_per_generation: usize,
    /// Tournament size: individuals drawn for each tournament.
    #[serde(default = "constant::<usize, { d::TOURNAMENT_SIZE }>")]
    pub tournament_size: usize,
    /// Number of best individuals that are reproduced, and of worst individuals that are
    /// removed, in each generation.
    #[serde(default = "constant::<usize, { d::REPRODUCED }>")]
    pub reproduced: usize,
    /// Maximum depth of a hierarchy. The root has depth 1.
    #[serde(default = "constant::<usize, { d::MAXIMUM_DEPTH }>")]
    pub maximum_depth: usize,
    /// Generations after which evolution ends even if it has not converged.
    #[serde(default = "constant::<u64, { d::GENERATION_LIMIT }>")]
    pub generation_limit: u64,
    /// Control steps, with those of the training of primitive subtasks, after which evolution
    /// ends with the generation that reaches them; `null` for no limit.
    #[serde(default)]
    pub control_step_limit: Option<u64>,
    /// Whether evolution ends when the better half of the population has one structure.
    #[serde(default = "yes")]
    pub stop_on_convergence: bool,
    /// What happens when evolution is over; `null` for nothing.
    #[serde(default)]
    pub then: Option<Then>,
    /// Time steps after which a trial is truncated.
    #[serde(default = "constant::<u32, { d::TRIAL_STEP_LIMIT }>")]
    pub trial_step_limit: u32,
    /// States sampled for each state type to estimate the selection probabilities.
    #[serde(default = "constant::<usize, { d::POLICY_SAMPLES }>")]
    pub policy_samples: usize,
    /// How individuals are ranked.
    #[serde(default)]
    pub selection: Selection,
    /// What offspring inherit.
    #[serde(default)]
    pub inheritance: Inheritance,
    /// Which inherited values crossover and growth reset.
    #[serde(default)]
    pub reset: Reset,
    /// How new hierarchies are made.
    #[serde(default)]
    pub variation: Variation,
    /// Probability that an offspring loses a random child of one of its composite subtasks,
    /// with everything below it, after crossover. The thesis has no mutation (0) but suggests
    /// it as future work (chapter 5).
    #[serde(default)]
    pub prune_probability: f64,
    /// Probability that one of an offspring's composite subtasks gains a random child after
    /// crossover. The thesis has no mutation (0) but suggests it as future work (chapter 5).
    #[serde(default)]
    pub grow_probability: f64,
    /// The first generation: one hierarchy for each individual, such as
    /// `(Root Wander ApproachBattery ApproachNest)`.
    pub initial_population: Vec<String>,
}

/// Returns `VALUE`, as the default of a field of any number type.
fn constant<T: From<u16>, const VALUE: u16>() -> T {
    T::from(VALUE)
}

fn yes() -> bool {
    true
}

/// What happens when evolution is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Then {
    /// The best hierarchy lives this many more trials and goes on learning. Its trials are kept in
    /// `learning.json`.
    Learn(u32),
}

/// How the individuals of a generation are ranked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Selection {
    /// By the time steps of their scored trials, fewest first.
    #[default]
    Fitness,
    /// At random: the control that tells selection from drift.
    Random,
}

/// What offspring inherit besides their structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Inheritance {
    /// Learned parameters and temperatures, except those of the subtasks on the path from the
    /// crossover site to the root (Thesis 3.2).
    #[default]
    Lamarckian,
    /// Nothing: all parameters and temperatures start from their initial values.
    Darwinian,
}

/// Which inherited values start from their initial values where a composite subtask gets a new
/// child.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reset {
    /// All of the composite subtasks from the new child's parent to the root (Thesis 3.2).
    #[default]
    Path,
    /// The parent's completion functions for the new child only.
    Child,
}

/// How the hierarchies of the next generation are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Variation {
    /// By crossover of the survivors; the best are reproduced (Thesis 3.2).
    #[default]
    Crossover,
    /// At random: random search with as many trials in a generation as evolution. The best
    /// are reproduced and every other hierarchy is drawn again. The first generation is drawn
    /// too, and `initial_population` is not used. Only the generation limit ends the run.
    RandomTrees,
    /// Not at all: every individual keeps its hierarchy and goes on learning until the
    /// generation limit.
    None,
}

#[cfg(test)]
mod tests {
    use super::LearningSettings;

    #[test]
    fn files_of_earlier_versions_are_read_unless_they_follow_the_misprint() {
        let read = |value: &str| {
            let json = format!("{{\"completion_bootstrap\": {value}}}");
            serde_json::from_str::<LearningSettings>(&json)
        };
        assert_eq!(read("\"next_state\"").unwrap(), LearningSettings::default());
        let refused = read("\"as_printed\"").unwrap_err().to_string();
        assert!(
            refused.starts_with("found \"as_printed\"; allowed: \"next_state\""),
            "{refused}"
        );
        let written = serde_json::to_string(&LearningSettings::default()).unwrap();
        assert!(!written.contains("completion_bootstrap"));
    }
}
