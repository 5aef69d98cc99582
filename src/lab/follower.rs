//! What has changed in a run folder since the last look.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Deserialize;

use super::checkpoint::MAX_CHECKPOINT_BYTES;
use super::event::Event;
use super::folder::RunFolder;
use super::log::{LogError, read_event};
use super::manifest::{Manifest, host_name};
use super::news::{Liveness, News, Recording};
use super::pulse::{BEAT, Beat, PULSE_FILE};
use super::run_error::RunError;
use crate::files::{FileError, Stamp, read_bytes};

/// A pulse that stays the same for this long has stopped: more than ten beats, and
/// the minute for which some shares cache what they know of a file is the exception.
const SILENCE: Duration = BEAT.saturating_mul(15);

/// Largest pulse that is read, in bytes.
const MAX_PULSE_BYTES: u64 = 1 << 16;

/// Looks at which something is found unreadable before it is told: a share may show a
/// file before its content.
const PATIENCE: u32 = 5;

/// Looks at a run folder again and again, without taking a lock or leaving a trace, and reads
/// what is new there.
#[derive(Debug)]
pub struct Follower {
    folder: PathBuf,
    run: Option<Stamped<Manifest>>,
    log: LogReader,
    checkpoint: Option<Stamp>,
    beat: Option<(Beat, Instant)>,
    liveness: Option<Liveness>,
    unreadable: u32,
}

#[derive(Debug)]
struct Stamped<T> {
    stamp: Stamp,
    value: T,
}

/// How far the log was read.
#[derive(Debug, Default)]
struct LogReader {
    stamp: Option<Stamp>,
    lines: usize,
    bytes: u64,
    last: Vec<u8>,
    over: bool,
}

impl Follower {
    /// Of the run in a folder, which need not be there yet.
    #[must_use]
    pub fn of(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            run: None,
            log: LogReader::default(),
            checkpoint: None,
            beat: None,
            liveness: None,
            unreadable: 0,
        }
    }

    /// What is new since the last look.
    pub(super) fn look(&mut self, now: Instant) -> Vec<News> {
        let mut news = Vec::new();
        match self.try_look(now, &mut news) {
            Ok(()) => self.unreadable = 0,
            Err(error) => {
                self.unreadable += 1;
                if self.unreadable == PATIENCE {
                    news.push(News::Trouble(error.to_string()));
                }
            }
        }
        news
    }

    /// The folder as it is.
    pub(super) fn read(mut self) -> Result<Recording, RunError> {
        let mut news = Vec::new();
        self.try_look(Instant::now(), &mut news)?;
        let events = news.into_iter().filter_map(|news| match news {
            News::Event(event) => Some(event),
            _ => None,
        });
        let events = events.collect();
        match self.run {
            Some(Stamped { value, .. }) => Ok(Recording {
                manifest: value,
                events,
                liveness: self.liveness.unwrap_or(Liveness::Stopped),
            }),
            // The error that tells what is missing.
            None => Ok(Recording {
                manifest: RunFolder::read_manifest(&self.folder)?,
                events,
                liveness: Liveness::Absent,
            }),
        }
    }

    /// Adds what is new since the last look; what cannot be read, for the moment at least, is
    /// an error, and looked at again the next time.
    ///
    /// # Errors
    /// When `run.json` or the log cannot be read.
    pub fn try_look(&mut self, now: Instant, news: &mut Vec<News>) -> Result<(), RunError> {
        let Some(stamp) = self.stamp("run.json") else {
            if self.run.take().is_some() {
                self.forget();
            }
            self.tell_life(Liveness::Absent, news);
            return Ok(());
        };
        if self.run.as_ref().is_none_or(|run| run.stamp != stamp) {
            let value = RunFolder::read_manifest(&self.folder)?;
            let same = self.run.take().is_some_and(|run| {
                run.value.started == value.started && run.value.scenario == value.scenario
            });
            if !same {
                self.forget();
                news.push(News::Run(Box::new(value.clone())));
            }
            self.run = Some(Stamped { stamp, value });
        }
        let read = self.look_at_log(news);
        self.look_at_checkpoint(news);
        self.look_at_pulse(now, news);
        read
    }

    /// What was told is void.
    fn forget(&mut self) {
        self.log = LogReader::default();
        self.checkpoint = None;
        self.beat = None;
    }

    fn look_at_log(&mut self, news: &mut Vec<News>) -> Result<(), RunError> {
        let path = self.folder.join("events.jsonl");
        let stamp = self.stamp("events.jsonl");
        if stamp == self.log.stamp {
            return Ok(());
        }
        let Some(run) = &self.run else {
            return Ok(());
        };
        let in_log = |error: LogError| FileError::new(&path, error);
        let file = match stamp {
            Some(_) => Some(File::open(&path).map_err(|error| in_log(error.into()))?),
            None => None,
        };
        let mut reader = file.map(BufReader::new);
        let goes_on = match &mut reader {
            Some(reader) => self.log.goes_on_in(reader).map_err(in_log)?,
            None => false,
        };
        if !goes_on {
            // A resumed run cut off what was not in its checkpoint.
            news.push(News::Run(Box::new(run.value.clone())));
            self.forget();
        }
        if let Some(mut reader) = reader {
            self.log.read_on(&mut reader, news).map_err(in_log)?;
        }
        self.log.stamp = stamp;
        Ok(())
    }

    fn look_at_checkpoint(&mut self, news: &mut Vec<News>) {
        #[derive(Deserialize)]
        struct File {
            state: State,
        }
        #[derive(Deserialize)]
        struct State {
            generation: u64,
        }
        let stamp = self.stamp("checkpoint.json");
        if stamp == self.checkpoint {
            return;
        }
        self.checkpoint = stamp;
        let bytes = read_bytes(&self.folder.join("checkpoint.json"), MAX_CHECKPOINT_BYTES);
        // Whoever resumes the run is told what is wrong with a checkpoint; a follower
        // needs none.
        let file = bytes
            .ok()
            .and_then(|bytes| serde_json::from_slice(&bytes).ok());
        if let Some(File { state }) = file {
            let generation = state.generation;
            news.push(News::Event(Event::CheckpointSaved { generation }));
        }
    }

    fn look_at_pulse(&mut self, now: Instant, news: &mut Vec<News>) {
        let path = self.folder.join(PULSE_FILE);
        let bytes = read_bytes(&path, MAX_PULSE_BYTES).ok();
        let found: Option<Beat> = bytes.and_then(|bytes| serde_json::from_slice(&bytes).ok());
        let Some(found) = found else {
            self.beat = None;
            let life = match self.log.over {
                true => Liveness::Over,
                false => Liveness::Stopped,
            };
            self.tell_life(life, news);
            return;
        };
        match &mut self.beat {
            Some((beat, since)) if *beat == found => {
                if is_dead(&found) || now.duration_since(*since) >= SILENCE {
                    self.tell_life(Liveness::Silent, news);
                }
            }
            known => {
                let before = known.replace((found.clone(), now)).map(|(beat, _)| beat);
                let dead = is_dead(&found);
                tell_beat(before.as_ref(), found, news);
                self.tell_life(
                    if dead {
                        Liveness::Silent
                    } else {
                        Liveness::Computing
                    },
                    news,
                );
            }
        }
    }

    fn tell_life(&mut self, life: Liveness, news: &mut Vec<News>) {
        if self.liveness.replace(life) != Some(life) {
            news.push(News::Liveness(life));
        }
    }

    fn stamp(&self, name: &str) -> Option<Stamp> {
        Stamp::of(&self.folder.join(name))
    }
}

impl LogReader {
    /// Whether what was read is still there: its last line is where it was.
    fn goes_on_in(&self, file: &mut (impl Read + Seek)) -> Result<bool, LogError> {
        let begin = self.bytes - self.last.len() as u64;
        file.seek(SeekFrom::Start(begin))?;
        let mut found = Vec::new();
        file.take(self.last.len() as u64).read_to_end(&mut found)?;
        Ok(found == self.last)
    }

    fn read_on(
        &mut self,
        reader: &mut (impl std::io::BufRead + Seek),
        news: &mut Vec<News>,
    ) -> Result<(), LogError> {
        reader.seek(SeekFrom::Start(self.bytes))?;
        let mut line = Vec::new();
        while let Some(event) = read_event(reader, &mut line, self.lines + 1)? {
            self.lines += 1;
            self.bytes += line.len() as u64;
            std::mem::swap(&mut self.last, &mut line);
            self.over = matches!(event, Event::Ended { .. });
            news.push(News::Event(event));
        }
        Ok(())
    }
}

/// Tells as events what a beat says that the one before did not.
fn tell_beat(before: Option<&Beat>, beat: Beat, news: &mut Vec<News>) {
    use super::controls::Activity;
    let was_paused = before.is_some_and(|beat| beat.activity == Activity::Paused);
    let is_paused = beat.activity == Activity::Paused;
    match (was_paused, is_paused) {
        (false, true) => news.push(News::Event(Event::Paused)),
        (true, false) => news.push(News::Event(Event::Resumed)),
        _ => {}
    }
    let progress = beat.progress.filter(Event::is_progress);
    news.extend(progress.map(News::Event));
}

/// Whether the process is known to be no more: it ran on this machine and is not there.
fn is_dead(beat: &Beat) -> bool {
    if beat.host == host_name() {
        use rustix::io::Errno;
        use rustix::process::{Pid, test_kill_process};
        let process = i32::try_from(beat.process).ok().and_then(Pid::from_raw);
        return process
            .is_some_and(|process| test_kill_process(process).err() == Some(Errno::SRCH));
    }
    false
}

impl Recording {
    /// Reads the run in a folder. A last event without its end is dropped.
    ///
    /// # Errors
    /// When the folder holds no run, or its log cannot be read.
    pub fn read(folder: &Path) -> Result<Self, RunError> {
        Follower::of(folder).read()
    }
}
