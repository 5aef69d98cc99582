//! Studies beyond one machine: `study plan`, `study slurm`, `study merge`.

use std::path::PathBuf;
use std::process::ExitCode;

use super::What;
use crate::cli::output::{self, CommandResult};
use crate::lab::shell_word;
use crate::report::merge;

/// Array tasks that a Slurm controller takes by default (MaxArraySize 1001).
const MAX_TASKS: usize = 1000;

/// Print the study as command lines, one a run.
///
/// Makes the folder with study.json and prints a line for every run, for GNU parallel, on
/// this machine or over SSH. A line is idempotent: what is done is skipped, what was broken
/// off is gone on with, and it writes to its own run folder alone.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab study plan thesis --out thesis | parallel --joblog jobs.log
  maxq-lab study plan thesis --out thesis > runs.txt
  parallel --sshloginfile hosts.txt --workdir . --basefile thesis/study.json \\
           --joblog jobs.log --resume-failed < runs.txt
Hosts without a common file system: copy each one's folder home and put them together
with 'maxq-lab study merge'.")]
pub(super) struct PlanArgs {
    #[command(flatten)]
    what: What,

    #[command(flatten)]
    program: Program,
}

/// Print the study as a Slurm job array.
///
/// Makes the folder with study.json and prints a batch script, one array task for each run;
/// SIGTERM (preemption, or half a minute before the time limit) saves the run and puts the task
/// back into the queue, where it goes on. Partition, time and account are given to sbatch.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab study slurm thesis --out thesis > thesis.sbatch
  sbatch --time=1:00:00 thesis.sbatch")]
pub(super) struct SlurmArgs {
    #[command(flatten)]
    what: What,

    /// Runs that an array task does, one after the other [default: as few as keep the array
    /// at 1000 tasks].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    per_task: Option<u32>,

    #[command(flatten)]
    program: Program,
}

/// ExecutionArgs the program is called where the runs are done.
#[derive(Debug, clap::Args)]
struct Program {
    /// The program, as it is called where the runs are done.
    #[arg(long, value_name = "FILE", default_value = "maxq-lab")]
    program: String,
}

/// Put the parts of a study together.
///
/// Of every run the folder that is furthest is taken; runs that several parts have done must
/// be the same. The order of the parts does not matter, and events, checkpoints, evaluations
/// and report are the same bytes as if one machine had done the study.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Example:
  maxq-lab study merge from-host-a from-host-b --out thesis; maxq-lab study report thesis")]
pub(super) struct MergeArgs {
    /// The folders of the parts.
    #[arg(required = true, value_name = "DIR")]
    parts: Vec<PathBuf>,

    /// The folder of the whole; it may be one of the parts.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Carries out `study plan`.
pub(super) fn plan(args: &PlanArgs) -> CommandResult {
    let study = args.what.study()?;
    let folder = shell_word(&study.folder.display().to_string());
    let file = shell_word(&study.folder.join("study.json").display().to_string());
    let program = shell_word(&args.program.program);
    let lines = study.runs().into_iter().map(|run| {
        let name = study.name(&run);
        format!("{program} study {file} --out {folder} --jobs 1 --headless --only {name}\n")
    });
    output::text(&lines.collect::<String>())?;
    Ok(ExitCode::SUCCESS)
}

/// Carries out `study slurm`.
pub(super) fn slurm(args: &SlurmArgs) -> CommandResult {
    let study = args.what.study()?;
    let runs = study.runs().len();
    let least = runs.div_ceil(MAX_TASKS);
    let per_task = args
        .per_task
        .map_or(least, |n| usize::try_from(n).unwrap_or(usize::MAX));
    let tasks = runs.div_ceil(per_task);
    let folder = study.folder.display().to_string();
    let file = study.folder.join("study.json").display().to_string();
    output::text(&format!(
        r#"#!/bin/bash
#SBATCH --job-name=maxq-lab-{name}
#SBATCH --array=1-{tasks}
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@30
# Each task does {per_task} of {runs} runs: {program} study {file_quoted} --out {folder_quoted}.

first=$(( (SLURM_ARRAY_TASK_ID - 1) * {per_task} + 1 ))
last=$(( first + {per_task} - 1 ))
[ "$last" -le {runs} ] || last={runs}

{program} study {file_quoted} --out {folder_quoted} --jobs 1 --headless --only "$first..$last" &
run=$!
# The run saves what it has and ends; the task goes back into the queue and goes on later.
stop() {{
    kill -TERM "$run" 2>/dev/null
    wait "$run"
    status=$?
    [ "$status" -eq 143 ] && scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
    exit "$status"
}}
trap stop TERM
wait "$run"
"#,
        name = study.plan.name,
        program = shell_word(&args.program.program),
        file_quoted = shell_word(&file),
        folder_quoted = shell_word(&folder),
    ))?;
    Ok(ExitCode::SUCCESS)
}

/// Carries out `study merge`.
pub(super) fn merge_parts(args: &MergeArgs) -> CommandResult {
    let runs = merge(&args.parts, &args.out)?;
    let (parts, out) = (args.parts.len(), args.out.display());
    output::text(&format!("{runs} runs of {parts} parts in {out}\n"))?;
    Ok(ExitCode::SUCCESS)
}
