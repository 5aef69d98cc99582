//! Reads what is new in a run folder.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Deserialize;

use super::checkpoint::CHECKPOINT_LIMITS;
use super::event::Event;
use super::folder::{CHECKPOINT, EVENTS, MANIFEST, RunFolder};
use super::integrity::{EventOrder, check_log};
use super::last_sign::{ERROR, LastSign, MAX_PULSE_BYTES};
use super::lock::is_dead;
use super::log::{LogError, read_event};
use super::manifest::Manifest;
use super::news::{Liveness, News, Recording};
use super::pulse::{BEAT, Beat, PULSE_FILE};
use super::run_error::RunError;
use crate::files::{FileError, Stamp, read_bytes};

/// Time after which an unchanged pulse counts as stopped. Most network file systems show a change
/// much sooner; the few that cache files for a minute make a run look silent for a while.
const SILENCE: Duration = BEAT.saturating_mul(15);

/// Failed reads in a row before trouble is reported: a network file system may show a file
/// before its content.
const PATIENCE: u32 = 5;

/// Reads a run folder again and again and reports what is new. It takes no lock and writes
/// nothing.
#[derive(Debug)]
pub struct Follower {
    folder: PathBuf,
    run: Option<Stamped<Manifest>>,
    log: LogReader,
    checkpoint: Option<Stamp>,
    beat: Option<(Beat, Instant)>,
    liveness: Option<Liveness>,
    /// The version of `error.json` that was read last.
    error: Option<Stamp>,
    unreadable: u32,
}

#[derive(Debug)]
struct Stamped<T> {
    stamp: Stamp,
    value: T,
}

/// The position up to which the log was read.
#[derive(Debug, Default)]
struct LogReader {
    stamp: Option<Stamp>,
    lines: usize,
    bytes: u64,
    last: Vec<u8>,
    order: Option<EventOrder>,
}

impl Follower {
    /// Returns a follower of the run in a folder, which need not exist yet.
    #[must_use]
    pub fn of(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            run: None,
            log: LogReader::default(),
            checkpoint: None,
            beat: None,
            liveness: None,
            error: None,
            unreadable: 0,
        }
    }

    /// Returns what is new since the last call.
    pub(super) fn news(&mut self, now: Instant) -> Vec<News> {
        let mut news = Vec::new();
        match self.update(now, &mut news) {
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

    /// Returns the present content of the folder.
    pub(super) fn read(mut self) -> Result<Recording, RunError> {
        let mut news = Vec::new();
        self.update(Instant::now(), &mut news)?;
        let (mut events, mut last_sign) = (Vec::new(), None);
        for news in news {
            match news {
                News::Event(event) => events.push(event),
                News::LastSign(sign) => last_sign = Some(sign),
                _ => {}
            }
        }
        match self.run {
            Some(Stamped { value, .. }) => Ok(Recording {
                manifest: value,
                events,
                liveness: self.liveness.unwrap_or(Liveness::Stopped),
                last_sign,
            }),
            // Fails, and says what is missing.
            None => Ok(Recording {
                manifest: RunFolder::read_manifest(&self.folder)?,
                events,
                liveness: Liveness::Absent,
                last_sign,
            }),
        }
    }

    /// Adds what is new since the last call to `news`. What cannot be read now is tried again at
    /// the next call.
    ///
    /// # Errors
    /// When `run.json` or the log cannot be read, or the log is damaged or of another run.
    pub fn update(&mut self, now: Instant, news: &mut Vec<News>) -> Result<(), RunError> {
        let Some(stamp) = self.stamp(MANIFEST) else {
            if self.run.take().is_some() {
                self.forget();
            }
            self.set_liveness(Liveness::Absent, news);
            return Ok(());
        };
        if self.run.as_ref().is_none_or(|run| run.stamp != stamp) {
            let value = RunFolder::read_manifest(&self.folder)?;
            let is_same = self.run.as_ref().is_some_and(|run| {
                let of = |run: &Manifest| (run.started.clone(), run.seed, run.scenario.clone());
                of(&run.value) == of(&value)
            });
            if !is_same {
                self.run = None;
                check_log(&self.folder, &value)?;
                self.forget();
                news.push(News::Run(Box::new(value.clone())));
            }
            self.run = Some(Stamped { stamp, value });
        }
        let read = self.read_log(news);
        self.read_checkpoint(news);
        self.read_pulse(now, news);
        self.read_last_sign(news);
        read
    }

    /// Forgets what was read, so that all is reported again.
    fn forget(&mut self) {
        self.log = LogReader::default();
        self.checkpoint = None;
        self.beat = None;
    }

    fn read_log(&mut self, news: &mut Vec<News>) -> Result<(), RunError> {
        let path = self.folder.join(EVENTS);
        let stamp = self.stamp(EVENTS);
        if stamp == self.log.stamp {
            return Ok(());
        }
        let Some(run) = &self.run else {
            return Ok(());
        };
        let order = EventOrder::of(&run.value);
        let in_log = |error: LogError| FileError::new(&path, error);
        let file = match stamp {
            Some(_) => Some(File::open(&path).map_err(|error| in_log(error.into()))?),
            None => None,
        };
        let mut reader = file.map(BufReader::new);
        let is_same = match &mut reader {
            Some(reader) => self.log.is_in(reader).map_err(in_log)?,
            None => false,
        };
        if !is_same {
            // A resumed run has cut off the events after its checkpoint.
            news.push(News::Run(Box::new(run.value.clone())));
            self.forget();
        }
        if let Some(mut reader) = reader {
            self.log
                .read_further(&mut reader, order, news)
                .map_err(in_log)?;
        }
        self.log.stamp = stamp;
        Ok(())
    }

    fn read_checkpoint(&mut self, news: &mut Vec<News>) {
        #[derive(Deserialize)]
        struct File {
            state: State,
        }
        #[derive(Deserialize)]
        struct State {
            generation: u64,
        }
        let stamp = self.stamp(CHECKPOINT);
        if stamp == self.checkpoint {
            return;
        }
        self.checkpoint = stamp;
        let bytes = read_bytes(&self.folder.join(CHECKPOINT), CHECKPOINT_LIMITS.bytes);
        // The process replaces the checkpoint again and again. One that cannot be read here is no
        // trouble: `check_log` reports a damaged one when the run is first seen, and so does resuming.
        let file = bytes
            .ok()
            .and_then(|bytes| serde_json::from_slice(&bytes).ok());
        if let Some(File { state }) = file {
            let generation = state.generation;
            news.push(News::Event(Event::CheckpointSaved { generation }));
        }
    }

    fn read_pulse(&mut self, now: Instant, news: &mut Vec<News>) {
        let path = self.folder.join(PULSE_FILE);
        let bytes = read_bytes(&path, MAX_PULSE_BYTES).ok();
        let found: Option<Beat> = bytes.and_then(|bytes| serde_json::from_slice(&bytes).ok());
        let Some(found) = found else {
            self.beat = None;
            let liveness = if self.log.order.as_ref().is_some_and(EventOrder::is_over) {
                Liveness::Over
            } else {
                Liveness::Stopped
            };
            self.set_liveness(liveness, news);
            return;
        };
        match &mut self.beat {
            Some((beat, since)) if *beat == found => {
                if is_dead(&found.host, found.process) || now.duration_since(*since) >= SILENCE {
                    self.set_liveness(Liveness::Silent, news);
                }
            }
            known => {
                let before = known.replace((found.clone(), now)).map(|(beat, _)| beat);
                let dead = is_dead(&found.host, found.process);
                compare_beats(before.as_ref(), found, news);
                self.set_liveness(
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

    /// Reports the last sign of a process that is gone.
    fn read_last_sign(&mut self, news: &mut Vec<News>) {
        if matches!(self.liveness, Some(Liveness::Computing | Liveness::Absent)) {
            return;
        }
        let error = self.stamp(ERROR);
        let is_new = news.iter().any(|news| matches!(news, News::Liveness(_)));
        if is_new || error != self.error {
            self.error = error;
            news.extend(LastSign::read(&self.folder).map(News::LastSign));
        }
    }

    fn set_liveness(&mut self, liveness: Liveness, news: &mut Vec<News>) {
        if self.liveness.replace(liveness) != Some(liveness) {
            news.push(News::Liveness(liveness));
        }
    }

    fn stamp(&self, name: &str) -> Option<Stamp> {
        Stamp::of(&self.folder.join(name))
    }
}

impl LogReader {
    /// Returns whether the log still holds what was read: whether its last line is in its place.
    fn is_in(&self, file: &mut (impl Read + Seek)) -> Result<bool, LogError> {
        let begin = self.bytes - self.last.len() as u64;
        file.seek(SeekFrom::Start(begin))?;
        let mut found = Vec::new();
        file.take(self.last.len() as u64).read_to_end(&mut found)?;
        Ok(found == self.last)
    }

    fn read_further(
        &mut self,
        reader: &mut (impl std::io::BufRead + Seek),
        start: EventOrder,
        news: &mut Vec<News>,
    ) -> Result<(), LogError> {
        reader.seek(SeekFrom::Start(self.bytes))?;
        let mut line = Vec::new();
        let order = self.order.get_or_insert(start);
        while let Some(event) = read_event(reader, &mut line, self.lines + 1)? {
            order.check(&event).map_err(|message| LogError::Line {
                line: self.lines + 1,
                message,
            })?;
            self.lines += 1;
            self.bytes += line.len() as u64;
            std::mem::swap(&mut self.last, &mut line);
            news.push(News::Event(event));
        }
        Ok(())
    }
}

/// Adds the differences between two beats as events.
fn compare_beats(before: Option<&Beat>, beat: Beat, news: &mut Vec<News>) {
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

impl Recording {
    /// Reads the run in a folder. An incomplete last event is ignored.
    ///
    /// # Errors
    /// When the folder holds no run, or its log cannot be read.
    pub fn read(folder: &Path) -> Result<Self, RunError> {
        Follower::of(folder).read()
    }
}
