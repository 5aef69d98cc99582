//! Files: reads of possibly hostile files, their limits, and atomic writes.

use std::fs::{self, File, Metadata};
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::{Duration, SystemTime};

use serde::de::DeserializeOwned;
use tempfile::NamedTempFile;
use thiserror::Error;

mod json;
mod limits;
mod size;

pub use json::{JsonError, message as json_message, parse_json, stated_format};
pub use limits::Limits;
pub use size::{ByteCount, folder_bytes};

/// A file or folder that cannot be used, and why.
#[derive(Debug, Error)]
#[error("{path}: {source}")]
pub struct FileError {
    /// The path, as it is shown.
    pub path: String,
    /// What is wrong.
    pub source: FileProblem,
}

impl FileError {
    /// The error of the file or folder at `path`.
    pub fn new(path: impl AsRef<Path>, problem: impl Into<FileProblem>) -> Self {
        Self {
            path: path.as_ref().display().to_string(),
            source: problem.into(),
        }
    }
}

/// What is wrong with a file or folder.
#[derive(Debug, Error)]
pub enum FileProblem {
    /// The operating system refuses.
    #[error("{0}")]
    Refused(#[from] io::Error),
    /// The operating system refuses to read it.
    #[error("cannot be read: {0}")]
    Unreadable(#[source] io::Error),
    /// It is larger than anything that this program writes.
    #[error("found more than {limit} bytes; allowed: at most {limit}")]
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// It is not UTF-8.
    #[error("found {found}; allowed: text in UTF-8{}", how_to_convert(*.found))]
    NotText {
        /// What it is instead.
        found: Encoding,
    },
    /// It is not the JSON that it should be.
    #[error(transparent)]
    Json(#[from] JsonError),
    /// It says what it may not say. The text names the place, what was found there and
    /// what is allowed.
    #[error("{0}")]
    Wrong(String),
}

/// What a file is instead of text in UTF-8.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Encoding {
    /// It begins with the byte order mark of UTF-16.
    #[error("text in UTF-16")]
    Utf16,
    /// It holds a byte that text in UTF-8 cannot have.
    #[error("byte {at}, which is not UTF-8")]
    Unknown {
        /// Offset of the byte, from 0.
        at: usize,
    },
}

impl Encoding {
    fn of(bytes: &[u8], first_wrong: usize) -> Self {
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            Self::Utf16
        } else {
            Self::Unknown { at: first_wrong }
        }
    }
}

fn how_to_convert(found: Encoding) -> &'static str {
    match found {
        Encoding::Utf16 => " ('iconv -f UTF-16 -t UTF-8 OLD > NEW' converts it)",
        Encoding::Unknown { .. } => "",
    }
}

impl From<String> for FileProblem {
    fn from(message: String) -> Self {
        Self::Wrong(message)
    }
}

/// The character that marks the order of bytes at the beginning of a file.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Reads a file of at most `limit` bytes, and never takes more into memory.
///
/// # Errors
/// Fails if the file cannot be read or is larger.
pub fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let file = File::open(path).map_err(FileProblem::Unreadable);
    let read = file.and_then(|file| taken(file, limit));
    read.map_err(|problem| FileError::new(path, problem))
}

/// Reads a UTF-8 file of at most `limit` bytes. A byte order mark at its beginning, which some
/// editors write, is left out.
///
/// # Errors
/// Fails if the file cannot be read, is larger, or is not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> Result<String, FileError> {
    text_of(read_bytes(path, limit)?).map_err(|problem| FileError::new(path, problem))
}

/// Reads a JSON file within its limits; returns `None` if there is no file.
///
/// # Errors
/// Fails if the file cannot be read, breaks a limit, or is not JSON of the type.
pub fn read_json<T: DeserializeOwned>(path: &Path, limits: Limits) -> Result<Option<T>, FileError> {
    if !fs::exists(path).unwrap_or(true) {
        return Ok(None);
    }
    let text = read_text(path, limits.bytes)?;
    let value = limits.check(&text).and_then(|()| parse_json(&text));
    Ok(Some(value.map_err(|error| FileError::new(path, error))?))
}

/// Reads the text on standard input, as [`read_text`] does a file.
///
/// # Errors
/// Fails if it cannot be read, is larger, or is not UTF-8. The error calls it `standard input`.
pub fn read_standard_input(limit: u64) -> Result<String, FileError> {
    let refused = |problem| FileError::new("standard input", problem);
    text_of(taken(io::stdin().lock(), limit).map_err(refused)?).map_err(refused)
}

/// Reads all that `source` has, if it is at most `limit` bytes.
fn taken(source: impl Read, limit: u64) -> Result<Vec<u8>, FileProblem> {
    let mut bytes = Vec::new();
    let read = source.take(limit + 1).read_to_end(&mut bytes);
    read.map_err(FileProblem::Unreadable)?;
    if bytes.len() as u64 > limit {
        return Err(FileProblem::TooLarge { limit });
    }
    Ok(bytes)
}

fn text_of(bytes: Vec<u8>) -> Result<String, FileProblem> {
    let mut text = String::from_utf8(bytes).map_err(|error| {
        let first_wrong = error.utf8_error().valid_up_to();
        let found = Encoding::of(error.as_bytes(), first_wrong);
        FileProblem::NotText { found }
    })?;
    if text.starts_with(BYTE_ORDER_MARK) {
        text.drain(..BYTE_ORDER_MARK.len_utf8());
    }
    Ok(text)
}

/// Prefix of the names of files that are being written. A process that dies leaves its files.
pub const WRITING: &str = ".writing-";

/// Replaces the file at `path` by `bytes`. At every moment, and after a crash, it has either its
/// old or its new content.
///
/// The bytes are written to a temporary file in the same folder and synced. The file is renamed,
/// and the folder is synced.
///
/// # Errors
/// Fails if the operating system refuses.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = written(path, bytes)?;
    synced(temporary.as_file().sync_all())?;
    temporary.persist(path).map_err(|error| error.error)?;
    sync_folder(folder_of(path))
}

/// Replaces the file at `path` by `bytes` in one step, even if this process dies.
///
/// If the whole machine crashes soon after, the new content may be lost.
///
/// # Errors
/// Fails if the operating system refuses.
pub fn write_in_one_step(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = written(path, bytes)?;
    temporary.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Makes `path` a hard link to the file `from`, in one step and durably. On a file system
/// without hard links it becomes a copy.
///
/// # Errors
/// Fails if the operating system refuses.
pub fn link_atomically(from: &Path, path: &Path) -> io::Result<()> {
    let folder = folder_of(path);
    let file = File::open(from)?;
    synced(file.sync_all())?;
    let place = tempfile::Builder::new()
        .prefix(WRITING)
        .tempdir_in(folder)?;
    let linked = place.path().join("linked");
    if fs::hard_link(from, &linked).is_err() {
        fs::copy(from, &linked)?;
        synced(File::open(&linked)?.sync_all())?;
    }
    fs::rename(&linked, path)?;
    sync_folder(folder)
}

/// Deletes what dead processes have left in a folder: entries whose names begin with `prefix` and
/// that have not changed for `age`. Entries that cannot be deleted stay.
///
/// # Errors
/// Fails if the folder exists but cannot be read.
pub fn clean(folder: &Path, prefix: &str, age: Duration) -> io::Result<()> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries?,
    };
    for entry in entries {
        let entry = entry?;
        if !entry.file_name().to_string_lossy().starts_with(prefix) {
            continue;
        }
        let Ok(metadata) = entry.metadata() else {
            continue;
        };
        let unchanged = metadata
            .modified()
            .ok()
            .and_then(|then| then.elapsed().ok());
        if age.is_zero() || unchanged.is_some_and(|unchanged| unchanged >= age) {
            let _stays = if metadata.is_dir() {
                fs::remove_dir_all(entry.path())
            } else {
                fs::remove_file(entry.path())
            };
        }
    }
    Ok(())
}

/// Writes `bytes` to a temporary file in the folder of `path`.
fn written(path: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(WRITING);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let temporary = builder.tempfile_in(folder_of(path));
    let mut temporary = temporary.map_err(without_path)?;
    temporary.write_all(bytes).map_err(without_path)?;
    Ok(temporary)
}

/// Removes the meaningless name of a temporary file from an error.
#[must_use]
pub fn without_path(error: io::Error) -> io::Error {
    match error.to_string().rsplit_once(" at path ") {
        Some((said, _)) if error.get_ref().is_some() => io::Error::new(error.kind(), said),
        _ => error,
    }
}

/// Makes renames and new files in `folder` durable.
///
/// # Errors
/// Fails if the operating system refuses.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    synced(File::open(folder)?.sync_all())
}

/// Returns the result of a sync; a file system that cannot sync such a file is no failure.
///
/// # Errors
/// When the sync failed for another reason.
pub fn synced(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if is_unsupported(&error) => Ok(()),
        result => result,
    }
}

/// Returns whether `error` says that the file system, or the operating system, cannot do this at
/// all.
#[must_use]
pub fn is_unsupported(error: &io::Error) -> bool {
    use rustix::io::Errno;
    let unsupported = [Errno::NOSYS, Errno::INVAL, Errno::NOTSUP, Errno::OPNOTSUPP];
    Errno::from_io_error(error).is_some_and(|errno| unsupported.contains(&errno))
}

/// Returns the folder of `path`.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Identifies a version of a file, to recognise when it has changed or another has replaced it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    file: (u64, u64),
    length: u64,
    modified: Option<SystemTime>,
}

impl Stamp {
    /// Returns the stamp of the file at `path`, if there is one.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let metadata = path.metadata().ok().filter(Metadata::is_file)?;
        #[cfg(unix)]
        let file = {
            use std::os::unix::fs::MetadataExt;
            (metadata.dev(), metadata.ino())
        };
        #[cfg(not(unix))]
        let file = (0, 0);
        Some(Self {
            file,
            length: metadata.len(),
            modified: metadata.modified().ok(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::synced;

    #[test]
    fn a_file_system_that_cannot_sync_is_no_failure() {
        use rustix::io::Errno;
        for unsupported in [Errno::INVAL, Errno::NOTSUP, Errno::NOSYS] {
            assert!(synced(Err(unsupported.into())).is_ok());
        }
        assert!(synced(Err(Errno::IO.into())).is_err());
        assert!(synced(Err(Errno::NOSPC.into())).is_err());
    }
}
