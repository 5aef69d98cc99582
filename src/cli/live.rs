//! Follows a run of this process to its end, with a dashboard or without.

use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::thread;
use std::time::Duration;

use signal_hook::consts::SIGHUP;

use super::args::{ExecutionArgs, OnHangup};
use super::dashboard::DashboardSettings;
use super::output::{self, CommandResult, Failure, Format, counted};
use super::progress;
use super::signals::{SignalWatcher, Termination, spawn};
use super::tree::{by_state_type, with_tree};
use crate::dashboard::session::{Exit, Source};
use crate::dashboard::terminal;
use crate::hierarchy::{Glyphs, draw};
use crate::lab::{Outcome, Run, lasting_experiment, overrides, summarise};
use crate::scenario::{Scenario, Selection};
use crate::words::shell_word;

/// How long a terminal may take to accept the last messages after a signal.
pub(super) const PATIENCE: Duration = Duration::from_secs(2);

/// Follows a run to its end and reports its result.
///
/// `signals` must have been started before the run, so that none is missed.
pub(super) fn follow(
    run: Run,
    dashboard: Option<DashboardSettings>,
    signals: SignalWatcher,
    execution: &ExecutionArgs,
) -> CommandResult {
    let termination = Termination::default();
    // Asked while there is still a terminal.
    let survives = execution.on_hangup.survives();
    let exit = match dashboard.map(|dashboard| show(&run, dashboard, &signals)) {
        None => None,
        Some(Ok(exit)) => Some(exit),
        Some(Err(failure)) => {
            run.controls.stop();
            run.join()?;
            return Err(failure);
        }
    };
    // A paused run is resumed: without a dashboard nobody else could.
    let resume = || run.controls.resume();
    if continues(exit, &termination, execution.on_hangup, resume) {
        headless(&run, signals, &termination, survives)?;
    } else {
        if exit == Some(Exit::Left) {
            termination.record_user_stop();
        }
        run.controls.stop();
    }
    let scenario = run.scenario.clone();
    let outcome = run.join()?;
    if let (Some(Exit::Signal(signal)), true) = (exit, outcome.stopped) {
        end_within(PATIENCE, 128 + signal)?;
    }
    match execution.format {
        Format::Json => output::json(&outcome)?,
        Format::Text => output::text(&describe(&outcome, &scenario)?)?,
    }
    if outcome.stopped && exit == Some(Exit::Detached) {
        return hand_over(&outcome, execution);
    }
    if outcome.stopped {
        let folder = shell_word(&outcome.run_dir);
        output::message(&format!("stopped; resume with: maxq-lab resume {folder}"));
    }
    if exit == Some(Exit::Panicked) {
        return Ok(ExitCode::FAILURE);
    }
    let code = termination.exit_code().filter(|_| outcome.stopped);
    Ok(code.map_or(ExitCode::SUCCESS, ExitCode::from))
}

fn show(run: &Run, dashboard: DashboardSettings, signals: &SignalWatcher) -> Result<Exit, Failure> {
    let experiment = lasting_experiment(run.scenario.clone(), run.seed)?;
    let source = Source::live(&run.events, &run.controls);
    dashboard.show(experiment, &run.folder, source, signals)
}

/// Whether the work continues without a dashboard after `exit`; `None` means that there was
/// no dashboard.
///
/// After a hangup the program leaves its terminal, and `resume` is called if the work
/// continues.
pub(super) fn continues(
    exit: Option<Exit>,
    termination: &Termination,
    on_hangup: OnHangup,
    resume: impl FnOnce(),
) -> bool {
    match exit {
        None => return true,
        Some(Exit::HungUp) => {
            // Fails only without /dev/null, and then the work goes on all the same.
            let _detached = terminal::detach();
            if on_hangup == OnHangup::Detach {
                resume();
                return true;
            }
            termination.record(SIGHUP);
        }
        Some(Exit::Signal(signal)) => termination.record(signal),
        Some(_) => {}
    }
    false
}

/// Follows a run to its end with a progress bar.
fn headless(
    run: &Run,
    signals: SignalWatcher,
    termination: &Termination,
    survives_hangup: bool,
) -> Result<(), Failure> {
    let controls = run.controls.clone();
    signals.stop_on_signals(termination, survives_hangup, move || controls.stop())?;
    progress::follow(&run.events, &run.scenario.evolution);
    Ok(())
}

/// Ends the program after `time` if it still runs.
///
/// It was asked to end and the run is saved: a terminal that accepts no output must not keep
/// it alive.
pub(super) fn end_within(time: Duration, code: i32) -> Result<(), Failure> {
    spawn("patience", move || {
        thread::sleep(time);
        signal_hook::low_level::exit(code);
    })
}

/// Lets another process, without a terminal, resume the stopped run.
fn hand_over(outcome: &Outcome, execution: &ExecutionArgs) -> CommandResult {
    let folder = &outcome.run_dir;
    let mut command = Command::new(std::env::current_exe()?);
    command.args(execution.resume_headless());
    command.arg("--").arg(Path::new(folder));
    // A process group of its own, out of reach of the shell's job control.
    command.process_group(0);
    let null = Stdio::null;
    let process = command.stdin(null()).stdout(null()).stderr(null()).spawn();
    let folder = shell_word(folder);
    let process = process.map_err(|error| {
        format!(
            "cannot start a process for the run ({error}); resume with: maxq-lab resume {folder}"
        )
    })?;
    output::message(&format!(
        "process {} continues the run; watch it with: maxq-lab watch {folder}",
        process.id()
    ));
    Ok(ExitCode::SUCCESS)
}

/// The result as text.
fn describe(outcome: &Outcome, scenario: &Scenario) -> Result<String, Failure> {
    let Outcome {
        generations,
        control_steps,
        wall_seconds,
        ..
    } = outcome;
    let ending = match (outcome.converged, outcome.stopped) {
        (true, _) => "converged after",
        (_, true) => "stopped after",
        _ if *generations >= scenario.evolution.generation_limit => "reached its limit of",
        _ => "reached its limit of control steps after",
    };
    let mut lines = vec![
        format!(
            "{}, seed {}: {ending} {}",
            outcome.scenario,
            outcome.seed,
            counted(*generations, "generation")
        ),
        format!(
            "{control_steps} control steps, {wall_seconds:.2} s in this session, saved in {}",
            outcome.run_dir
        ),
    ];
    // Changed settings are named, so that the result does not pass for the built-in scenario's.
    let changed = summarise(&overrides(scenario));
    lines.extend(changed.map(|changed| format!("changed: {changed}")));
    if let Some(best) = &outcome.best {
        lines.push(format!(
            "{} {}: {:.1} time steps per trial, {} composite and {}",
            first(scenario.evolution.selection),
            best.id,
            best.fitness,
            best.composites,
            counted(best.primitives.len() as u64, "primitive subtask")
        ));
        if let Some(later) = outcome.later {
            lines.push(format!(
                "then {} more trials of learning: {:.1} time steps per trial in the first {}, {:.1} \
                 in the last {}",
                later.trials, later.first, later.part, later.last, later.part
            ));
        }
        lines.push(String::new());
        lines.extend(with_tree(scenario, &best.tree, |tree, catalogue| {
            draw(tree, catalogue, Glyphs::of_locale())
        })?);
        lines.push(format!(
            "\n{}\n{}",
            by_state_type(&best.primitives_by_state_type),
            caution(scenario.evolution.selection)
        ));
    }
    Ok(lines.join("\n") + "\n")
}

/// What rank 1 means.
fn first(selection: Selection) -> &'static str {
    match selection {
        Selection::Fitness => "best individual",
        Selection::Random => "individual ranked first at random,",
    }
}

/// How to read the result.
fn caution(selection: Selection) -> &'static str {
    match selection {
        Selection::Fitness => {
            "The best of many individuals is also the luckiest: run 'maxq-lab evaluate' to measure \
             its structure."
        }
        Selection::Random => {
            "Selection was random in this run: no individual was selected for its fitness."
        }
    }
}
