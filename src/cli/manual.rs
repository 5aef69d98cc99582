//! Completions for shells, and the manual page.

use std::process::ExitCode;

use clap::CommandFactory;

use super::Cli;
use super::output::{self, Done};

/// Print completions for a shell.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab completions bash > ~/.local/share/bash-completion/completions/maxq-lab")]
pub(super) struct CompletionArgs {
    /// The shell.
    #[arg(value_enum)]
    shell: clap_complete::Shell,
}

/// Print the manual page, in roff.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab manual | man -l -")]
pub(super) struct ManualArgs {}

/// Carries out `completions`.
pub(super) fn completions(args: &CompletionArgs) -> Done {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "maxq-lab", &mut script);
    output::raw(&script)?;
    Ok(ExitCode::SUCCESS)
}

/// Carries out `manual`: the page of the program, then that of each command.
pub(super) fn manual(_args: &ManualArgs) -> Done {
    let mut command = Cli::command();
    command.build();
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone()).render(&mut page)?;
    for subcommand in command.get_subcommands() {
        clap_mangen::Man::new(subcommand.clone()).render(&mut page)?;
    }
    output::raw(&page)?;
    Ok(ExitCode::SUCCESS)
}
