//! The command line, one file a command.
//!
//! Results go to standard output and stay pipeable; messages and progress go to
//! standard error, progress only where that is a terminal.

mod answer;
mod args;
mod check;
mod dashboard;
mod evaluate;
mod export;
mod frame;
mod learn;
mod live;
mod manual;
mod output;
mod primitives;
mod progress;
mod run;
mod scenarios;
mod signals;
mod study;
mod tree;
mod watch;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use output::Failure;

/// Evolve the task hierarchies of hierarchical reinforcement learning.
///
/// A population of MAXQ hierarchies competes inside one simulated robot. Each learns by
/// MAXQ-Q while it forages - find a battery, capture it, bring it to the nest -, and
/// typed crossover mixes the best (S. Elfwing, KTH 2003). The same scenario and seed give
/// the same bits, whatever the machine, the number of threads, or how often the run was
/// interrupted. On a terminal a dashboard shows it all: watch, pause, take apart, step, replay.
#[derive(Debug, Parser)]
#[command(name = "maxq-lab", version, max_term_width = 100, after_help = AFTER_HELP)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const AFTER_HELP: &str = "\
Begin with:
  maxq-lab scenarios                        what there is to run
  maxq-lab run smoke                        the whole method, in less than a second
  maxq-lab run environment-1                an experiment of the thesis
  maxq-lab evaluate environment-1 --tree '(Root Wander ApproachBattery ApproachNest)'

Exit status:
  0      done, or handed over to another process
  1      an error, told on standard error
  2      wrong arguments
  128+N  ended by signal N, 130 by hand too: what was begun is saved, and can be gone on with";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Args),
    Resume(run::ResumeArgs),
    Watch(watch::Args),
    Replay(watch::ReplayArgs),
    Frame(frame::Args),
    Evaluate(evaluate::Args),
    Learn(learn::Args),
    Study(Box<study::Args>),
    Export(export::Args),
    #[command(subcommand, after_help = tree::EXAMPLES)]
    Tree(tree::Command),
    Primitives(primitives::Args),
    Check(check::Args),
    Schema(scenarios::SchemaArgs),
    Scenarios(scenarios::Args),
    Completions(manual::CompletionArgs),
    Manual(manual::ManualArgs),
}

/// Runs the program with the process's arguments.
#[must_use]
pub fn main() -> ExitCode {
    let command = match Cli::try_parse() {
        Ok(cli) => cli.command,
        Err(error) => return no_command(&error),
    };
    let done = match command {
        Command::Run(args) => run::main(args),
        Command::Resume(args) => run::resume_main(&args),
        Command::Watch(args) => watch::main(&args),
        Command::Replay(args) => watch::replay(&args),
        Command::Frame(args) => frame::main(&args),
        Command::Evaluate(args) => evaluate::main(args),
        Command::Learn(args) => learn::main(args),
        Command::Study(args) => study::main(&args),
        Command::Export(args) => export::main(&args),
        Command::Tree(command) => tree::main(command),
        Command::Primitives(args) => primitives::main(args),
        Command::Check(args) => check::main(&args),
        Command::Schema(args) => scenarios::schema(&args),
        Command::Scenarios(args) => scenarios::main(&args),
        Command::Completions(args) => manual::completions(&args),
        Command::Manual(args) => manual::manual(&args),
    };
    match done {
        Ok(code) => code,
        Err(Failure::BrokenPipe) => ExitCode::SUCCESS,
        Err(Failure::Message(message)) => {
            output::message(&format!("error: {message}"));
            ExitCode::FAILURE
        }
    }
}

/// Prints what clap has to say instead of a command: help and version as they are, an
/// error with the control characters of the arguments that it quotes made visible.
fn no_command(error: &clap::Error) -> ExitCode {
    if error.use_stderr() {
        output::message(error.render().to_string().trim_end());
    } else {
        // Nothing can be done about a standard output that cannot be written.
        let _ = error.print();
    }
    u8::try_from(error.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}
