//! Sizes of folders, and numbers of bytes for people.

use std::collections::HashSet;
use std::fmt;
use std::fs::{self, Metadata};
use std::path::Path;

/// A number of bytes, shown in the unit that fits: `147 kB`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ByteCount(pub u64);

impl fmt::Display for ByteCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mut number, mut units) = (self.0 as f64, ["B", "kB", "MB", "GB", "TB"].iter());
        let mut unit = units.next().unwrap_or(&"");
        while number >= 999.5 {
            let Some(next) = units.next() else { break };
            (number, unit) = (number / 1000.0, next);
        }
        let digits = usize::from(number < 9.95 && *unit != "B");
        write!(f, "{number:.digits$} {unit}")
    }
}

/// Returns the size of all files below a folder, in bytes. A file with several names counts once,
/// links are not followed, and what cannot be read counts nothing.
#[must_use]
pub fn folder_bytes(folder: &Path) -> u64 {
    let (mut folders, mut seen) = (vec![folder.to_owned()], HashSet::new());
    let mut bytes = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            match entry.metadata() {
                Ok(data) if data.is_dir() => folders.push(entry.path()),
                Ok(data) if data.is_file() && seen.insert(identity(&data, &entry.path())) => {
                    bytes += data.len();
                }
                _ => {}
            }
        }
    }
    bytes
}

/// Returns what tells a file from others, whatever its name.
#[cfg(unix)]
fn identity(data: &Metadata, _path: &Path) -> (u64, u64) {
    use std::os::unix::fs::MetadataExt;
    (data.dev(), data.ino())
}

/// Returns what tells a file from others.
#[cfg(not(unix))]
fn identity(_data: &Metadata, path: &Path) -> std::path::PathBuf {
    path.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_bytes_have_the_unit_that_fits() {
        let says = |bytes| ByteCount(bytes).to_string();
        assert_eq!(says(0), "0 B");
        assert_eq!(says(999), "999 B");
        assert_eq!(says(1_500), "1.5 kB");
        assert_eq!(says(147_000), "147 kB");
        assert_eq!(says(999_600), "1.0 MB");
        assert_eq!(says(29_400_000_000), "29 GB");
        assert_eq!(says(u64::MAX), "18446744 TB");
    }

    #[test]
    fn a_file_with_two_names_counts_once() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        std::fs::create_dir(&inner).unwrap();
        std::fs::write(folder.path().join("one"), [0; 1000]).unwrap();
        std::fs::hard_link(folder.path().join("one"), inner.join("two")).unwrap();
        std::fs::write(inner.join("three"), [0; 30]).unwrap();
        std::os::unix::fs::symlink(folder.path(), inner.join("four")).unwrap();
        assert_eq!(folder_bytes(folder.path()), 1030);
        assert_eq!(folder_bytes(&folder.path().join("none")), 0);
    }
}
