//! Contract: a follower of a run folder reports the same facts as the run itself, whenever it starts
//! and whatever happens to the run, and writes nothing to the folder.
//!
//! Why it matters: a run on a compute server is watched over a shared folder for days. What is
//! shown must be the run, and watching must not disturb it.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::time::{Duration, SystemTime};

use common::{program, run_in, set, short, stop_after, threads, wait_until};
use maxq_lab::lab::{
    Event, Liveness, News, Recording, RunOptions, Watch, read_events, resume, start,
};
use tempfile::TempDir;

/// All news of a follower, in order.
struct Follower {
    watch: Watch,
    told: Vec<News>,
}

impl Follower {
    fn of(folder: &Path) -> Self {
        let watch = Watch::start(folder, Duration::from_millis(3)).unwrap();
        let told = Vec::new();
        Self { watch, told }
    }

    /// Follows until a piece of news that `is` accepts has come.
    fn until(&mut self, what: &str, is: impl Fn(&News) -> bool) {
        let mut from = 0;
        wait_until(what, || {
            self.told.extend(self.watch.news.try_iter());
            let seen = self.told[from..].iter().position(&is);
            from = self.told.len();
            seen.is_some()
        });
    }

    fn until_liveness(&mut self, liveness: Liveness) {
        self.until(&format!("{liveness:?}"), |news| {
            *news == News::Liveness(liveness)
        });
    }

    /// Returns the recorded events since the latest announcement of a run.
    fn recorded(&self) -> Vec<Event> {
        let is_run = |news: &News| matches!(news, News::Run(_));
        let begin = self.told.iter().rposition(is_run).unwrap();
        let events = self.told[begin..].iter().filter_map(|news| match news {
            News::Event(event) if event.is_recorded() => Some(event.clone()),
            _ => None,
        });
        events.collect()
    }

    fn runs(&self) -> usize {
        let runs = self.told.iter().filter(|news| matches!(news, News::Run(_)));
        runs.count()
    }
}

fn log_of(folder: &Path) -> Vec<Event> {
    read_events(&folder.join("events.jsonl")).unwrap()
}

#[test]
fn a_run_is_followed_from_before_its_folder_exists_to_its_end() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("later/run");
    let mut follower = Follower::of(&folder);
    follower.until_liveness(Liveness::Absent);
    let scenario = short(&["evolution.selection=random"]);
    let run = start(scenario.clone(), 3, &folder, &threads(1)).unwrap();
    run.controls.pause();
    follower.until("the pause", |news| *news == News::Event(Event::Paused));
    assert!(follower.told.contains(&News::Liveness(Liveness::Computing)));
    // Paused, because a whole run may pass between two beats of its pulse.
    run.controls.step();
    let progress = |news: &News| matches!(news, News::Event(event) if event.is_progress());
    follower.until("progress", progress);
    run.controls.resume();
    follower.until_liveness(Liveness::Over);
    run.join().unwrap();
    assert!(follower.recorded() == log_of(&folder));
    let News::Run(manifest) = &follower.told[1] else {
        panic!("the run is told first: {:?}", follower.told[1]);
    };
    assert_eq!((&manifest.scenario, manifest.seed), (&scenario, 3));
}

#[test]
fn an_incomplete_line_is_reported_when_it_is_complete() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let run = start(
        short(&["evolution.selection=random"]),
        1,
        &folder,
        &threads(2),
    );
    stop_after(run.unwrap(), 2);
    let mut follower = Follower::of(&folder);
    follower.until_liveness(Liveness::Stopped);
    let before = follower.recorded();
    let event = Event::Ended {
        generations: 2,
        ending: maxq_lab::lab::Ending::Converged,
    };
    let line = serde_json::to_string(&event).unwrap() + "\n";
    let path = folder.join("events.jsonl");
    let mut log = OpenOptions::new().append(true).open(path).unwrap();
    log.write_all(&line.as_bytes()[..20]).unwrap();
    // Another file changes after the incomplete line; once that change is reported, the line
    // was read too.
    fs::write(
        folder.join("checkpoint.json"),
        r#"{"state":{"generation":77}}"#,
    )
    .unwrap();
    let saved = News::Event(Event::CheckpointSaved { generation: 77 });
    follower.until("a look", |news| *news == saved);
    assert_eq!(follower.recorded(), before);
    log.write_all(&line.as_bytes()[20..]).unwrap();
    follower.until_liveness(Liveness::Over);
    assert_eq!(follower.recorded(), [before, vec![event]].concat());
    assert_eq!(follower.runs(), 1);
}

#[test]
fn a_run_that_replaces_another_is_reported_from_its_start() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let mut follower = Follower::of(&folder);
    follower.until_liveness(Liveness::Over);
    let force = RunOptions {
        force: true,
        ..threads(2)
    };
    run_in(&folder, &short(&[]), 2, &force);
    follower.until("the other run", |news| match news {
        News::Run(manifest) => manifest.seed == 2,
        _ => false,
    });
    wait_until("the end", || {
        follower.told.extend(follower.watch.news.try_iter());
        follower.recorded() == log_of(&folder)
    });
}

#[test]
fn a_resumed_run_is_followed_even_if_events_were_cut_off() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let scenario = short(&["evolution.selection=random", "evolution.generation_limit=2"]);
    run_in(&folder, &scenario, 1, &threads(2));
    let mut follower = Follower::of(&folder);
    follower.until_liveness(Liveness::Over);
    resume(&folder, Some(4), &threads(2))
        .unwrap()
        .join()
        .unwrap();
    wait_until("the new end", || {
        follower.told.extend(follower.watch.news.try_iter());
        follower.recorded() == log_of(&folder)
    });
    assert_eq!(log_of(&folder).len(), 1 + 4 + 1);
}

#[test]
fn a_killed_run_is_reported_as_silent() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    let mut command = program();
    command
        .args(["run", "smoke", "--headless", "--out"])
        .arg(&folder);
    set(&mut command, common::SHORT);
    set(
        &mut command,
        &[
            "evolution.selection=random",
            "evolution.generation_limit=100000",
        ],
    );
    let mut child = command.spawn().unwrap();
    let mut follower = Follower::of(&folder);
    follower.until("a generation", |news| {
        matches!(news, News::Event(Event::Generation(_)))
    });
    follower.until_liveness(Liveness::Computing);
    child.kill().unwrap();
    child.wait().unwrap();
    follower.until_liveness(Liveness::Silent);
    let recording = Recording::read(&folder).unwrap();
    assert_eq!(recording.liveness, Liveness::Silent);
    let sign = recording.last_sign.unwrap();
    assert!(sign.error.is_none() && sign.to_string().starts_with("last alive at 2"));
    wait_until("the last event", || {
        follower.told.extend(follower.watch.news.try_iter());
        follower.recorded() == log_of(&folder)
    });
}

#[test]
fn unreadable_files_are_reported_and_following_continues() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let good = fs::read(folder.join("events.jsonl")).unwrap();
    fs::write(folder.join("pulse.json"), b"\0 rubbish").unwrap();
    fs::write(folder.join("events.jsonl"), [&good[..], b"{}\n"].concat()).unwrap();
    let mut follower = Follower::of(&folder);
    follower.until("the trouble", |news| match news {
        News::Trouble(message) => message.contains("events.jsonl: line "),
        _ => false,
    });
    // A shorter log is that of an interrupted run only if no checkpoint came after it.
    for later in ["checkpoint.json", "summary.json"] {
        fs::remove_file(folder.join(later)).unwrap();
    }
    fs::write(folder.join("events.jsonl"), &good[..good.len() / 2]).unwrap();
    follower.until("the run anew", |news| matches!(news, News::Run(_)));
    let problem = Recording::read(&parent.path().join("nothing")).unwrap_err();
    assert!(problem.to_string().contains("run.json"), "{problem}");
}

#[test]
fn a_follower_writes_nothing() {
    let parent = TempDir::new().unwrap();
    let folder = parent.path().join("run");
    run_in(&folder, &short(&[]), 1, &threads(2));
    let state = || {
        let mut files: Vec<(_, SystemTime, u64)> = fs::read_dir(&folder)
            .unwrap()
            .map(|entry| {
                let entry = entry.unwrap();
                let metadata = entry.metadata().unwrap();
                (entry.path(), metadata.modified().unwrap(), metadata.len())
            })
            .collect();
        files.sort();
        files
    };
    let before = state();
    let mut follower = Follower::of(&folder);
    follower.until_liveness(Liveness::Over);
    let recording = Recording::read(&folder).unwrap();
    let recorded = |event: &&Event| event.is_recorded();
    let recorded: Vec<_> = recording.events.iter().filter(recorded).cloned().collect();
    assert!(recorded == log_of(&folder));
    assert_eq!(recording.liveness, Liveness::Over);
    // No lock is held: another process may resume the run.
    resume(&folder, None, &threads(1)).unwrap().join().unwrap();
    let unchanged = ["events.jsonl", "lock"].map(|name| folder.join(name));
    let of = |files: &[(std::path::PathBuf, SystemTime, u64)]| {
        let kept = files.iter().filter(|(path, ..)| unchanged.contains(path));
        kept.map(|(path, _, length)| (path.clone(), *length))
            .collect::<Vec<_>>()
    };
    assert_eq!(of(&before), of(&state()));
    drop(follower);
    assert_eq!(state().len(), before.len());
}
