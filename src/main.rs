//! The `maxq-lab` program: parse, dispatch, exit code.

#![deny(missing_docs)]

use std::process::ExitCode;

fn main() -> ExitCode {
    maxq_lab::cli::main()
}
