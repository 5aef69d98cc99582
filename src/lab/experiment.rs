//! An experiment in whichever world: the trait that hides the world's type.

use crate::evolution::{EvolutionState, TreeError, Workers, read_tree};
use crate::hierarchy::Tree;
use crate::learning::{Encoder, Gate, PrimitiveSet, SelectionProbabilities, Stopped};
use crate::rules::Problem;
use crate::scenario::Scenario;
use crate::worlds::scene::Scenery;
use crate::worlds::{Catalogue, Probe, SubtaskId};

use super::checkpoint::Checkpoint;
use super::checkpoint_error::CheckpointError;
use super::evaluate::{Protocol, Scored};
use super::inspection::{
    InspectedIndividual, MapView, PolicyMap, Profile, Rollout, Start, StartError,
};
use super::learn::{LearnError, LearnProtocol, Learned};
use super::learner::Algorithm;
use super::outcome::Outcome;
use super::run_error::RunError;
use super::value_grid::ValueGrid;
use super::work::Work;

/// A scenario and a seed, ready for everything that the program does with them.
///
/// The world's type is hidden: learning and evolution are compiled once for each world, and
/// a call of this trait leads to the code of the right one. Calls are rare, once a trial at
/// most, so they cost nothing.
///
/// [`experiment`](super::experiment) makes one of a scenario;
/// [`any_experiment`](super::any_experiment) makes one of an
/// [`Experiment`](crate::evolution::Experiment) in a world of your own.
pub trait AnyExperiment: Send + Sync {
    /// Returns the scenario.
    fn scenario(&self) -> &Scenario;

    /// Returns what is odd about the scenario, though it can be carried out.
    fn warnings(&self) -> Vec<Problem>;

    /// Returns the seed of all random streams.
    fn seed(&self) -> u64;

    /// Returns the subtasks of the world.
    fn catalogue(&self) -> &Catalogue;

    /// Returns the feature maps of the subtasks.
    fn encoder(&self) -> &Encoder;

    /// Returns a hierarchy that a person would make in this world, as text.
    fn hand_made(&self) -> Option<&str>;

    /// Returns whether all states of the world can be listed, so that exact values exist.
    fn is_finite(&self) -> bool;

    /// Returns typical inputs of a primitive subtask.
    fn probes(&self, primitive: SubtaskId) -> Vec<Probe<Vec<f32>>>;

    /// Reads a hierarchy and checks the typing rules and the scenario's maximum depth.
    ///
    /// # Errors
    /// When the text is malformed or breaks a rule.
    fn read_tree(&self, text: &str) -> Result<Tree, TreeError> {
        let depth = self.scenario().evolution.maximum_depth;
        read_tree(text, self.catalogue(), depth)
    }

    /// Returns about how many bytes a saved state takes.
    fn state_bytes(&self) -> u64;

    /// Reads the population in a checkpoint.
    ///
    /// # Errors
    /// When it does not fit the scenario.
    fn population(&self, checkpoint: &Checkpoint) -> Result<EvolutionState, CheckpointError> {
        checkpoint.state(self.scenario(), self.catalogue())
    }

    /// Tells why a primitive subtask has no learned values of its own; `None` if it has some, and
    /// for a composite subtask.
    fn nothing_learned(&self, subtask: SubtaskId) -> Option<String>;

    /// Trains one set of primitive subtasks; `set` numbers independently trained sets.
    ///
    /// # Errors
    /// When the gate is stopped.
    fn train(&self, set: u64, workers: &Workers, gate: &Gate) -> Result<PrimitiveSet, Stopped>;

    /// Evolves to the end without recording anything, and returns the last state.
    ///
    /// # Errors
    /// When the gate is stopped.
    fn evolve(&self, workers: &Workers, gate: &Gate) -> Result<EvolutionState, Stopped>;

    /// Measures how good the structure `tree` is; calls `progress` with the number of
    /// repeats done so far.
    ///
    /// # Examples
    /// ```
    /// use maxq_lab::evolution::Workers;
    /// use maxq_lab::lab::{Protocol, experiment};
    /// use maxq_lab::learning::Gate;
    /// use maxq_lab::scenario::Scenario;
    ///
    /// let experiment = experiment(Scenario::load("cliff")?, 1)?;
    /// let tree = experiment.read_tree("(Root Up Down Right Left)")?;
    /// let protocol = Protocol { warmup: 20, trials: 5, repeats: 2, primitive_sets: 1 };
    /// let workers = Workers::new(1)?;
    /// let scored = experiment.evaluate(&tree, &protocol, &workers, &Gate::default(), &|_| {})?;
    /// assert!(scored.evaluation.mean >= 1.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the gate is stopped.
    fn evaluate(
        &self,
        tree: &Tree,
        protocol: &Protocol,
        workers: &Workers,
        gate: &Gate,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Scored, Stopped>;

    /// Lets learners of one kind learn the world from nothing, and compares them with the
    /// exact values; calls `progress` with the number of repeats done so far.
    ///
    /// # Errors
    /// When the world is not finite or lacks features for the algorithm, or the gate is
    /// stopped.
    fn learn(
        &self,
        algorithm: &Algorithm,
        protocol: &LearnProtocol,
        workers: &Workers,
        gate: &Gate,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Learned, LearnError>;

    /// Lays learned and exact values out as the cells of the world, one grid for each of its
    /// variants; returns none where the world has no cells.
    fn value_grids(&self, learned: &Learned) -> Vec<ValueGrid>;

    /// Returns what never changes in the world, for drawing it.
    fn scenery(&self) -> &Scenery;

    /// Returns what can differ between states besides place and heading, such as
    /// `empty-handed` and `carrying`; at least one entry.
    fn variants(&self) -> &[String];

    /// Reads `from R to B at 0,3` or `carrying at 500,1200 heading 90`: a variant, the
    /// agent's place, and its heading in degrees.
    ///
    /// # Errors
    /// When the text is malformed, or the agent cannot be there.
    fn read_start(&self, text: &str) -> Result<Start, StartError> {
        let start = Start::parse(text, self.variants());
        let scenery = self.scenery();
        let [width, height] = scenery.extent;
        start
            .filter(|start| self.can_begin(*start))
            .ok_or_else(|| StartError {
                found: text.to_owned(),
                unit: scenery.unit.clone(),
                extent: format!("{width},{height}"),
                cases: self.variants().join(", "),
            })
    }

    /// Returns whether the agent can be in that state and its task is not done there.
    fn can_begin(&self, start: Start) -> bool;

    /// Starts a rollout: a copy of an individual acts and learns while somebody watches.
    ///
    /// `number` gives each rollout of an individual its own random stream. All trials begin
    /// in `start`; without one, or where the agent cannot be there, they begin at random.
    fn rollout(
        &'static self,
        individual: InspectedIndividual<'_>,
        number: u64,
        start: Option<Start>,
    ) -> Box<dyn Rollout>;

    /// Returns the learned values of a node over the inputs that it depends on.
    fn profiles(&self, individual: InspectedIndividual<'_>, node: usize) -> Vec<Profile>;

    /// Returns what an individual would do all over the arena. The same individual and view
    /// always give the same map.
    fn policy_map(&self, individual: InspectedIndividual<'_>, view: MapView) -> PolicyMap;

    /// Returns for each state type the probability of selecting each primitive subtask, in
    /// the catalogue's order (Thesis 4.5.4), over the same states that a run samples.
    fn selection(&self, individual: InspectedIndividual<'_>) -> SelectionProbabilities;

    /// Computes a run on the present thread.
    ///
    /// [`start`](super::start) and [`resume`](super::resume) prepare the work.
    ///
    /// # Errors
    /// When the run cannot be recorded.
    fn run(&self, work: Work) -> Result<Outcome, RunError>;
}
