//! Files: reading what may be hostile, writing so that nothing is ever half there.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use serde::Deserialize;
use thiserror::Error;

/// Why a file was not read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The operating system refused.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// Larger than anything this program writes.
    #[error("is larger than allowed: more than {limit} bytes")]
    TooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// Not text.
    #[error("is not text: byte {at} is not UTF-8")]
    NotText {
        /// Offset of the first byte that is no UTF-8.
        at: usize,
    },
}

/// Reads a file of at most `limit` bytes; no more than that is ever taken into memory.
///
/// # Errors
/// When the file cannot be read or is larger.
pub fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    File::open(path)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        return Err(ReadError::TooLarge { limit });
    }
    Ok(bytes)
}

/// Reads a UTF-8 file of at most `limit` bytes.
///
/// # Errors
/// When the file cannot be read, is larger, or is not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> Result<String, ReadError> {
    String::from_utf8(read_bytes(path, limit)?).map_err(|error| ReadError::NotText {
        at: error.utf8_error().valid_up_to(),
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

/// Replaces the file at `path` by `bytes`, so that at every moment, and after a
/// crash, it holds either its old or its new content.
///
/// The bytes go to a temporary file in the same folder, are synced, renamed into
/// place, and the folder is synced.
///
/// # Errors
/// When the operating system refuses.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = folder_of(path);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".writing-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut temporary = builder.tempfile_in(folder)?;
    temporary.write_all(bytes)?;
    temporary.as_file().sync_all()?;
    temporary.persist(path).map_err(|error| error.error)?;
    sync_folder(folder)
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
