#![doc = include_str!("README.md")]

mod answer;
mod args;
mod check;
mod curve;
mod dashboard;
mod evaluate;
mod evaluation;
mod export;
mod frame;
mod learn;
mod live;
mod manual;
mod names;
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

use clap::{CommandFactory, Parser, Subcommand};

use output::Failure;

/// Evolve task hierarchies for hierarchical reinforcement learning.
///
/// A population of MAXQ hierarchies shares one simulated agent. Each individual learns by MAXQ-Q
/// while it acts, and typed crossover recombines the fittest (S. Elfwing, KTH 2003). In the
/// thesis's task, foraging, a robot finds a battery, captures it and carries it to the nest.
///
/// The same scenario and seed give bit for bit the same result on every machine, with any
/// number of threads and however often the run is interrupted. On a terminal, a dashboard shows
/// everything live: pause, inspect, step and replay.
#[derive(Debug, Parser)]
#[command(name = "maxq-lab", version, max_term_width = 100, after_help = AFTER_HELP)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const AFTER_HELP: &str = "\
First steps:
  maxq-lab scenarios                        list what can be run
  maxq-lab run smoke                        the whole method in less than a second
  maxq-lab run environment-1                an experiment of the thesis
  maxq-lab evaluate environment-1 --tree '(Root Wander ApproachBattery ApproachNest)'

Exit status:
  0      success, or the run was handed over to a background process
  1      an error, reported on standard error
  2      invalid arguments
  128+N  ended by signal N (130 also when stopped from the dashboard); progress is saved and can
         be resumed";

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

/// Returns the command line as clap knows it.
#[must_use]
pub fn command() -> clap::Command {
    Cli::command()
}

/// Runs the program with the arguments of the process and returns its exit code.
#[must_use]
pub fn main() -> ExitCode {
    let command = match Cli::try_parse() {
        Ok(cli) => cli.command,
        Err(error) => return print_clap_message(&error),
    };
    let result = match command {
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
    match result {
        Ok(code) => code,
        Err(Failure::BrokenPipe) => ExitCode::SUCCESS,
        Err(Failure::Message(message)) => {
            output::message(&format!("error: {message}"));
            ExitCode::FAILURE
        }
    }
}

/// Prints help, the version, or an error of the arguments.
///
/// An error quotes arguments, so its control characters are escaped.
fn print_clap_message(error: &clap::Error) -> ExitCode {
    if error.use_stderr() {
        output::message(error.render().to_string().trim_end());
    } else {
        // A standard output that cannot be written is no failure of this command.
        let _ = error.print();
    }
    u8::try_from(error.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}
