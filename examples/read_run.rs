//! Reads a finished run: `cargo run --example read_run -- runs/smoke-seed1`.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use maxq_lab::evolution::GenerationRecord;
use maxq_lab::lab::{Event, read_events};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("which run folder?")?;
    print_run(Path::new(&folder))
}

/// Prints how many different structures each generation has, and how good its best is.
pub fn print_run(folder: &Path) -> Result<(), Box<dyn Error>> {
    for event in read_events(&folder.join("events.jsonl"))? {
        match event {
            Event::Started { scenario, seed, .. } => println!("{scenario}, seed {seed}"),
            Event::Generation(record) => print_generation(&record),
            Event::Ended { ending, .. } => println!("ended: {ending:?}"),
            _ => {}
        }
    }
    Ok(())
}

fn print_generation(record: &GenerationRecord) {
    let mut structures = BTreeMap::<&str, usize>::new();
    for individual in &record.individuals {
        *structures.entry(&individual.tree).or_default() += 1;
    }
    println!(
        "generation {:2}: {} structures, best {:.1} time steps per trial",
        record.generation,
        structures.len(),
        record.mean_trial_steps(1).unwrap_or(f64::NAN)
    );
}
