//! `maxq-lab completions` and `maxq-lab manual`.

use std::io;
use std::process::ExitCode;

use clap::CommandFactory;

use super::Cli;
use super::names;
use super::output::{self, CommandResult};

/// Print a shell completion script.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab completions bash > ~/.local/share/bash-completion/completions/maxq-lab
  maxq-lab completions zsh > ~/.zfunc/_maxq-lab           a directory in $fpath
  maxq-lab completions fish > ~/.config/fish/completions/maxq-lab.fish")]
pub(super) struct CompletionArgs {
    /// Shell.
    #[arg(value_enum)]
    shell: clap_complete::Shell,
}

/// Print the manual pages in roff format.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab manual | man -l -")]
pub(super) struct ManualArgs {}

/// Runs `maxq-lab completions`.
pub(super) fn completions(args: &CompletionArgs) -> CommandResult {
    let (mut script, mut command) = (Vec::new(), Cli::command());
    clap_complete::generate(args.shell, &mut command, "maxq-lab", &mut script);
    let script = names::completed(args.shell, &String::from_utf8(script)?, &command);
    output::raw(script.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// Runs `maxq-lab manual`: prints the page of the program, then those of its commands.
pub(super) fn manual(_args: &ManualArgs) -> CommandResult {
    let mut command = Cli::command();
    command.build();
    let mut pages = Vec::new();
    render(&command, &mut pages)?;
    output::raw(&pages)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes the page of a command, then those of its subcommands.
fn render(command: &clap::Command, pages: &mut Vec<u8>) -> io::Result<()> {
    clap_mangen::Man::new(command.clone()).render(pages)?;
    // Clap adds `help` to every command; it needs no page.
    let commands = command.get_subcommands();
    let mut commands = commands.filter(|inner| inner.get_name() != "help");
    commands.try_for_each(|inner| render(inner, pages))
}
