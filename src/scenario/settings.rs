//! Settings of learning and evolution that hold for every world.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::defaults as d;

/// MAXQ-Q and action selection (Thesis 2.2.2, 3.1, Table 4.5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LearningSettings {
    /// Learning rate alpha.
    pub learning_rate: f64,
    /// Discount factor gamma per time step.
    pub discount: f64,
    /// Temperature of softmax selection at the start.
    pub initial_temperature: f64,
    /// Temperature that is never fallen below.
    pub temperature_limit: f64,
    /// A composite subtask's temperature is multiplied by this when it terminates.
    pub temperature_decrease: f64,
    /// Where the largest softmax probability exceeds this (rho limit), selection is
    /// epsilon-greedy instead.
    pub probability_limit: f64,
    /// Probability of a random choice in epsilon-greedy selection.
    pub epsilon: f64,
    /// Initial value of every parameter.
    pub initial_parameter: f64,
    /// Which state the bootstrap value of C~ is taken from.
    pub completion_bootstrap: CompletionBootstrap,
    /// When a composite subtask's temperature falls.
    pub cool_on: CoolOn,
    /// Which transitions carry a negative pseudo-reward.
    pub pseudo_reward: PseudoReward,
    /// The pseudo-reward is minus this. A subtask prefers failing to a way to its goal that
    /// costs more.
    pub pseudo_penalty: f64,
    /// How a composite subtask chooses among its children.
    pub composite_choice: CompositeChoice,
    /// Whether primitive subtasks learn during evolution.
    pub primitive_learning: PrimitiveLearning,
}

impl Default for LearningSettings {
    fn default() -> Self {
        Self {
            learning_rate: d::LEARNING_RATE,
            discount: d::DISCOUNT,
            initial_temperature: d::INITIAL_TEMPERATURE,
            temperature_limit: d::TEMPERATURE_LIMIT,
            temperature_decrease: d::TEMPERATURE_DECREASE,
            probability_limit: d::PROBABILITY_LIMIT,
            epsilon: d::EPSILON,
            initial_parameter: d::INITIAL_PARAMETER,
            completion_bootstrap: CompletionBootstrap::default(),
            cool_on: CoolOn::default(),
            pseudo_reward: PseudoReward::default(),
            pseudo_penalty: d::PSEUDO_PENALTY,
            composite_choice: CompositeChoice::default(),
            primitive_learning: PrimitiveLearning::default(),
        }
    }
}

/// The state in which the bootstrap value V(a*, .) of C~ is taken (Thesis Eq. 3.4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompletionBootstrap {
    /// V(a*, s') in the next state, as the algorithm means it.
    #[default]
    NextState,
    /// V(a*, s) in the updated state, as Equation 3.4 and Algorithm 2.4 print it.
    AsPrinted,
}

/// When the temperature of a composite subtask falls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CoolOn {
    /// At every termination (Thesis 3.1).
    #[default]
    Termination,
    /// Only where the goal was reached (Dietterich 2000).
    Goal,
}

/// Which transitions carry a negative pseudo-reward; transitions into a goal state carry 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PseudoReward {
    /// Those into a terminal state that is no goal (Thesis Definition 2.1).
    #[default]
    Terminal,
    /// Those into any state that is no goal (Thesis 4.2, taken literally).
    All,
}

/// How a composite subtask chooses among the children that can act.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompositeChoice {
    /// Softmax over C~ + V (Thesis 3.1).
    #[default]
    Softmax,
    /// All alike: the control that tells what learning between children adds.
    Random,
}

/// Whether the primitive subtasks learn during evolution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PrimitiveLearning {
    /// They stay as they were trained.
    #[default]
    Frozen,
    /// All individuals teach the one copy, in turn; such a run uses one thread.
    Shared,
    /// Each individual has its own and teaches them itself, from nothing where they are
    /// not trained. Offspring inherit those of the parent whose root they have.
    Individual,
}

/// Genetic programming of hierarchies (Thesis 3.2, Algorithm 3.1, Table 4.7).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EvolutionSettings {
    /// Individuals in a generation.
    #[serde(default = "population_size")]
    pub population_size: usize,
    /// Trials of an individual in a generation; the last half is scored.
    #[serde(default = "trials_per_generation")]
    pub trials_per_generation: usize,
    /// Individuals drawn for a tournament.
    #[serde(default = "tournament_size")]
    pub tournament_size: usize,
    /// Best individuals that are reproduced; as many of the worst die.
    #[serde(default = "reproduced")]
    pub reproduced: usize,
    /// Maximum depth of a hierarchy, the root counted.
    #[serde(default = "maximum_depth")]
    pub maximum_depth: usize,
    /// Generations after which evolution ends although it has not converged.
    #[serde(default = "generation_limit")]
    pub generation_limit: u64,
    /// Time steps after which a trial ends although nothing was delivered.
    #[serde(default = "trial_step_limit")]
    pub trial_step_limit: u32,
    /// States sampled per state type for the selection probabilities.
    #[serde(default = "policy_samples")]
    pub policy_samples: usize,
    /// What ranks the individuals.
    #[serde(default)]
    pub selection: Selection,
    /// What offspring inherit.
    #[serde(default)]
    pub inheritance: Inheritance,
    /// Where new hierarchies come from.
    #[serde(default)]
    pub variation: Variation,
    /// Probability with which an offspring then loses a child of one of its composite
    /// subtasks, and all below it; 0 in the thesis, which wishes for it (chapter 5).
    #[serde(default)]
    pub prune_probability: f64,
    /// Probability with which an offspring then gets one more child in one of its composite
    /// subtasks; 0 in the thesis, which wishes for it (chapter 5).
    #[serde(default)]
    pub grow_probability: f64,
    /// The hand-coded first generation, one hierarchy an individual, as text:
    /// `(Root Wander ApproachBattery ApproachNest)`.
    pub initial_population: Vec<String>,
}

fn population_size() -> usize {
    d::POPULATION_SIZE
}
fn trials_per_generation() -> usize {
    d::TRIALS_PER_GENERATION
}
fn tournament_size() -> usize {
    d::TOURNAMENT_SIZE
}
fn reproduced() -> usize {
    d::REPRODUCED
}
fn maximum_depth() -> usize {
    d::MAXIMUM_DEPTH
}
fn generation_limit() -> u64 {
    d::GENERATION_LIMIT
}
fn trial_step_limit() -> u32 {
    d::TRIAL_STEP_LIMIT
}
fn policy_samples() -> usize {
    d::POLICY_SAMPLES
}

/// What ranks the individuals of a generation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Selection {
    /// Time steps over the scored trials, fewer first.
    #[default]
    Fitness,
    /// Chance: the control that tells selection from drift.
    Random,
}

/// What offspring inherit besides their structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Inheritance {
    /// Learned parameters and temperatures, except along the path from the
    /// crossover site to the root (Thesis 3.2).
    #[default]
    Lamarckian,
    /// Nothing: offspring start from initial values.
    Darwinian,
}

/// Where the hierarchies of the next generation come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Variation {
    /// Crossover of the survivors, besides the reproduced best (Thesis 3.2).
    #[default]
    Crossover,
    /// Chance, besides the reproduced best: fresh random hierarchies that obey the rules.
    /// The initial population is drawn like them and its hierarchies are not used. Only
    /// the generation limit ends such a run: random search, with as many trials in a
    /// generation as evolution.
    RandomTrees,
    /// Nowhere: all individuals live on and learn, generation after generation, until the
    /// generation limit.
    None,
}
