//! `events.jsonl`: the recorded events, one a line, append-only.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

use thiserror::Error;

use super::checkpoint::LogPosition;
use super::event::{EVENT_FORMAT, Event};
use crate::files::{FileError, FileProblem, Limits, json_message, synced};

/// Limits of a line. A generation of the largest allowed population fits.
const LIMITS: Limits = Limits {
    bytes: 1 << 26,
    depth: 16,
    values: 1 << 22,
};

/// Why an event log cannot be used.
#[derive(Debug, Error)]
pub(super) enum LogError {
    /// The operating system refuses.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// A line is not an event.
    #[error("line {line}: {message}")]
    Line {
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong with it.
        message: String,
    },
    /// The log does not start with the events before the checkpoint.
    #[error(
        "found {found}; allowed: a file that begins with the {} lines ({} bytes, CRC-32 {:08x}) \
         that the checkpoint was taken after",
        .expected.lines, .expected.bytes, .expected.crc32
    )]
    NotOfCheckpoint {
        /// What was found.
        found: String,
        /// The position in the checkpoint.
        expected: LogPosition,
    },
}

impl From<LogError> for FileProblem {
    fn from(error: LogError) -> Self {
        match error {
            LogError::Io(error) => Self::Refused(error),
            error => Self::Wrong(error.to_string()),
        }
    }
}

/// An event log that is open for appending.
#[derive(Debug)]
pub(super) struct Log {
    file: File,
    position: LogPosition,
}

impl Log {
    /// Creates an empty log.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new()
            .create(true)
            .write(true)
            .truncate(true)
            .open(path)?;
        Ok(Self {
            file,
            position: LogPosition::default(),
        })
    }

    /// Opens a log and cuts off what was written after `position`.
    pub(super) fn reopen(path: &Path, position: LogPosition) -> Result<Self, LogError> {
        let mut file = OpenOptions::new().read(true).write(true).open(path)?;
        check_prefix(&mut BufReader::new(&file), position)?;
        file.set_len(position.bytes)?;
        file.seek(SeekFrom::Start(position.bytes))?;
        Ok(Self { file, position })
    }

    /// Appends one event.
    pub(super) fn append(&mut self, event: &Event) -> io::Result<()> {
        let mut line = serde_json::to_vec(event)?;
        line.push(b'\n');
        self.file.write_all(&line)?;
        let mut hasher =
            crc32fast::Hasher::new_with_initial_len(self.position.crc32, self.position.bytes);
        hasher.update(&line);
        self.position = LogPosition {
            lines: self.position.lines + 1,
            bytes: self.position.bytes + line.len() as u64,
            crc32: hasher.finalize(),
        };
        Ok(())
    }

    /// Waits until the appended events are on the disk.
    pub(super) fn sync(&self) -> io::Result<()> {
        synced(self.file.sync_data())
    }

    pub(super) fn position(&self) -> LogPosition {
        self.position
    }
}

/// Checks that a log begins with the events before `position`, and returns the last of their lines.
pub(super) fn check_prefix(
    reader: &mut impl BufRead,
    position: LogPosition,
) -> Result<Vec<u8>, LogError> {
    let mismatch = |found| LogError::NotOfCheckpoint {
        found,
        expected: position,
    };
    let mut hasher = crc32fast::Hasher::new();
    let (mut last, mut line) = (Vec::new(), Vec::new());
    let mut bytes = 0;
    while bytes < position.bytes {
        line.clear();
        let wanted = (position.bytes - bytes).min(LIMITS.bytes);
        let read = reader.take(wanted).read_until(b'\n', &mut line)?;
        if read == 0 {
            return Err(mismatch(format!("{bytes} bytes")));
        }
        hasher.update(&line);
        bytes += read as u64;
        std::mem::swap(&mut last, &mut line);
    }
    let crc32 = hasher.finalize();
    if crc32 != position.crc32 {
        return Err(mismatch(format!("CRC-32 {crc32:08x} of these bytes")));
    }
    Ok(last)
}

/// Returns the CRC-32 of the bytes up to the end of each line, by their number.
pub(super) fn checksums(reader: &mut impl BufRead) -> io::Result<BTreeMap<u64, u32>> {
    let mut hasher = crc32fast::Hasher::new();
    let (mut line, mut bytes) = (Vec::new(), 0);
    let mut checksums = BTreeMap::from([(0, hasher.clone().finalize())]);
    loop {
        line.clear();
        let read = reader.take(LIMITS.bytes).read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(checksums);
        }
        hasher.update(&line);
        bytes += read as u64;
        checksums.insert(bytes, hasher.clone().finalize());
    }
}

/// Reads the events of a log in order. An incomplete last line is ignored: the process died while
/// it wrote the line.
///
/// # Errors
/// When the file cannot be read or a complete line is not an event.
pub fn read_events(path: &Path) -> Result<Vec<Event>, FileError> {
    events_in(path).map_err(|error| FileError::new(path, error))
}

fn events_in(path: &Path) -> Result<Vec<Event>, LogError> {
    let mut reader = BufReader::new(File::open(path)?);
    let mut events = Vec::new();
    let mut line = Vec::new();
    while let Some(event) = read_event(&mut reader, &mut line, events.len() + 1)? {
        events.push(event);
    }
    Ok(events)
}

/// Reads the event of the next line and leaves the bytes of the line in `line`; `number` is the
/// number of the line, for errors. Returns `None` at the end and at an incomplete line.
pub(super) fn read_event(
    reader: &mut impl BufRead,
    line: &mut Vec<u8>,
    number: usize,
) -> Result<Option<Event>, LogError> {
    let wrong = |message| LogError::Line {
        line: number,
        message,
    };
    line.clear();
    let read = reader.take(LIMITS.bytes).read_until(b'\n', line)?;
    if line.last() != Some(&b'\n') {
        if read as u64 == LIMITS.bytes {
            return Err(wrong(format!(
                "longer than allowed: {} bytes",
                LIMITS.bytes
            )));
        }
        return Ok(None);
    }
    LIMITS.check(&*line).map_err(|error| wrong(error.message))?;
    let event = serde_json::from_slice(line).map_err(|error| wrong(json_message(&error)))?;
    if let Event::Started { format, .. } = &event
        && *format != EVENT_FORMAT
    {
        return Err(wrong(format!(
            "format: found {format}; allowed: {EVENT_FORMAT}"
        )));
    }
    Ok(Some(event))
}
