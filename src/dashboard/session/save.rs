//! Files that a person has asked for.

use std::fs::OpenOptions;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::dashboard::context::Export;

/// Files of one name in a folder before there is no other name for one more.
const MOST: u32 = 10_000;

/// Writes an export to a folder, beside what is there: nothing is ever overwritten.
///
/// # Errors
/// When the operating system refuses, or no name is left.
pub(super) fn save(folder: &Path, export: &Export) -> io::Result<PathBuf> {
    let (stem, extension) = export
        .name
        .rsplit_once('.')
        .unwrap_or((&export.name, "txt"));
    for number in 1..=MOST {
        let path = folder.join(match number {
            1 => format!("{stem}.{extension}"),
            number => format!("{stem}-{number}.{extension}"),
        });
        let made = OpenOptions::new().write(true).create_new(true).open(&path);
        match made {
            Ok(mut file) => {
                file.write_all(export.contents.as_bytes())?;
                return Ok(path);
            }
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let export = |contents: &str| Export {
            name: String::from("tree.dot"),
            contents: contents.to_owned(),
        };
        let first = save(folder.path(), &export("one")).unwrap();
        let second = save(folder.path(), &export("two")).unwrap();
        let name = |path: &Path| path.file_name().unwrap().to_owned();
        assert_eq!(name(&first), "tree.dot");
        assert_eq!(name(&second), "tree-2.dot");
        assert_eq!(std::fs::read_to_string(first).unwrap(), "one");
    }
}
