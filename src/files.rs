//! Files: reading what may be hostile, writing so that nothing is ever half there.

use std::fs::{self, File, Metadata};
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::{Duration, SystemTime};

use serde::Deserialize;
use tempfile::NamedTempFile;
use thiserror::Error;

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
    #[error("is larger than allowed: more than {limit} bytes")]
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// It is not text.
    #[error("is not text: byte {at} is not UTF-8")]
    NotText {
        /// Offset of the first byte that is not UTF-8.
        at: usize,
    },
    /// It is not the JSON that it should be.
    #[error(transparent)]
    Json(#[from] JsonError),
    /// It says what it may not say. The text names the place, what was found there and
    /// what is allowed.
    #[error("{0}")]
    Wrong(String),
}

impl From<String> for FileProblem {
    fn from(message: String) -> Self {
        Self::Wrong(message)
    }
}

/// Reads a file of at most `limit` bytes, and never takes more into memory.
///
/// # Errors
/// When the file cannot be read or is larger.
pub fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes));
    read.map_err(|error| FileError::new(path, FileProblem::Unreadable(error)))?;
    if bytes.len() as u64 > limit {
        return Err(FileError::new(path, FileProblem::TooLarge { limit }));
    }
    Ok(bytes)
}

/// Reads a UTF-8 file of at most `limit` bytes.
///
/// # Errors
/// When the file cannot be read, is larger, or is not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> Result<String, FileError> {
    String::from_utf8(read_bytes(path, limit)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        FileError::new(path, FileProblem::NotText { at })
    })
}

/// The version in the `format` field of a JSON text, if it has one. A file of another
/// format is one of another model, so this is looked at before anything else in it.
#[must_use]
pub fn stated_format(text: &str) -> Option<u32> {
    #[derive(Deserialize)]
    struct AnyFormat {
        format: u32,
    }
    let any: AnyFormat = serde_json::from_str(text).ok()?;
    Some(any.format)
}

/// Why a JSON text cannot be read, and where.
#[derive(Debug, Error)]
#[error("line {line}, column {column}, at {place}: {message}")]
pub struct JsonError {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// Dotted path of the value.
    pub place: String,
    /// What was found and what was expected.
    pub message: String,
}

const TOP: &str = "the top level";

impl JsonError {
    /// The same of a value that is the part `name` of another.
    #[must_use]
    pub fn within(self, name: &str) -> Self {
        let place = match self.place.as_str() {
            TOP => name.to_owned(),
            place => format!("{name}.{place}"),
        };
        Self { place, ..self }
    }

    fn at(place: String, error: &serde_json::Error) -> Self {
        let (line, column) = (error.line(), error.column());
        let text = error.to_string();
        let suffix = format!(" at line {line} column {column}");
        Self {
            line,
            column,
            place,
            message: text.strip_suffix(&suffix).unwrap_or(&text).to_owned(),
        }
    }
}

/// Reads a JSON text that is one value and nothing more.
///
/// # Errors
/// When it is not JSON of the type, with the place.
pub fn parse_json<'t, T: Deserialize<'t>>(text: &'t str) -> Result<T, JsonError> {
    let mut json = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let place = match error.path().to_string().as_str() {
            // `?` is a key that could not be read.
            "." | "?" => String::from(TOP),
            path => path.to_owned(),
        };
        JsonError::at(place, error.inner())
    })?;
    let end = json.end();
    end.map_err(|error| JsonError::at(String::from("the end of the file"), &error))?;
    Ok(value)
}

/// How the names of files begin that are being written. One that is found when nobody
/// writes was left by a process that died.
pub const WRITING: &str = ".writing-";

/// Replaces the file at `path` by `bytes`, so that at every moment, and after a
/// crash, it holds either its old or its new content.
///
/// The bytes go to a temporary file in the same folder, are synced, renamed into
/// place, and the folder is synced.
///
/// # Errors
/// When the operating system refuses.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = written(path, bytes)?;
    temporary.as_file().sync_all()?;
    temporary.persist(path).map_err(|error| error.error)?;
    sync_folder(folder_of(path))
}

/// Replaces the file at `path` by `bytes` in one step, whatever happens to this process.
/// A crash of the whole machine soon after may lose the new content.
///
/// # Errors
/// When the operating system refuses.
pub fn write_in_one_step(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let temporary = written(path, bytes)?;
    temporary.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// Makes `path` a second name of the file `from`, in one step and durably; where the
/// file system has no such names, a copy.
///
/// # Errors
/// When the operating system refuses.
pub fn link_atomically(from: &Path, path: &Path) -> io::Result<()> {
    let folder = folder_of(path);
    let file = File::open(from)?;
    file.sync_all()?;
    let place = tempfile::Builder::new()
        .prefix(WRITING)
        .tempdir_in(folder)?;
    let linked = place.path().join("linked");
    if fs::hard_link(from, &linked).is_err() {
        fs::copy(from, &linked)?;
        File::open(&linked)?.sync_all()?;
    }
    fs::rename(&linked, path)?;
    sync_folder(folder)
}

/// Deletes what processes that died have left half made in a folder: entries whose names
/// begin with `prefix` and that have not changed for `age`. What cannot be deleted harms
/// nobody and stays.
///
/// # Errors
/// When the folder is there but cannot be read.
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
            let _left = match metadata.is_dir() {
                true => fs::remove_dir_all(entry.path()),
                false => fs::remove_file(entry.path()),
            };
        }
    }
    Ok(())
}

/// A temporary file beside `path` that holds `bytes`.
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

/// What the operating system said, without the name of a temporary file, which tells nobody
/// anything.
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
/// When the operating system refuses.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    fs::File::open(folder)?.sync_all()
}

/// The folder that `path` lies in.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Tells one version of a file from another, and from a file that took its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    file: (u64, u64),
    length: u64,
    modified: Option<SystemTime>,
}

impl Stamp {
    /// Of the file at `path`; none if there is none.
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

/// Makes control characters visible, line breaks excepted: text from files must not steer a
/// terminal.
#[must_use]
pub fn visible(text: &str) -> String {
    let shown = |c: char| match c {
        '\n' => vec!['\n'],
        c if c.is_control() => c.escape_unicode().collect(),
        c => vec![c],
    };
    text.chars().flat_map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::parse_json;

    #[test]
    fn json_errors_say_once_where_they_are() {
        #[derive(Debug, serde::Deserialize)]
        struct Any {
            #[expect(dead_code, reason = "only read")]
            list: Vec<u8>,
        }
        let says = |text| parse_json::<Any>(text).unwrap_err().to_string();
        let eof = "line 1, column 0, at the top level: EOF while parsing a value";
        assert_eq!(says(""), eof);
        let number = says("{\"list\":\n[1,-2]}");
        assert!(
            number.starts_with("line 2, column 5, at list[1]: invalid value"),
            "{number}"
        );
        assert_eq!(number.matches("line").count(), 1, "{number}");
        let more = says("{\"list\":[]} x");
        assert!(
            more.contains("at the end of the file: trailing characters"),
            "{more}"
        );
    }
}
