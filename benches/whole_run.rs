//! Whole runs: what threads bring, what recording costs, what memory a run takes.
//!
//! Machines are shared and noisy, so the variants take turns and are compared within
//! each turn. An argument names the scenario:
//! `cargo bench --bench whole_run -- environment-2`.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use maxq_lab::evolution::Workers;
use maxq_lab::lab::{Keep, RunOptions, experiment, start};
use maxq_lab::learning::Gate;
use maxq_lab::scenario::Scenario;

const TURNS: usize = 7;
const SEED: u64 = 1;

type Error = Box<dyn std::error::Error>;

fn main() -> Result<(), Error> {
    let named = std::env::args()
        .skip(1)
        .find(|argument| !argument.starts_with('-'));
    let name = named.unwrap_or_else(|| String::from("environment-1"));
    let scenario = Scenario::load(&name)?;
    let mut turns = Vec::new();
    let mut control_steps = 0;
    for _ in 0..TURNS {
        turns.push([
            measured(|| {
                control_steps = unrecorded(&scenario)?;
                Ok(())
            })?,
            measured(|| recorded(&scenario, 1, Keep::All))?,
            measured(|| recorded(&scenario, 2, Keep::All))?,
            measured(|| two_at_once(&scenario))?,
        ]);
    }
    let median = |of: &dyn Fn(&[Cost; 4]) -> f64| {
        let mut values: Vec<_> = turns.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    // Processors count in hundredths of a second: sums, not medians.
    let processor = |variant: usize| turns.iter().map(|t| t[variant].processor).sum::<f64>();
    let wall = |variant: usize| turns.iter().map(|t| t[variant].wall).sum::<f64>();
    let steps = control_steps as f64;
    println!(
        "{name}, seed {SEED}: {control_steps} control steps, {TURNS} turns; wall times are medians"
    );
    println!(
        "one thread, not recorded   {:6.3} s",
        median(&|t| t[0].wall)
    );
    println!(
        "one thread, recorded       {:6.3} s",
        median(&|t| t[1].wall)
    );
    println!(
        "two threads, recorded      {:6.3} s",
        median(&|t| t[2].wall)
    );
    println!(
        "control steps a second     {:6.2} million on one thread; {:.2} million a second of processor time",
        median(&|t| steps / t[1].wall / 1e6),
        steps * TURNS as f64 / processor(1) / 1e6
    );
    println!(
        "recording costs            {:6.2} % of processor time, {:.2} % of wall time",
        100.0 * (processor(1) / processor(0) - 1.0),
        median(&|t| 100.0 * (t[1].wall / t[0].wall - 1.0))
    );
    println!(
        "two threads against one    {:6.2} times; they computed {:.1} % of the time",
        median(&|t| t[1].wall / t[2].wall),
        100.0 * processor(2) / (2.0 * wall(2))
    );
    println!(
        "two processors allow       {:6.2} times: two runs at once, on one thread each and unrecorded, against one",
        median(&|t| 2.0 * t[0].wall / t[3].wall)
    );
    println!(
        "peak memory                {:6.1} MiB on two threads",
        peak_memory(&name)?
    );
    Ok(())
}

/// What something took, in seconds.
struct Cost {
    wall: f64,
    /// Of all threads together.
    processor: f64,
}

fn measured(work: impl FnOnce() -> Result<(), Error>) -> Result<Cost, Error> {
    let (started, before) = (Instant::now(), processor_time()?);
    work()?;
    Ok(Cost {
        wall: started.elapsed().as_secs_f64(),
        processor: processor_time()? - before,
    })
}

/// What this process has computed so far, by Linux's account of it.
fn processor_time() -> Result<f64, Error> {
    let text = std::fs::read_to_string("/proc/self/stat")?;
    // The fields after the name, which stands in brackets: state is the first of them.
    let fields = text.rsplit(')').next().unwrap_or_default();
    let fields: Vec<_> = fields.split_whitespace().collect();
    let ticks = |index: usize| -> Result<f64, Error> {
        Ok(fields.get(index).ok_or("no such field")?.parse::<f64>()?)
    };
    Ok((ticks(11)? + ticks(12)?) / 100.0)
}

fn recorded(scenario: &Scenario, threads: usize, keep: Keep) -> Result<(), Error> {
    let folder = tempfile::tempdir()?;
    let options = RunOptions {
        threads,
        keep: Some(keep),
        force: false,
    };
    start(scenario.clone(), SEED, &folder.path().join("run"), &options)?.join()?;
    Ok(())
}

/// The same computation without events, recorder or files.
fn unrecorded(scenario: &Scenario) -> Result<u64, Error> {
    let state = experiment(scenario.clone(), SEED)?.evolve(&Workers::new(1)?, &Gate::default())?;
    Ok(state.control_steps)
}

/// Two runs that have nothing to do with each other: what a second processor brings at best,
/// where caches, memory and clock rates are shared.
fn two_at_once(scenario: &Scenario) -> Result<(), Error> {
    let run = || unrecorded(scenario).map_err(|error| error.to_string());
    std::thread::scope(|scope| {
        let runs = [scope.spawn(run), scope.spawn(run)];
        for run in runs {
            run.join().map_err(|_| "a run has panicked")??;
        }
        Ok(())
    })
}

/// The largest resident set of the real program, from Linux's account of the process.
fn peak_memory(name: &str) -> Result<f64, Error> {
    let folder = tempfile::tempdir()?;
    let mut child = Command::new(env!("CARGO_BIN_EXE_maxq-lab"))
        .args(["run", name, "--threads", "2", "--out"])
        .arg(folder.path().join("run"))
        .stdout(Stdio::null())
        .spawn()?;
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0.0_f64;
    while child.try_wait()?.is_none() {
        let lines = std::fs::read_to_string(Path::new(&status)).unwrap_or_default();
        let line = lines.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
        peak = peak.max(kib.unwrap_or(0.0) / 1024.0);
        std::thread::sleep(Duration::from_millis(2));
    }
    Ok(peak)
}
