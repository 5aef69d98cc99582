//! Whole runs: what threads bring, what recording costs, what memory a run takes.
//!
//! Machines are shared and noisy, so the variants take turns and are compared within
//! each turn; the figures are medians over the turns. An argument names the scenario:
//! `cargo bench --bench whole_run -- environment-2`.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use maxq_lab::evolution::{Evolution, Experiment, Workers};
use maxq_lab::lab::{Keep, RunOptions, WorldTask, start, with_world};
use maxq_lab::learning::Gate;
use maxq_lab::scenario::Scenario;
use maxq_lab::worlds::World;

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
        let (unrecorded, steps) = unrecorded(&scenario)?;
        control_steps = steps;
        turns.push([
            unrecorded,
            recorded(&scenario, 1, Keep::All)?,
            recorded(&scenario, 2, Keep::All)?,
        ]);
    }
    let median = |of: &dyn Fn(&[f64; 3]) -> f64| {
        let mut values: Vec<_> = turns.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let steps = control_steps as f64;
    println!("{name}, seed {SEED}: {control_steps} control steps, medians of {TURNS} turns");
    println!("one thread, not recorded   {:6.3} s", median(&|t| t[0]));
    println!("one thread, recorded       {:6.3} s", median(&|t| t[1]));
    println!("two threads, recorded      {:6.3} s", median(&|t| t[2]));
    println!(
        "control steps a second     {:6.2} million on one thread",
        median(&|t| steps / t[1] / 1e6)
    );
    println!(
        "recording costs            {:6.2} %",
        median(&|t| 100.0 * (t[1] / t[0] - 1.0))
    );
    println!(
        "two threads against one    {:6.2} times",
        median(&|t| t[1] / t[2])
    );
    println!(
        "peak memory                {:6.1} MiB on two threads",
        peak_memory(&name)?
    );
    Ok(())
}

fn recorded(scenario: &Scenario, threads: usize, keep: Keep) -> Result<f64, Error> {
    let folder = tempfile::tempdir()?;
    let options = RunOptions {
        threads,
        keep,
        force: false,
    };
    let started = Instant::now();
    start(scenario.clone(), SEED, &folder.path().join("run"), &options)?.join()?;
    Ok(started.elapsed().as_secs_f64())
}

/// The same computation without events, recorder or files.
fn unrecorded(scenario: &Scenario) -> Result<(f64, u64), Error> {
    let started = Instant::now();
    let control_steps = with_world(scenario.clone(), Unrecorded)??;
    Ok((started.elapsed().as_secs_f64(), control_steps))
}

struct Unrecorded;

impl WorldTask for Unrecorded {
    type Output = Result<u64, Error>;

    fn carry_out<W: World + 'static>(self, experiment: Experiment<W>) -> Self::Output {
        let (workers, gate) = (Workers::new(1)?, Gate::default());
        let mut evolution = Evolution::begin(&experiment, &workers, SEED, &gate)?;
        while !evolution.is_over() {
            evolution.step(&gate, |_| {})?;
        }
        Ok(evolution.state().control_steps)
    }
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
