//! The runs of a study, done by this process.

use std::num::NonZeroUsize;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::Args;
use crate::cli::output::{self, Done, Failure};
use crate::cli::progress::bar;
use crate::cli::signals::Caught;
use crate::report::{Happening, Pace, RunId, Stage, Study, StudyControls, carry_out, status};

/// Carries out `study`.
pub(super) fn main(args: &Args) -> Done {
    let study = args.what.study()?;
    let runs = wanted(&study, &args.only)?;
    let jobs = jobs(args.jobs);
    let controls = Arc::new(StudyControls::default());
    let stopping = Arc::clone(&controls);
    let ended = Caught::now()?.then(move || stopping.stop())?;
    let show = Show::new(&study, &runs, jobs, !args.headless);
    carry_out(&study, &runs, jobs, args.keep, &controls, |happening| {
        show.tell(happening)
    });
    let failed = show.finish();
    let all = runs.len();
    let done = status(&study)
        .iter()
        .filter(|status| status.stage == Stage::Done && runs.contains(&status.run))
        .count();
    output::text(&format!(
        "{done} of {all} runs done in {}\n",
        study.folder.display()
    ))?;
    if let Some(code) = ended.exit_code().filter(|_| done < all) {
        output::message("stopped; the same command goes on");
        return Ok(ExitCode::from(code));
    }
    if failed == 0 && done < all {
        output::message(
            "the others are done by another process; 'study status' tells how far it is",
        );
    }
    match failed {
        0 => Ok(ExitCode::SUCCESS),
        _ => Ok(ExitCode::FAILURE),
    }
}

fn wanted(study: &Study, only: &[String]) -> Result<Vec<RunId>, Failure> {
    if only.is_empty() {
        return Ok(study.runs());
    }
    let mut runs = Vec::new();
    for name in only {
        runs.extend(study.find(name)?);
    }
    runs.sort_by_key(|run| run.number);
    runs.dedup();
    Ok(runs)
}

fn jobs(asked: u16) -> NonZeroUsize {
    let all = || std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    NonZeroUsize::new(usize::from(asked)).unwrap_or_else(all)
}

/// Shows what happens.
struct Show<'s> {
    study: &'s Study,
    jobs: usize,
    bar: indicatif::ProgressBar,
    state: Mutex<ShowState>,
}

struct ShowState {
    pace: Pace,
    failed: usize,
}

impl<'s> Show<'s> {
    fn new(study: &'s Study, runs: &[RunId], jobs: NonZeroUsize, shown: bool) -> Self {
        let bar = bar(runs.len() as u64, shown);
        if let Ok(style) =
            indicatif::ProgressStyle::with_template("{bar:20} {pos}/{len} {elapsed}  {wide_msg}")
        {
            bar.set_style(style);
        }
        Self {
            study,
            jobs: jobs.get(),
            bar,
            state: Mutex::new(ShowState {
                pace: Pace::of(runs),
                failed: 0,
            }),
        }
    }

    fn tell(&self, happening: Happening) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let (run, took) = match &happening {
            Happening::Begun(_) => return,
            Happening::Done { run, took, .. } => (run, Some(*took)),
            Happening::Elsewhere(run) => (run, None),
            Happening::Failed { run, error } => {
                state.failed += 1;
                let message = format!("error: {}: {error}", self.study.name(run));
                self.bar.suspend(|| output::message(&message));
                (run, None)
            }
        };
        state.pace.note(run, took);
        self.bar.inc(1);
        let left = state.pace.left(self.jobs).map(|left| {
            let whole = Duration::from_secs(left.as_secs());
            format!("about {} left, ", humantime::format_duration(whole))
        });
        let left = left.unwrap_or_default();
        self.bar
            .set_message(format!("{left}last: {}", self.study.name(run)));
    }

    /// Ends the display and says how many runs failed.
    fn finish(self) -> usize {
        self.bar.finish_and_clear();
        self.state
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner)
            .failed
    }
}
