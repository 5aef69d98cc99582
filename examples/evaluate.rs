//! Evaluates one hierarchy: `cargo run --example evaluate`.

use std::error::Error;

use maxq_lab::evolution::Workers;
use maxq_lab::lab::{Protocol, experiment};
use maxq_lab::learning::Gate;
use maxq_lab::scenario::Scenario;

const TREE: &str = "(Root Avoid Wander ApproachBattery ApproachNest)";

/// Evaluates the hierarchy and prints its mean trial length.
pub fn main() -> Result<(), Box<dyn Error>> {
    let experiment = experiment(Scenario::load("smoke")?, 1)?;
    let tree = experiment.read_tree(TREE)?;

    // Eight fresh hierarchies learn for four trials and are scored in four more. They share
    // two sets of primitive subtasks, trained separately.
    let protocol = Protocol {
        warmup: 4,
        trials: 4,
        repeats: 8,
        primitive_sets: 2,
    };
    let workers = Workers::new(0)?;
    let scored = experiment.evaluate(&tree, &protocol, &workers, &Gate::default(), &|_| {})?;

    let evaluation = scored.evaluation;
    let error = evaluation.standard_error.unwrap_or(f64::NAN);
    println!("{TREE}");
    println!("{:.1} +- {error:.1} time steps per trial", evaluation.mean);
    Ok(())
}
