//! Contract: the programs in `examples/` work.
//!
//! Why it matters: they are the first code that a user of the library copies.

#![allow(clippy::unwrap_used, dead_code)]

mod common;
#[path = "../examples/evaluate.rs"]
mod evaluate;
#[path = "../examples/evolve.rs"]
mod evolve;
#[path = "../examples/read_run.rs"]
mod read_run;

#[test]
fn a_run_evolves() {
    evolve::main().unwrap();
}

#[test]
fn a_hierarchy_is_evaluated() {
    evaluate::main().unwrap();
}

#[test]
fn a_finished_run_is_read() {
    let parent = tempfile::tempdir().unwrap();
    let folder = parent.path().join("run");
    common::run_in(&folder, &common::short(&[]), 1, &common::threads(2));
    read_run::print_run(&folder).unwrap();
}
