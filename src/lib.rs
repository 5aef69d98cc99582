//! maxq-lab: a terminal lab bench for evolving the task hierarchies of hierarchical
//! reinforcement learning.
//!
//! A population of MAXQ hierarchies competes inside one agent: each learns by MAXQ-Q with RBF
//! function approximation while it acts, and typed crossover recombines the best. The method is
//! that of S. Elfwing, *An Evolutionary Approach to Automatic Construction of the Structure in
//! Hierarchical Reinforcement Learning* (KTH 2003), called "Thesis" throughout. "Dietterich
//! 2000" is T. G. Dietterich, *Hierarchical Reinforcement Learning with the MAXQ Value Function
//! Decomposition*, JAIR 13.
//!
//! ```
//! use maxq_lab::hierarchy::{Glyphs, draw};
//! use maxq_lab::lab::experiment;
//! use maxq_lab::scenario::Scenario;
//!
//! let experiment = experiment(Scenario::load("smoke")?, 1)?;
//! let tree = experiment.read_tree("(Root Avoid (Capture ApproachBattery) ApproachNest)")?;
//! let drawing = draw(&tree, experiment.catalogue(), Glyphs::Ascii);
//! assert_eq!(drawing[0], "Root");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The folder `examples/` has longer programs: one runs an evolution, one evaluates a
//! hierarchy, one reads a finished run.
//!
//! # Rooms
//!
//! Each room imports only from rooms below it in this table; [`random`], [`files`], [`rules`] and
//! [`words`] serve all.
//!
//! | room | contents |
//! | --- | --- |
//! | [`cli`] | the commands, one file each |
//! | [`dashboard`] | the terminal: views of a run, and the keys that control it |
//! | [`report`] | plans, studies, statistics, figures, exports |
//! | [`lab`] | one run: evolution thread, events, controls, run folder, checkpoint |
//! | [`evolution`] | population, selection, crossover, the generation loop (Thesis Algorithm 3.1) |
//! | [`learning`] | RBF features, action selection, primitive subtasks, MAXQ-Q |
//! | [`hierarchy`] | trees of subtasks, typing rules, text form, structural difference |
//! | [`scenario`] | one experiment as JSON: settings, defaults, rules |
//! | [`worlds`] | where agents act and which subtasks they have; one folder for each world |
//!
//! # From a sensor to a choice
//!
//! A battery comes into view. Each line names the file and the function that act next.
//!
//! 1. `worlds/foraging/mod.rs`, `step`: the robot moves and looks for its target.
//! 2. `worlds/foraging/sensors.rs`, `see`: the battery is in range, in front, and not hidden.
//! 3. `worlds/foraging/sensors.rs`, `read`: noise turns its place into a reading.
//! 4. `worlds/foraging/mod.rs`, `inputs`: readings are scaled to [0, 1].
//! 5. `learning/agent.rs`, `perceive`: the agent takes the inputs and the state type.
//! 6. `learning/features.rs`, `compute`: Gaussian features of the inputs, when first needed.
//! 7. `learning/maxq_q.rs`, `descend`: from Root down, each composite subtask chooses a child.
//! 8. `learning/state_values.rs`, `projected_value`, `completion`: V and C~ of each child.
//! 9. `learning/linear.rs`, `dot`: each is a product of parameters and features.
//! 10. `learning/selection.rs`, `choose`: softmax picks a child, and in the end an action.
//!
//! # From the evolution thread to a frame
//!
//! A generation ends.
//!
//! 1. `evolution/evolve.rs`, `step`: ranks the individuals and returns a `GenerationRecord`.
//! 2. `lab/work.rs`, `advance`: sends the record to the recorder and to the reader.
//! 3. `lab/recorder.rs`, `run`: on its own thread, appends it to `events.jsonl`. It may wait for
//!    the disk, and loses nothing.
//! 4. `lab/feed.rs`, `send`: puts the event into the channel; a slow reader never delays
//!    evolution.
//! 5. `dashboard/session/source.rs`, `news`: takes events from the channel.
//! 6. `dashboard/session/mod.rs`, `read_news`: hands them to the app, five times a second.
//! 7. `dashboard/app/state.rs`, `update`: the only way to change what the screen shows.
//! 8. `dashboard/context/history.rs`, `apply`: adds the generation to the history.
//! 9. `dashboard/app/state.rs`, `draw_on`: the views draw into a buffer of cells.
//! 10. `dashboard/terminal/painter.rs`, `draw`: finds the bytes for the cells that changed.
//! 11. `dashboard/terminal/writer.rs`, `send`: another thread writes them to the terminal.

#![deny(missing_docs)]

#[cfg(not(unix))]
compile_error!(
    "maxq-lab runs on Unix systems only (Linux, macOS, BSD): it relies on their signals, \
     process groups and terminals"
);

pub mod cli;
pub mod dashboard;
pub mod evolution;
pub mod files;
pub mod hierarchy;
pub mod lab;
pub mod learning;
pub mod random;
pub mod report;
pub mod rules;
pub mod scenario;
pub mod words;
pub mod worlds;
