//! Every default of learning and evolution as a named constant with its source.
//!
//! Where the thesis is silent or says a thing twice, the constant says who decided.

/// Learning rate alpha, Thesis Table 4.5.
pub const LEARNING_RATE: f64 = 0.2;
/// Discount factor gamma per time step, Thesis Table 4.5.
pub const DISCOUNT: f64 = 0.9;
/// Initial temperature of softmax action selection, Thesis Table 4.5.
pub const INITIAL_TEMPERATURE: f64 = 2.0;
/// The temperature never falls below this limit, Thesis Table 4.5.
pub const TEMPERATURE_LIMIT: f64 = 0.05;
/// Temperature decrease factor of every subtask but Avoid and Wander, Thesis 4.4.
pub const TEMPERATURE_DECREASE: f64 = 0.995;
/// Largest probability (rho limit) above which softmax gives way to
/// epsilon-greedy selection, Thesis Table 4.5.
pub const PROBABILITY_LIMIT: f64 = 0.98;
/// Probability of a random choice in epsilon-greedy selection, Thesis Table 4.5:
/// one minus the probability limit.
pub const EPSILON: f64 = 0.02;
/// Initial value of every parameter (theta init), Thesis Table 4.5.
pub const INITIAL_PARAMETER: f64 = 0.123;
/// Minus the pseudo-reward of a transition into a terminal state that is no goal, Thesis 4.2.
pub const PSEUDO_PENALTY: f64 = 1.0;

/// Population size, Thesis Table 4.7.
pub const POPULATION_SIZE: usize = 16;
/// Trials of an individual in a generation, Thesis Table 4.7; the last half is scored.
pub const TRIALS_PER_GENERATION: usize = 16;
/// Tournament size, Thesis Table 4.7.
pub const TOURNAMENT_SIZE: usize = 2;
/// Best individuals reproduced, and worst removed, per generation, Thesis Table 4.7.
pub const REPRODUCED: usize = 2;
/// Maximum depth of a hierarchy, the root counted, Thesis Table 4.7.
pub const MAXIMUM_DEPTH: usize = 4;
/// Evolution ends here when it has not converged; the thesis names no limit, and
/// converging runs end well before it.
pub const GENERATION_LIMIT: u64 = 200;
/// A trial that has not delivered by then ends and counts with this length. The
/// thesis names no limit; it is some ten times the length of a good trial.
pub const TRIAL_STEP_LIMIT: u32 = 2000;
/// States sampled per state type for the selection probabilities, Thesis 4.5.4.
pub const POLICY_SAMPLES: usize = 1000;
