//! `maxq-lab frame`: prints one frame of the dashboard.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;
use std::time::Duration;

use super::args::StartArg;
use super::dashboard::{Appearance, AppearanceArgs};
use super::output::{self, CommandResult};
use crate::dashboard::keys::Key;
use crate::dashboard::session::Exports;
use crate::dashboard::terminal::{Abilities, LARGEST_SIDE};
use crate::dashboard::{
    App, Effect, FrameFormat, Input, Mode, OffscreenDashboard, ViewContext, ViewId, render,
};
use crate::lab::inspection::Archive;
use crate::lab::{Liveness, Recording, lasting_experiment};

/// Print one frame of the dashboard of a recorded run.
///
/// For papers, bug reports and tests. The frame shows the dashboard after the given playing time
/// and keys. The same arguments give the same frame.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  maxq-lab frame runs/environment-1-seed1
  maxq-lab frame runs/environment-1-seed1 --view fitness --format svg > fitness.svg
  maxq-lab frame runs/environment-1-seed1 --generation 3 --play 2 --size 200x60 \\
           --keys 'tab tab enter'")]
pub(super) struct Args {
    /// Run folder.
    run_dir: PathBuf,

    #[command(flatten)]
    start: StartArg,

    /// Size of the frame, in columns and rows.
    #[arg(long, value_name = "WxH", default_value = "120x40")]
    size: Size,

    /// View: overview, arena, hierarchy, fitness, policy, population, status, inspector,
    /// policy-map, stepper, or compare.
    #[arg(long, value_name = "VIEW", default_value = "overview")]
    view: ViewId,

    /// Generation to show [default: the last].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    generation: Option<u64>,

    /// Seconds that the rollout plays before the keys are pressed.
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    play: f64,

    /// Keys to press, separated by spaces: characters, or names such as enter, tab, esc, up,
    /// page-down, f1, ctrl-l; press ? in the dashboard for what they do.
    /// 'e c' writes the data of the view as a CSV file into the current folder.
    #[arg(long, default_value = "")]
    keys: String,

    /// Output format.
    #[arg(long, value_name = "text|ansi|svg", default_value = "text")]
    format: FrameFormat,

    #[command(flatten)]
    appearance: AppearanceArgs,
}

/// Columns and rows of a frame.
#[derive(Clone, Copy, Debug)]
struct Size(u16, u16);

/// Longest playing time, in seconds.
const LONGEST: f64 = 3600.0;
/// Time step of the rollout.
const TICK: Duration = Duration::from_millis(100);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|n| (1..=LARGEST_SIDE).contains(n));
        let numbers = text.split_once('x');
        let size = numbers.and_then(|(w, h)| Some(Self(number(w)?, number(h)?)));
        size.ok_or_else(|| {
            format!("found {text:?}; allowed: COLUMNSxROWS, each from 1 to {LARGEST_SIDE}, such as 80x24")
        })
    }
}

/// Runs `maxq-lab frame`.
pub(super) fn main(args: &Args) -> CommandResult {
    if !(0.0..=LONGEST).contains(&args.play) {
        let found = args.play;
        return Err(format!("--play: found {found}; allowed: 0 to {LONGEST} seconds").into());
    }
    let keys: Result<Vec<Key>, _> = args.keys.split_ascii_whitespace().map(str::parse).collect();
    let keys = keys.map_err(|error| format!("--keys: {error}"))?;
    let Appearance {
        look,
        keys: key_map,
        ..
    } = args.appearance.load(Abilities::ALL)?;
    let recording = Recording::read(&args.run_dir)?;
    let lived = recording.generations();
    if let Some(found) = args.generation.filter(|found| !(1..=lived).contains(found)) {
        return Err(format!("--generation: found {found}; allowed: 1 to {lived}").into());
    }
    let manifest = recording.manifest;
    let experiment = lasting_experiment(manifest.scenario, manifest.seed)?;
    let folder = args.run_dir.display().to_string();
    let start = args.start.read(experiment)?;
    let app = App::new(ViewContext::new(
        experiment,
        folder,
        Mode::Replay,
        look,
        key_map,
    ))
    .starting_at(start);
    let archive = Archive::new(experiment, &args.run_dir, None);
    let bytes = archive.folder_bytes();
    let mut dashboard = OffscreenDashboard::new(app, archive);
    dashboard.update(Input::FolderBytes(bytes));
    let Size(columns, rows) = args.size;
    dashboard.update(Input::Resize(columns, rows));
    for event in recording.events {
        dashboard.update(Input::Event(Box::new(event)));
    }
    if recording.liveness != Liveness::Computing {
        dashboard.update(Input::Closed);
    }
    if let Some(sign) = recording.last_sign {
        dashboard.update(Input::LastSign(sign));
    }
    dashboard.open(args.view);
    if let Some(generation) = args.generation {
        dashboard.travel_to(generation);
    }
    for _ in 0..(args.play / TICK.as_secs_f64()).round() as u64 {
        dashboard.update(Input::Tick(TICK));
    }
    let here = Path::new(".");
    let mut exports = Exports::default();
    for key in keys {
        for effect in dashboard.update(Input::Key(key)) {
            match effect {
                Effect::Export(export) => {
                    let keys = &dashboard.app().context().keys;
                    let said = exports.write(&export, here, keys);
                    output::message(&said.map_err(|error| format!("{}: {error}", export.name))?);
                }
                Effect::RemoveExport => output::message(&exports.remove_last()),
                _ => {}
            }
        }
    }
    let frame = render(&dashboard.app().frame(), args.format);
    output::raw(frame.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}
