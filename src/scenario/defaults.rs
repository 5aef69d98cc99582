//! The default of every number in the settings of learning and evolution, with its source.
//!
//! Where the thesis gives no value or two values, the comment says which was chosen and why.

/// Learning rate alpha, Thesis Table 4.5.
pub const LEARNING_RATE: f64 = 0.2;
/// Discount factor gamma per time step, Thesis Table 4.5.
pub const DISCOUNT: f64 = 0.9;
/// Initial temperature of softmax action selection, Thesis Table 4.5.
pub const INITIAL_TEMPERATURE: f64 = 2.0;
/// Lower limit of the temperature, Thesis Table 4.5.
pub const TEMPERATURE_LIMIT: f64 = 0.05;
/// Temperature decrease factor of every subtask except Avoid and Wander, Thesis 4.4.
pub const TEMPERATURE_DECREASE: f64 = 0.995;
/// Softmax probability (rho limit) above which selection becomes epsilon-greedy,
/// Thesis Table 4.5.
pub const PROBABILITY_LIMIT: f64 = 0.98;
/// Probability of a random choice in epsilon-greedy selection, Thesis Table 4.5:
/// one minus the probability limit.
pub const EPSILON: f64 = 0.02;
/// Initial value of every parameter (theta init), Thesis Table 4.5.
pub const INITIAL_PARAMETER: f64 = 0.123;
/// Size of the negative pseudo-reward, Thesis 4.2.
pub const PSEUDO_PENALTY: f64 = 1.0;

/// Time steps for which a chosen primitive subtask acts: one (Thesis Algorithm 2.4).
pub const PERSISTENCE: u32 = 1;
/// Passes over a finished trial: none (Thesis Algorithm 2.4).
pub const REPLAY: u32 = 0;

/// Population size, Thesis Table 4.7.
pub const POPULATION_SIZE: u16 = 16;
/// Trials of each individual in a generation, Thesis Table 4.7. The second half is scored.
pub const TRIALS_PER_GENERATION: u16 = 16;
/// Tournament size, Thesis Table 4.7.
pub const TOURNAMENT_SIZE: u16 = 2;
/// Best individuals reproduced, and worst removed, in each generation, Thesis Table 4.7.
pub const REPRODUCED: u16 = 2;
/// Maximum depth of a hierarchy, with the root at depth 1, Thesis Table 4.7.
pub const MAXIMUM_DEPTH: u16 = 4;
/// Generations after which evolution ends even if it has not converged. The thesis gives no
/// limit; runs that converge do so well before this one.
pub const GENERATION_LIMIT: u16 = 200;
/// Time steps after which a trial is truncated and scored with this length. The thesis gives
/// no limit; this one is about ten times the length of a good trial.
pub const TRIAL_STEP_LIMIT: u16 = 2000;
/// States sampled for each state type to estimate the selection probabilities, Thesis 4.5.4.
pub const POLICY_SAMPLES: u16 = 1000;
