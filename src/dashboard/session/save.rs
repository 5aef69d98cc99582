//! Exported files.

use std::fs::OpenOptions;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::dashboard::context::Export;

/// Most files of one name in a folder.
const MOST: u32 = 10_000;

impl Export {
    /// Writes the file into `folder` and returns its path.
    ///
    /// No file is ever overwritten: a number is added to a name that is taken.
    ///
    /// # Errors
    /// When the operating system refuses, or no name is left.
    pub fn save(&self, folder: &Path) -> io::Result<PathBuf> {
        let (stem, extension) = self.name.rsplit_once('.').unwrap_or((&self.name, "txt"));
        for number in 1..=MOST {
            let path = folder.join(match number {
                1 => format!("{stem}.{extension}"),
                number => format!("{stem}-{number}.{extension}"),
            });
            let file = OpenOptions::new().write(true).create_new(true).open(&path);
            match file {
                Ok(mut file) => {
                    file.write_all(self.contents.as_bytes())?;
                    return Ok(path);
                }
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(ErrorKind::AlreadyExists.into())
    }
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
        let first = export("one").save(folder.path()).unwrap();
        let second = export("two").save(folder.path()).unwrap();
        let name = |path: &Path| path.file_name().unwrap().to_owned();
        assert_eq!(name(&first), "tree.dot");
        assert_eq!(name(&second), "tree-2.dot");
        assert_eq!(std::fs::read_to_string(first).unwrap(), "one");
    }
}
