//! Studies on several machines: `study commands`, `study slurm` and `study merge`.

use std::path::PathBuf;
use std::process::ExitCode;

use super::StudyArgs;
use crate::cli::output::{self, CommandResult};
use crate::report::{PLAN_FILE, Study, merge};
use crate::words::{shell_path, shell_word};

/// The largest job array that Slurm allows by default (MaxArraySize 1001).
const MAX_TASKS: usize = 1000;

/// Print one command line per run, for GNU parallel.
///
/// Creates the study folder and prints a command line for every run, to be executed on this
/// machine or over SSH. A command line may be executed repeatedly: a finished run is skipped, an
/// interrupted run is resumed, and only the folder of that run is written.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study commands thesis --out thesis | parallel --joblog jobs.log
  maxq-lab study commands thesis --out thesis > runs.txt
  parallel --sshloginfile hosts.txt --workdir . --basefile thesis/study.json \\
           --joblog jobs.log --resume-failed < runs.txt
Without a shared file system, copy the study folders of all hosts to one machine and combine
them with 'maxq-lab study merge'.")]
pub(super) struct CommandsArgs {
    #[command(flatten)]
    study: StudyArgs,

    #[command(flatten)]
    program: ProgramArg,
}

/// Print a Slurm batch script for a job array.
///
/// Creates the study folder and prints a batch script that does one run per array task. On
/// SIGTERM (preemption, or 90 seconds before the time limit) a task saves its run and requeues
/// itself; the run is resumed later. Give partition, account and time limit (well above 90 seconds)
/// to sbatch.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab study slurm thesis --out thesis > thesis.sbatch
  sbatch --time=1:00:00 thesis.sbatch")]
pub(super) struct SlurmArgs {
    #[command(flatten)]
    study: StudyArgs,

    /// Number of runs per array task, done one after the other [default: 1, or more if the array
    /// would exceed 1000 tasks].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    per_task: Option<u32>,

    #[command(flatten)]
    program: ProgramArg,
}

/// How the program is called.
#[derive(Debug, clap::Args)]
struct ProgramArg {
    /// Name or path of this program on the machines that do the runs.
    #[arg(long, value_name = "FILE", default_value = "maxq-lab")]
    program: String,
}

impl ProgramArg {
    /// The command line that does runs of `study`, without saying which.
    fn command(&self, study: &Study) -> String {
        let (program, folder) = (shell_word(&self.program), shell_path(&study.folder));
        let plan = shell_path(study.folder.join(PLAN_FILE));
        format!("{program} study {plan} --out {folder} --jobs 1 --headless --only")
    }
}

/// Combine parts of a study that were done on different machines.
///
/// The plans of the parts may differ in their seeds; the combined study has all of them. For every
/// run the most advanced folder is taken. A run that is finished in several parts must
/// be identical in all of them. The order of the parts does not matter: the events,
/// checkpoints, evaluations and report have the same bytes as if one machine had done the study.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab study merge from-host-a from-host-b --out thesis; maxq-lab study report thesis")]
pub(super) struct MergeArgs {
    /// Study folders to combine.
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,

    /// Folder for the combined study; it may be one of the parts.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Runs `study commands`.
pub(super) fn commands(args: &CommandsArgs) -> CommandResult {
    let study = args.study.create()?;
    let command = args.program.command(&study);
    let runs = study.runs();
    let lines = runs
        .iter()
        .map(|run| format!("{command} {}\n", study.name(run)));
    output::text(&lines.collect::<String>())?;
    Ok(ExitCode::SUCCESS)
}

/// Runs `study slurm`.
pub(super) fn slurm(args: &SlurmArgs) -> CommandResult {
    let study = args.study.create()?;
    let runs = study.runs().len();
    let least = runs.div_ceil(MAX_TASKS);
    let count = |n: u32| usize::try_from(n).unwrap_or(usize::MAX);
    let per_task = args.per_task.map_or(least, count).clamp(1, runs.max(1));
    let command = args.program.command(&study);
    output::text(&batch_script(&study.plan.name, &command, runs, per_task))?;
    Ok(ExitCode::SUCCESS)
}

/// A job array that does runs 1 to `runs`, `per_task` of them in each task.
fn batch_script(name: &str, command: &str, runs: usize, per_task: usize) -> String {
    let tasks = runs.div_ceil(per_task);
    let mut range = String::new();
    let mut only = "$SLURM_ARRAY_TASK_ID";
    if per_task > 1 {
        let before = per_task - 1;
        range =
            format!("last=$(( SLURM_ARRAY_TASK_ID * {per_task} ))\nfirst=$(( last - {before} ))\n");
        if tasks * per_task > runs {
            range += &format!("[ \"$last\" -le {runs} ] || last={runs}\n");
        }
        only = "$first..$last";
    }
    format!(
        r#"#!/bin/bash
#SBATCH --job-name=maxq-lab-{name}
#SBATCH --array=1-{tasks}
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@90
# {runs} runs, {per_task} per array task. The time limit must be well above 90 seconds.

{range}{command} "{only}" &
run=$!
# On SIGTERM the run is saved, and the task is requeued to resume it later.
stop() {{
    kill -TERM "$run" 2>/dev/null
    wait "$run"
    status=$?
    [ "$status" -eq 143 ] && scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
    exit "$status"
}}
trap stop TERM
wait "$run"
"#
    )
}

/// Runs `study merge`.
pub(super) fn merge_parts(args: &MergeArgs) -> CommandResult {
    let runs = merge(&args.parts, &args.out)?;
    let (parts, out) = (args.parts.len(), args.out.display());
    output::text(&format!(
        "combined {parts} parts into {out}, a study of {runs} runs\n"
    ))?;
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_runs_are_computed_beforehand() {
        let script = |runs, per_task| batch_script("name", "command", runs, per_task);
        let one = script(7, 1);
        assert!(one.contains("--array=1-7\n"), "{one}");
        assert!(
            one.contains("\ncommand \"$SLURM_ARRAY_TASK_ID\" &\n"),
            "{one}"
        );
        let three = script(7, 3);
        assert!(three.contains("--array=1-3\n"), "{three}");
        let range = "last=$(( SLURM_ARRAY_TASK_ID * 3 ))\nfirst=$(( last - 2 ))\n\
                     [ \"$last\" -le 7 ] || last=7\ncommand \"$first..$last\" &\n";
        assert!(three.contains(range), "{three}");
        assert!(!script(6, 3).contains("-le"), "no task is shorter");
    }
}
