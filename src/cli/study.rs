//! `maxq-lab study`: many runs, and how far they are.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use clap::Subcommand;

use super::output::{self, Done, Failure, Format};
use super::progress::bar;
use super::signals::Caught;
use crate::lab::Keep;
use crate::report::{
    Arm, Base, Happening, Numbers, Pace, Plan, RunId, RunStatus, Stage, Study, StudyControls,
    carry_out, status, write_report,
};

/// Do many runs: scenarios, arms and seeds of a plan.
///
/// Every scenario, arm and seed gets a run folder of its own, DIR/SCENARIO/ARM/seed-N. Runs
/// that are done are skipped, runs that were broken off are gone on with, as many at a
/// time as there are processors, each on one thread. Ending this at any moment and starting
/// it again gives the same bytes. When a run is over, the structure of its winner is
/// evaluated anew: fresh hierarchies, fresh trials, freshly trained primitive subtasks.
///
/// Arms: evolved; random_selection (chance in the place of fitness: the control that tells
/// selection from drift); random_choice (composite subtasks choose uniformly: tells what
/// their learning adds); hand_designed (the complete hierarchy, learning only); random_search
/// (random hierarchies in the place of offspring); no_learning_inheritance (Darwinian);
/// flat (a root that chooses among all primitive subtasks). hand_designed, random_search and
/// flat get as many generations as the evolved run of the same seed.
#[derive(Debug, clap::Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "\
Examples:
  maxq-lab study thesis --out studies/thesis               the study of the thesis's claims
  maxq-lab study environment-1 environment-2 --seeds 1..10 --arms evolved,flat --out mine
  maxq-lab study status studies/thesis                     at any time
  maxq-lab study report studies/thesis                     what comes out"
)]
pub(super) struct Args {
    #[command(subcommand)]
    command: Option<Command>,

    #[command(flatten)]
    what: What,

    /// Runs to do: a number, a range of numbers, or SCENARIO/ARM/seed-N; may be repeated
    /// [default: all]. 'study plan' lists them.
    #[arg(long, value_name = "RUN")]
    only: Vec<String>,

    /// Runs at a time; 0 means one for each processor.
    #[arg(long, short, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    jobs: u16,

    /// Checkpoints kept of every run: all, none, or every N-th generation's.
    #[arg(long, value_name = "all|none|N", default_value = "none")]
    keep: Keep,

    /// Show no progress, although standard error is a terminal.
    #[arg(long)]
    headless: bool,
}

/// A study: what to run and where.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct What {
    /// A plan (a file, or 'thesis'), or scenarios (files, or names of embedded ones).
    #[arg(required = true, value_name = "PLAN|SCENARIO")]
    what: Vec<String>,

    /// Seeds for scenarios: numbers and ranges, both ends counted; a plan has its own.
    #[arg(long, value_name = "A..B", default_value = "1..10")]
    seeds: Numbers,

    /// Arms for scenarios; a plan has its own.
    #[arg(
        long,
        value_name = "ARM,...",
        value_delimiter = ',',
        default_value = "evolved,random_selection"
    )]
    arms: Vec<String>,

    /// The folder of the study.
    #[arg(long, value_name = "DIR", required = true)]
    out: Option<PathBuf>,
}

impl What {
    /// The study, its folder made if it is not there.
    pub(super) fn study(&self) -> Result<Study, Failure> {
        let folder = self.out.clone().unwrap_or_default();
        Ok(Study::create(self.plan()?, &folder)?)
    }

    fn plan(&self) -> Result<Plan, Failure> {
        if let [only] = self.what.as_slice()
            && Plan::is_plan(only)
        {
            return Ok(Plan::load(only)?);
        }
        let arms = self.arms.iter().map(|name| {
            let base = Base::find(name);
            base.map(Arm::of)
                .ok_or_else(|| format!("--arms: found {name:?}; allowed: {}", Base::names()))
        });
        let arms = arms.collect::<Result<_, _>>()?;
        Ok(Plan::of(&self.what, self.seeds.clone(), arms)?)
    }
}

#[derive(Debug, Subcommand)]
enum Command {
    Status(StatusArgs),
    Report(ReportArgs),
}

/// Tell how far the runs of a study are.
#[derive(Debug, clap::Args)]
struct StatusArgs {
    /// The folder of the study.
    dir: PathBuf,

    /// How to report.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Say what comes out: statistics, claims with verdicts, figures.
///
/// Writes DIR/report: report.md, report.json, tables as CSV, figures as SVG; prints the
/// report. It is made of the runs that are done, at any time.
#[derive(Debug, clap::Args)]
struct ReportArgs {
    /// The folder of the study.
    dir: PathBuf,

    /// How to print it.
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Carries out the command.
pub(super) fn main(args: &Args) -> Done {
    match &args.command {
        Some(Command::Status(args)) => show_status(args),
        Some(Command::Report(args)) => report(args),
        None => do_runs(args),
    }
}

fn do_runs(args: &Args) -> Done {
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

fn report(args: &ReportArgs) -> Done {
    let written = write_report(&Study::open(&args.dir)?)?;
    match args.format {
        Format::Json => output::json(&written.findings)?,
        Format::Text => output::text(&written.text)?,
    }
    let folder = args.dir.join("report");
    output::message(&format!(
        "{} files in {}",
        written.files.len(),
        folder.display()
    ));
    Ok(ExitCode::SUCCESS)
}

fn show_status(args: &StatusArgs) -> Done {
    let study = Study::open(&args.dir)?;
    let runs = status(&study);
    match args.format {
        Format::Json => output::json(&runs)?,
        Format::Text => output::text(&describe(&study, &runs))?,
    }
    Ok(ExitCode::SUCCESS)
}

fn describe(study: &Study, runs: &[RunStatus]) -> String {
    let count = |of: &[&RunStatus]| {
        let stages = Stage::ALL.iter().map(|&stage| {
            let count = of.iter().filter(|status| status.stage == stage).count();
            (count, stage.word())
        });
        let some: Vec<_> = stages
            .filter(|(count, _)| *count > 0)
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        some.join(", ")
    };
    let all: Vec<_> = runs.iter().collect();
    let mut lines = vec![format!(
        "{}: {} runs, {}",
        study.plan.name,
        runs.len(),
        count(&all)
    )];
    let mut kinds: BTreeMap<(usize, usize), Vec<&RunStatus>> = BTreeMap::new();
    for status in runs {
        kinds
            .entry((status.run.scenario, status.run.arm))
            .or_default()
            .push(status);
    }
    for members in kinds.values() {
        if let Some(first) = members.first() {
            let name = format!(
                "{}/{}",
                study.scenario(&first.run).name,
                study.arm(&first.run).name
            );
            lines.push(format!("  {name:40} {}", count(members)));
        }
    }
    let under_way = |status: &&RunStatus| {
        matches!(
            status.stage,
            Stage::Running | Stage::Interrupted | Stage::Unreadable
        )
    };
    for status in runs.iter().filter(under_way) {
        let (name, word) = (&status.name, status.stage.word());
        let detail = status.trouble.clone().unwrap_or_else(|| {
            let best = status.best_steps.last();
            let best = best.map(|best| format!(", best {best:.0} steps a trial"));
            format!(
                "generation {}{}",
                status.generations,
                best.unwrap_or_default()
            )
        });
        lines.push(format!("  {name}: {word}, {detail}"));
    }
    lines.join("\n") + "\n"
}
