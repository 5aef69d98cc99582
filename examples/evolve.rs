//! Runs an evolution and prints its best hierarchy: `cargo run --example evolve`.

use std::error::Error;

use maxq_lab::hierarchy::{Glyphs, draw};
use maxq_lab::lab::{Event, RunOptions, experiment, start};
use maxq_lab::scenario::Scenario;

/// Evolves, and prints each generation and the best hierarchy.
pub fn main() -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::load("smoke")?;
    let parent = tempfile::tempdir()?;
    let folder = parent.path().join("run");

    // Evolution runs on a thread of its own; its events end when it does.
    let run = start(scenario.clone(), 1, &folder, &RunOptions::default())?;
    for event in &run.events {
        if let Event::Generation(record) = event {
            let steps = record.mean_trial_steps(1).unwrap_or(f64::NAN);
            println!(
                "generation {:2}: {steps:.1} time steps per trial",
                record.generation
            );
        }
    }

    let best = run.join()?.best.ok_or("no generation was finished")?;
    let experiment = experiment(scenario, 1)?;
    let tree = experiment.read_tree(&best.tree)?;
    for line in draw(&tree, experiment.catalogue(), Glyphs::of_locale()) {
        println!("{line}");
    }
    Ok(())
}
