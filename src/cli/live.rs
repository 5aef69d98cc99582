//! Following a run of this process to its end, with a dashboard or without.

use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, ExitCode, Stdio};
use std::thread;
use std::time::Duration;

use signal_hook::consts::SIGHUP;

use super::args::{ExecutionArgs, OnHangup};
use super::dashboard::{DashboardArgs, DashboardSettings};
use super::output::{self, CommandResult, Failure, Format, counted};
use super::progress;
use super::signals::{SignalWatcher, Termination};
use crate::dashboard::session::{Exit, Source};
use crate::dashboard::terminal;
use crate::hierarchy::{Glyphs, draw};
use crate::lab::{Outcome, Run, departures, in_words, lasting_experiment};
use crate::scenario::{Scenario, Selection};

/// Longest wait for a terminal to take the last words.
pub(super) const PATIENCE: Duration = Duration::from_secs(2);

/// The keys and looks of a dashboard, if there will be one.
pub(super) fn dashboard(execution: &ExecutionArgs) -> Result<Option<DashboardSettings>, Failure> {
    match execution.headless || !DashboardArgs::is_possible() {
        true => Ok(None),
        false => execution.dashboard.settings().map(Some),
    }
}

/// Follows a run to its end and reports its result. Signals were caught before the run
/// began, so that none falls between.
pub(super) fn follow(
    run: Run,
    dashboard: Option<DashboardSettings>,
    signals: SignalWatcher,
    execution: &ExecutionArgs,
) -> CommandResult {
    let ended = Termination::default();
    // There is a line that can drop. Without one SIGHUP asks the program to end.
    let survives = execution.on_hangup == OnHangup::Detach && terminal::is_attached();
    let exit = match dashboard {
        Some(dashboard) => match show(&run, dashboard, &signals) {
            Ok(exit) => Some(exit),
            Err(failure) => {
                run.controls.stop();
                run.join()?;
                return Err(failure);
            }
        },
        None => None,
    };
    // Nobody could let a run go on that waits.
    if goes_on(exit, &ended, execution.on_hangup, || run.controls.resume()) {
        headless(&run, signals, &ended, survives)?;
    } else {
        if exit == Some(Exit::Left) {
            ended.by_hand();
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
        let folder = &outcome.run_dir;
        output::message(&format!("stopped; go on with: maxq-lab resume {folder}"));
    }
    match exit {
        Some(Exit::Panicked) => Ok(ExitCode::FAILURE),
        _ => Ok(ended
            .exit_code()
            .filter(|_| outcome.stopped)
            .map_or(ExitCode::SUCCESS, ExitCode::from)),
    }
}

fn show(run: &Run, dashboard: DashboardSettings, signals: &SignalWatcher) -> Result<Exit, Failure> {
    let experiment = lasting_experiment(run.scenario.clone(), run.seed)?;
    let source = Source::live(&run.events, &run.controls);
    dashboard.show(experiment, &run.folder, source, signals)
}

/// Whether work goes on without its dashboard that was left like this, or was not there;
/// `resume` lets it, where the line dropped.
pub(super) fn goes_on(
    exit: Option<Exit>,
    ended: &Termination,
    on_hangup: OnHangup,
    resume: impl FnOnce(),
) -> bool {
    match exit {
        None => true,
        Some(Exit::HungUp) => {
            // A run without a terminal is not worth less for a system without /dev/null.
            let _detached = terminal::detach();
            match on_hangup {
                OnHangup::Detach => resume(),
                OnHangup::Stop => ended.by(SIGHUP),
            }
            on_hangup == OnHangup::Detach
        }
        Some(Exit::Signal(signal)) => {
            ended.by(signal);
            false
        }
        Some(_) => false,
    }
}

/// Follows a run to its end without a dashboard, and through the drop of the line if it
/// `survives` that.
fn headless(
    run: &Run,
    signals: SignalWatcher,
    ended: &Termination,
    survives: bool,
) -> Result<(), Failure> {
    let controls = run.controls.clone();
    signals.stop(ended, survives, move || controls.stop())?;
    let evolution = &run.scenario.evolution;
    let (limit, population) = (evolution.generation_limit, evolution.population_size);
    progress::follow(&run.events, limit, population);
    Ok(())
}

/// Ends the program after a time, if it is still there: it was asked to end, the run is
/// saved, and a terminal that takes nothing must not hold up what is left to say.
pub(super) fn end_within(time: Duration, code: i32) -> Result<(), Failure> {
    thread::Builder::new()
        .name(String::from("patience"))
        .spawn(move || {
            thread::sleep(time);
            signal_hook::low_level::exit(code);
        })?;
    Ok(())
}

/// Lets another process without a terminal go on with a run that was stopped.
fn hand_over(outcome: &Outcome, execution: &ExecutionArgs) -> CommandResult {
    let folder = &outcome.run_dir;
    let mut command = Command::new(std::env::current_exe()?);
    command.args(execution.resume_headless());
    command.arg("--").arg(Path::new(folder));
    // A job of its own: what the shell does to its jobs is not meant for it.
    command.process_group(0);
    let null = Stdio::null;
    let process = command.stdin(null()).stdout(null()).stderr(null()).spawn();
    let process = process.map_err(|error| {
        format!("no process can go on with the run ({error}); do so with: maxq-lab resume {folder}")
    })?;
    output::message(&format!(
        "process {} goes on with the run; look at it with: maxq-lab watch {folder}",
        process.id()
    ));
    Ok(ExitCode::SUCCESS)
}

/// A result, for people.
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
        _ => "reached its limit of",
    };
    let mut lines = vec![
        format!(
            "{}, seed {}: {ending} {}",
            outcome.scenario,
            outcome.seed,
            counted(*generations, "generation")
        ),
        format!(
            "{control_steps} control steps in all, {wall_seconds:.2} s now, in {}",
            outcome.run_dir
        ),
    ];
    // A result must not pass for that of the embedded scenario whose name it has.
    let changed = in_words(&departures(scenario));
    lines.extend(changed.map(|changed| format!("changed: {changed}")));
    if let Some(best) = &outcome.best {
        lines.push(format!(
            "{} {}: {:.1} time steps a trial, {} composite and {}",
            first(scenario.evolution.selection),
            best.id,
            best.fitness,
            best.composites,
            counted(best.primitives.len() as u64, "primitive subtask")
        ));
        lines.push(String::new());
        lines.extend(super::tree::with_tree(
            scenario,
            &best.tree,
            |tree, catalogue| draw(tree, catalogue, Glyphs::of_locale()),
        )?);
        lines.push(String::new());
        for (index, primitives) in best.primitives_by_state_type.iter().enumerate() {
            lines.push(format!(
                "state type {}: {}",
                index + 1,
                primitives.join(", ")
            ));
        }
        lines.push(format!("\n{}", caution(scenario.evolution.selection)));
    }
    Ok(lines.join("\n") + "\n")
}

/// What the individual of rank 1 is.
fn first(selection: Selection) -> &'static str {
    match selection {
        Selection::Fitness => "best individual",
        Selection::Random => "individual that chance ranked first,",
    }
}

/// What to bear in mind about it.
fn caution(selection: Selection) -> &'static str {
    match selection {
        Selection::Fitness => {
            "The best of many is also the luckiest; 'maxq-lab evaluate' tells how good its \
             structure is."
        }
        Selection::Random => {
            "Chance took the place of fitness here: no individual was selected for being good."
        }
    }
}
