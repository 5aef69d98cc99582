//! The `maxq-lab` program.
fn main() {}
