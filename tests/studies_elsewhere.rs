//! A study that is spread over processes and machines equals, byte for byte, the study that one
//! process does: with GNU parallel on the lines of `study commands`, with Slurm on the script of
//! `study slurm`, and with `study merge` on parts in any order. A preempted task resumes where it
//! was.
//!
//! Why it matters: hundreds of runs are done where there are many processors, and the result must
//! not depend on which of them did what. These tests use the real programs, because quoting,
//! signals and requeueing are what breaks. `.ci/run` installs the programs; if they are missing,
//! the tests say so and pass.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::fs;
use std::io::Write;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use common::{SHORT, output, program, stderr, stdout};

/// Many trials a generation.
const LONG: [&str; 1] = ["evolution.trials_per_generation=400"];

/// Writes a plan of six short runs or, if `long`, of two runs whose generations take some tenths of
/// a second on a fast machine, so that a signal after the first generation interrupts them.
fn plan_in(folder: &Path, long: bool) -> PathBuf {
    let settings = if long { &LONG[..] } else { SHORT };
    let quoted: Vec<_> = settings.iter().map(|set| format!("{set:?}")).collect();
    let settings = quoted.join(",");
    let arm =
        |base: &str| format!(r#"{{"name":"{base}","base":"{base}","settings":[{settings}]}}"#);
    let arms = if long {
        arm("random_selection")
    } else {
        [arm("evolved"), arm("random_search"), arm("flat")].join(",")
    };
    let plan = format!(
        r#"{{"format":1,"name":"parts","scenarios":["smoke"],"seeds":"1..2","arms":[{arms}],
            "reevaluation":{{"warmup":1,"trials":1,"repeats":2,"banks":1}}}}"#
    );
    let file = folder.join("plan.json");
    fs::write(&file, plan).unwrap();
    file
}

fn study(plan: &Path, out: &Path) -> Command {
    let mut command = program();
    command.arg("study").arg(plan).arg("--out").arg(out);
    command
}

fn succeeds(command: &mut Command) -> String {
    let done = output(command);
    assert!(
        done.status.success(),
        "{command:?}: {}{}",
        stdout(&done),
        stderr(&done)
    );
    stdout(&done)
}

/// Returns whether a file depends on the plan alone. `run.json`, `summary.json` and locks say where
/// and when a run was done.
fn depends_on_the_plan_alone(name: &str) -> bool {
    !["run.json", "summary.json", "lock"].contains(&name)
}

fn assert_same(one: &Path, other: &Path) {
    common::assert_same_files(one, other, depends_on_the_plan_alone);
}

/// Writes a line even if the test passes; the output of `eprintln` would be hidden.
fn announce(words: &str) {
    std::io::stderr()
        .write_all(format!("{words}\n").as_bytes())
        .unwrap();
}

fn missing(programs: &[&str]) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let found =
        |name: &&str| std::env::split_paths(&path).any(|folder| folder.join(name).is_file());
    let missing: Vec<_> = programs.iter().filter(|name| !found(name)).collect();
    if !missing.is_empty() {
        announce(&format!("skipped: not installed: {missing:?}"));
    }
    !missing.is_empty()
}

#[test]
fn parts_are_merged_in_any_order() {
    let parent = tempfile::tempdir().unwrap();
    let plan = plan_in(parent.path(), false);
    let at = |name: &str| parent.path().join(name);
    succeeds(&mut study(&plan, &at("whole")));
    succeeds(study(&plan, &at("a")).args(["--only", "1..3"]));
    succeeds(study(&plan, &at("b")).args(["--only", "3..5"]));
    succeeds(study(&plan, &at("c")).args(["--only", "smoke/flat/seed-2", "--jobs", "1"]));
    let merge = |parts: [&str; 3], out: &str| {
        let parts = parts.map(at);
        succeeds(
            program()
                .args(["study", "merge"])
                .args(parts)
                .arg("--out")
                .arg(at(out)),
        )
    };
    assert!(merge(["a", "b", "c"], "one").contains("a study of 6 runs"));
    merge(["c", "b", "a"], "other");
    for out in ["whole", "one", "other"] {
        succeeds(program().args(["study", "report"]).arg(at(out)));
    }
    assert_same(&at("whole"), &at("one"));
    assert_same(&at("one"), &at("other"));
    // The copied `run.json` is the same, whatever the order.
    let origin = |out: &str| fs::read(at(out).join("smoke/evolved/seed-1/run.json")).unwrap();
    assert_eq!(origin("one"), origin("other"));

    // The merged study may be one of the parts; a run that differs is refused.
    succeeds(
        program()
            .args(["study", "merge"])
            .arg(at("a"))
            .arg("--out")
            .arg(at("b")),
    );
    for (file, says) in [
        ("evaluation.json", "evaluation.json is not the same"),
        ("events.jsonl", "events.jsonl: found CRC-32"),
    ] {
        let path = at("a").join("smoke/evolved/seed-1").join(file);
        let whole = fs::read_to_string(&path).unwrap();
        fs::write(&path, whole.replacen("\"steps\":", "\"steps\": ", 1)).unwrap();
        let refused = output(
            program()
                .args(["study", "merge"])
                .arg(at("a"))
                .arg("--out")
                .arg(at("one")),
        );
        assert_eq!(refused.status.code(), Some(1));
        assert!(stderr(&refused).contains(says), "{}", stderr(&refused));
        fs::write(&path, whole).unwrap();
    }
}

#[test]
fn parts_with_other_seeds_are_merged_and_other_differences_are_told() {
    let parent = tempfile::tempdir().unwrap();
    let plan = plan_in(parent.path(), false);
    let at = |name: &str| parent.path().join(name);
    let with = |name: &str, from: &str, to: &str| {
        let file = at(name);
        fs::write(&file, fs::read_to_string(&plan).unwrap().replace(from, to)).unwrap();
        file
    };
    let both = with("both.json", "1..2", "1..2");
    succeeds(&mut study(&both, &at("whole")));
    succeeds(&mut study(&with("one.json", "1..2", "1"), &at("a")));
    succeeds(&mut study(&with("two.json", "1..2", "2"), &at("b")));
    let merge = |parts: [&str; 2], out: &str| {
        let mut command = program();
        command.args(["study", "merge"]).args(parts.map(at));
        command.arg("--out").arg(at(out));
        command
    };
    succeeds(&mut merge(["a", "b"], "ab"));
    succeeds(&mut merge(["b", "a"], "ba"));
    assert_same(&at("whole"), &at("ab"));
    assert_same(&at("whole"), &at("ba"));
    // The merged study may be a part, which then gets the seeds of the others.
    succeeds(&mut merge(["a", "b"], "b"));
    assert_same(&at("whole"), &at("b"));

    let other = with("other.json", "\"warmup\":1", "\"warmup\":3");
    succeeds(study(&other, &at("c")).args(["--only", "1"]));
    let refused = output(&mut merge(["a", "c"], "ac"));
    let said = stderr(&refused);
    assert!(
        said.contains("reevaluation.warmup is 3 there, 1 here; allowed"),
        "{said}"
    );
    assert!(!at("ac").exists());
}

#[test]
fn gnu_parallel_does_the_lines_of_the_plan() {
    if missing(&["parallel"]) {
        return;
    }
    let parent = tempfile::tempdir().unwrap();
    let plan = plan_in(parent.path(), false);
    // The shell would split this name.
    let out = parent.path().join("the study's");
    succeeds(&mut study(&plan, &parent.path().join("whole")));
    let binary = env!("CARGO_BIN_EXE_maxq-lab");
    let mut command = program();
    command
        .args(["study", "commands"])
        .arg(&plan)
        .arg("--out")
        .arg(&out);
    let lines = succeeds(command.args(["--program", binary]));
    assert_eq!(lines.lines().count(), 6);
    let file = parent.path().join("runs.txt");
    fs::write(&file, &lines).unwrap();
    let hosts = parent.path().join("hosts.txt");
    fs::write(&hosts, "2/:\n").unwrap();
    let log = parent.path().join("jobs.log");
    let parallel = || {
        let mut command = Command::new("parallel");
        command
            .arg("--sshloginfile")
            .arg(&hosts)
            .arg("--joblog")
            .arg(&log);
        command.arg("--resume-failed").arg("-a").arg(&file);
        command.stdin(Stdio::null()).env("HOME", parent.path());
        succeeds(&mut command)
    };
    assert_eq!(
        parallel()
            .lines()
            .filter(|line| line.starts_with("1 of 1 runs done"))
            .count(),
        6
    );
    assert_eq!(parallel(), "", "nothing was left to do");
    assert_same(&parent.path().join("whole"), &out);
}

/// A Slurm cluster of one node on this machine, with its files in a folder.
struct Slurm {
    folder: PathBuf,
    daemons: Vec<Child>,
}

impl Slurm {
    fn start(folder: &Path) -> Self {
        let mut slurm = Self {
            folder: folder.to_owned(),
            daemons: Vec::new(),
        };
        for name in ["state", "spool"] {
            fs::create_dir(folder.join(name)).unwrap();
        }
        let key = folder.join("munge.key");
        fs::write(&key, [7_u8; 128]).unwrap();
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&key, fs::Permissions::from_mode(0o600)).unwrap();
        fs::write(folder.join("slurm.conf"), slurm.configuration()).unwrap();
        let file = |name: &str| folder.join(name).display().to_string();
        slurm.daemon(
            "munged",
            &[
                "--foreground",
                "--force",
                &format!("--key-file={}", file("munge.key")),
                &format!("--socket={}", file("munge.socket")),
                &format!("--pid-file={}", file("munged.pid")),
                &format!("--log-file={}", file("munged.log")),
                &format!("--seed-file={}", file("munged.seed")),
            ],
        );
        wait("munged", || folder.join("munge.socket").exists());
        slurm.daemon("slurmctld", &["-D"]);
        slurm.daemon("slurmd", &["-D", "-N", "localhost"]);
        wait("the node", || {
            slurm.says("sinfo", &["-h", "-o", "%T"]).trim() == "idle"
        });
        slurm
    }

    fn configuration(&self) -> String {
        // Two ports that are free at the moment.
        let listeners = [0, 0].map(|_| TcpListener::bind("127.0.0.1:0").unwrap());
        let [controller, node] = listeners.map(|listener| listener.local_addr().unwrap().port());
        let host = rustix::system::uname()
            .nodename()
            .to_str()
            .unwrap()
            .to_owned();
        let host = host.split('.').next().unwrap();
        let folder = self.folder.display();
        format!(
            "ClusterName=test\n\
             SlurmctldHost={host}(127.0.0.1)\n\
             SlurmctldPort={controller}\n\
             SlurmdPort={node}\n\
             AuthType=auth/munge\n\
             AuthInfo=socket={folder}/munge.socket\n\
             CredType=cred/munge\n\
             SlurmUser=root\n\
             ProctrackType=proctrack/linuxproc\n\
             TaskPlugin=task/none\n\
             SelectType=select/cons_tres\n\
             SelectTypeParameters=CR_CPU\n\
             MpiDefault=none\n\
             MailProg=/bin/true\n\
             ReturnToService=2\n\
             StateSaveLocation={folder}/state\n\
             SlurmdSpoolDir={folder}/spool\n\
             SlurmctldPidFile={folder}/slurmctld.pid\n\
             SlurmdPidFile={folder}/slurmd.pid\n\
             SlurmctldLogFile={folder}/slurmctld.log\n\
             SlurmdLogFile={folder}/slurmd.log\n\
             NodeName=localhost NodeAddr=127.0.0.1 CPUs=2\n\
             PartitionName=all Nodes=localhost Default=YES MaxTime=INFINITE State=UP\n"
        )
    }

    fn daemon(&mut self, name: &str, arguments: &[&str]) {
        let mut command = Command::new(name);
        command
            .args(arguments)
            .env("SLURM_CONF", self.folder.join("slurm.conf"));
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        self.daemons.push(command.spawn().unwrap());
    }

    fn command(&self, name: &str) -> Command {
        let mut command = Command::new(name);
        command
            .env("SLURM_CONF", self.folder.join("slurm.conf"))
            .current_dir(&self.folder);
        command.stdin(Stdio::null());
        command
    }

    fn says(&self, name: &str, arguments: &[&str]) -> String {
        stdout(&output(self.command(name).args(arguments)))
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for daemon in self.daemons.iter_mut().rev() {
            let _ = Command::new("kill").arg(daemon.id().to_string()).status();
            let begun = Instant::now();
            while daemon.try_wait().is_ok_and(|ended| ended.is_none()) {
                if begun.elapsed() > Duration::from_secs(5) {
                    let _ = daemon.kill();
                }
                sleep(Duration::from_millis(20));
            }
        }
    }
}

fn wait(what: &str, mut holds: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !holds() {
        assert!(
            begun.elapsed() < Duration::from_secs(240),
            "waiting for {what}"
        );
        sleep(Duration::from_millis(50));
    }
}

#[test]
fn slurm_does_the_array_and_resumes_after_preemption() {
    if missing(&["munged", "slurmctld", "slurmd", "sbatch"]) {
        return;
    }
    let root = fs::metadata("/proc/self").map(|data| std::os::unix::fs::MetadataExt::uid(&data));
    if root.unwrap_or(1) != 0 {
        announce("skipped: only root can start a Slurm cluster");
        return;
    }
    let parent = tempfile::tempdir().unwrap();
    let slurm = Slurm::start(parent.path());
    let plan = plan_in(parent.path(), true);
    let [whole, out] = ["whole", "out"].map(|name| parent.path().join(name));
    let mut script = program();
    script
        .args(["study", "slurm"])
        .arg(&plan)
        .arg("--out")
        .arg(&out);
    let script = succeeds(script.args(["--program", env!("CARGO_BIN_EXE_maxq-lab")]));
    let file = parent.path().join("study.sbatch");
    fs::write(&file, script).unwrap();
    let job = succeeds(slurm.command("sbatch").arg("--parsable").arg(&file));
    let job = job.trim();
    let first = out.join("smoke/random_selection/seed-1");
    wait("the first generation", || {
        common::lines(&first.join("events.jsonl")) >= 2
    });
    slurm.says(
        "scancel",
        &["--batch", "--signal=TERM", &format!("{job}_1")],
    );
    let queue = || slurm.says("squeue", &["-h", "-o", "%T %i"]);
    wait("the end of the job", || {
        // Slurm delays a requeued task; the test need not wait for it.
        for line in queue().lines().filter(|line| line.starts_with("PENDING")) {
            let id = line.split(' ').next_back().unwrap_or_default();
            slurm.says(
                "scontrol",
                &["update", &format!("JobId={id}"), "StartTime=now"],
            );
        }
        queue().is_empty()
    });
    succeeds(&mut study(&plan, &whole));
    assert_same(&whole, &out);
    let manifest = fs::read_to_string(first.join("run.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&manifest).unwrap();
    assert_eq!(
        manifest["resumed"].as_array().unwrap().len(),
        1,
        "the run was resumed"
    );
}
