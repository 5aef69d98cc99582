//! The cost of the dashboard, measured with the real program in a real terminal: time to the
//! first frame, time from a key to its response, bytes per second, and the slowdown of
//! evolution.
//!
//! `cargo bench --bench dashboard` prints all figures next to their goals; `-- start`, `keys`,
//! `bytes`, `silence` or `cost` prints some of them. The slowdown of evolution is the median
//! over pairs of runs with and without the dashboard, as time and as processor time; other
//! programs on the machine affect the latter less.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../tests/terminal/pty.rs"]
mod pty;

use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use pty::{Pty, processor_seconds, program};
use tempfile::TempDir;

/// Settings of an evolution that runs until it is stopped.
const ENDLESS: [&str; 4] = [
    "--set",
    "evolution.variation=none",
    "--set",
    "evolution.generation_limit=100000",
];

/// Time for which bytes are counted.
const COUNTED: Duration = Duration::from_secs(20);

/// Time in which no bytes may be sent.
const SILENT: Duration = Duration::from_secs(5);

/// Number of program starts.
const STARTS: usize = 9;

/// Number of key presses.
const KEYS: usize = 50;

/// Number of pairs of runs.
const PAIRS: usize = 5;

fn main() {
    // Test runners ask every benchmark for its list of tests.
    if std::env::args().any(|argument| argument == "--list") {
        return;
    }
    println!("{:52} {:>14} {:>16}", "", "measured", "goal");
    let parts: [(&str, fn()); 5] = [
        ("start", first_frame),
        ("keys", all_keys),
        ("bytes", all_bytes),
        ("silence", silence),
        ("cost", cost),
    ];
    let asked: Vec<_> = std::env::args().skip(1).collect();
    for (name, part) in parts {
        let named = asked.iter().any(|argument| argument == name);
        if named || !asked.iter().any(|argument| !argument.starts_with('-')) {
            part();
        }
    }
}

fn line(what: &str, measured: &str, goal: &str) {
    println!("{what:52} {measured:>14} {goal:>16}");
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn run(folder: &Path, more: &[&str]) -> Pty {
    let folder = folder.to_str().unwrap();
    let arguments = ["run", "environment-3", "--keep", "none", "--out", folder];
    Pty::start(120, 40, program(&[&arguments[..], more].concat()))
}

fn first_frame() {
    let times = (0..STARTS).map(|_| {
        let parent = TempDir::new().unwrap();
        let begun = Instant::now();
        let pty = run(&parent.path().join("run"), &[]);
        pty.wait("a frame", |pty| pty.screen().contains("quit"));
        begun.elapsed().as_secs_f64() * 1000.0
    });
    let time = median(times.collect());
    line(
        "time to the first frame",
        &format!("{time:.0} ms"),
        "150 ms",
    );
}

fn all_keys() {
    keys("10 frames a second", &[]);
    keys("--fps 2", &["--fps", "2"]);
}

/// Measures the time from a key press to the view that it opens, while all threads compute.
fn keys(what: &str, more: &[&str]) {
    let parent = TempDir::new().unwrap();
    let mut pty = run(&parent.path().join("run"), &[&ENDLESS[..], more].concat());
    pty.wait("a generation", |pty| pty.screen().contains("generation 2"));
    let views = [("6", " Population "), ("1", " Overview ")];
    let times = (0..KEYS).map(|index| {
        // Press keys at different times between two frames.
        thread::sleep(Duration::from_millis(200 + 37 * index as u64 % 100));
        let (key, title) = views[index % 2];
        let begun = Instant::now();
        pty.press(key);
        while !pty.screen().lines().next().unwrap().contains(title) {
            assert!(
                begun.elapsed() < Duration::from_secs(60),
                "{key} does nothing"
            );
            thread::sleep(Duration::from_micros(200));
        }
        begun.elapsed().as_secs_f64() * 1000.0
    });
    let times: Vec<_> = times.collect();
    let worst = times.iter().copied().fold(0.0, f64::max);
    let measured = format!("{:.0}, {worst:.0} ms", median(times));
    line(
        &format!("key to response, {what}: median, worst"),
        &measured,
        "50 ms",
    );
}

fn all_bytes() {
    let moving = "all panels moving";
    bytes(&format!("120x40, 10 frames a second, {moving}"), &[], 20.0);
    bytes(&format!("120x40, --fps 2, {moving}"), &["--fps", "2"], 5.0);
}

/// Counts bytes from the first generation on.
fn bytes(what: &str, more: &[&str], goal: f64) {
    let parent = TempDir::new().unwrap();
    let pty = run(&parent.path().join("run"), &[&ENDLESS[..], more].concat());
    pty.wait("a generation", |pty| pty.screen().contains("generation 2"));
    let (before, begun) = (pty.bytes(), Instant::now());
    thread::sleep(COUNTED);
    let rate = (pty.bytes() - before) as f64 / begun.elapsed().as_secs_f64() / 1000.0;
    line(what, &format!("{rate:.1} kB/s"), &format!("{goal:.0} kB/s"));
}

fn silence() {
    let parent = TempDir::new().unwrap();
    let mut pty = run(&parent.path().join("run"), &ENDLESS);
    pty.wait("a generation", |pty| pty.screen().contains("generation 2"));
    pty.press("p");
    pty.wait("the pause", |pty| pty.screen().contains("PAUSED"));
    pty.press(" ");
    // Wait for pending frames and for messages to expire.
    let mut last = (0, Instant::now());
    pty.wait("silence", |pty| {
        if pty.bytes() != last.0 {
            last = (pty.bytes(), Instant::now());
        }
        last.1.elapsed() > Duration::from_secs(1)
    });
    let before = pty.bytes();
    let used = processor_seconds(pty.id()).unwrap();
    thread::sleep(SILENT);
    let sent = pty.bytes() - before;
    let used = (processor_seconds(pty.id()).unwrap() - used) / SILENT.as_secs_f64();
    line(
        "paused, rollout halted",
        &format!("{sent} bytes"),
        "0 bytes",
    );
    line(
        "paused, rollout halted: processor",
        &format!("{:.1} %", 100.0 * used),
        "",
    );
}

/// Measures the slowdown of evolution.
///
/// Evolution uses one thread, so that on two processors the dashboard has one for itself; the
/// processor time of all threads is counted.
fn cost() {
    let ratios: Vec<[f64; 2]> = (0..PAIRS)
        .map(|_| {
            let [plain, shown] = [false, true].map(whole_run);
            [shown[0] / plain[0], shown[1] / plain[1]]
        })
        .collect();
    for (at, what) in ["time", "processor time, all threads"]
        .into_iter()
        .enumerate()
    {
        let ratio = median(ratios.iter().map(|ratio| ratio[at]).collect());
        let cost = format!("{:+.1} %", 100.0 * (ratio - 1.0));
        line(
            &format!("evolution with the dashboard open: {what}"),
            &cost,
            if at == 0 { "+2 %" } else { "" },
        );
    }
}

/// Returns the time until evolution has ended and the processor time used by then, with or
/// without the dashboard.
fn whole_run(shown: bool) -> [f64; 2] {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let settings = [
        "--threads",
        "1",
        "--set",
        "evolution.variation=none",
        "--set",
        "evolution.generation_limit=40",
    ];
    let more: &[&str] = if shown { &[] } else { &["--headless"] };
    let begun = Instant::now();
    let mut pty = run(&folder, &[&settings[..], more].concat());
    let summary = folder.join("summary.json");
    let mut used = 0.0;
    while !summary.exists() {
        used = processor_seconds(pty.id()).unwrap_or(used);
        thread::sleep(Duration::from_millis(1));
    }
    let time = begun.elapsed().as_secs_f64();
    if shown {
        // Until the program has noticed the end, quitting would open a question.
        pty.wait_for("FINISHED");
        pty.press("q");
    }
    pty.ended();
    [time, used]
}
