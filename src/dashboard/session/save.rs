//! Exported files: written, and removed again.

use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::dashboard::context::Export;
use crate::dashboard::keys::{Action, KeyMap};
use crate::files::Stamp;

/// Most files of one name in a folder.
const MOST: u32 = 10_000;

/// The files that a dashboard has written, the latest last.
#[derive(Debug, Default)]
pub struct Exports {
    written: Vec<(PathBuf, Option<Stamp>)>,
}

impl Exports {
    /// Writes a file into `folder`, and says where and with which keys it is removed.
    ///
    /// No file is ever overwritten: a number is added to a name that is taken.
    ///
    /// # Errors
    /// When the operating system refuses, or no name is left.
    pub fn write(&mut self, export: &Export, folder: &Path, keys: &KeyMap) -> io::Result<String> {
        let path = save(export, folder)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let [menu, remove] = [Action::Export, Action::ExportRemove].map(|action| {
            let key = keys.keys(action).first();
            key.map_or_else(String::new, ToString::to_string)
        });
        let place = std::path::absolute(folder)?;
        let said = format!(
            "written: {name} ({menu} {remove} removes it) in {}",
            place.display()
        );
        self.written.push((path.clone(), Stamp::of(&path)));
        Ok(said)
    }

    /// Removes the file that was written last, unless somebody has changed it since; says what was
    /// done.
    pub fn remove_last(&mut self) -> String {
        let Some((path, stamp)) = self.written.pop() else {
            return String::from("no file to remove: none was written");
        };
        let shown = path.display();
        let now = Stamp::of(&path);
        if now.is_none() {
            return format!("{shown} is gone already");
        }
        if now != stamp {
            return format!("{shown} stays: it was changed after it was written");
        }
        match fs::remove_file(&path) {
            Ok(()) => format!("removed: {shown}"),
            Err(error) => format!("{shown}: {error}"),
        }
    }
}

fn save(export: &Export, folder: &Path) -> io::Result<PathBuf> {
    let (stem, extension) = export
        .name
        .rsplit_once('.')
        .unwrap_or((&export.name, "txt"));
    for number in 1..=MOST {
        let path = folder.join(match number {
            1 => format!("{stem}.{extension}"),
            number => format!("{stem}-{number}.{extension}"),
        });
        let file = OpenOptions::new().write(true).create_new(true).open(&path);
        match file {
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

    fn export(contents: &str) -> Export {
        Export {
            name: String::from("tree.dot"),
            contents: contents.to_owned(),
        }
    }

    #[test]
    fn nothing_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let first = save(&export("one"), folder.path()).unwrap();
        let second = save(&export("two"), folder.path()).unwrap();
        let name = |path: &Path| path.file_name().unwrap().to_owned();
        assert_eq!(name(&first), "tree.dot");
        assert_eq!(name(&second), "tree-2.dot");
        assert_eq!(fs::read_to_string(first).unwrap(), "one");
    }

    #[test]
    fn what_was_written_is_removed_unless_it_was_changed() {
        let folder = tempfile::tempdir().unwrap();
        let mut exports = Exports::default();
        let write = |contents, exports: &mut Exports| {
            let keys = KeyMap::default();
            exports
                .write(&export(contents), folder.path(), &keys)
                .unwrap()
        };
        let said = write("one", &mut exports);
        let place = folder.path().display();
        assert_eq!(
            said,
            format!("written: tree.dot (e u removes it) in {place}")
        );
        write("two", &mut exports);
        let at = |name: &str| folder.path().join(name);
        assert!(exports.remove_last().starts_with("removed: "));
        assert!(!at("tree-2.dot").exists() && at("tree.dot").exists());
        fs::write(at("tree.dot"), "mine, and longer").unwrap();
        assert!(exports.remove_last().contains("stays"));
        assert!(at("tree.dot").exists());
        assert!(exports.remove_last().starts_with("no file to remove"));
    }
}
