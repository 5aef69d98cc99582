//! The house: imports between the rooms of `src/` point one way, the terminal is known in
//! `dashboard/` alone, files stay short, and nothing gives up instead of returning an error.
//!
//! Why it matters: the library must run without a terminal, evolution must be testable
//! without files, and a room that names its visitors cannot be understood alone.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::path::{Path, PathBuf};

/// The rooms, each with its rank: a room may name rooms of higher ranks, and its own.
/// `files`, `random` and `rules` are tools that every room may use.
const ROOMS: &[(&str, usize)] = &[
    ("cli", 0),
    ("dashboard", 1),
    ("report", 1),
    ("lab", 2),
    ("evolution", 3),
    ("learning", 4),
    ("hierarchy", 5),
    ("scenario", 6),
    ("worlds", 7),
    ("files", 8),
    ("random", 8),
    ("rules", 8),
];

/// Files that belong to no room: they say what the rooms are.
const DOORS: &[&str] = &["main.rs", "lib.rs", "build.rs"];

const LONGEST_FILE: usize = 500;

struct Source {
    /// Path below `src/`.
    path: PathBuf,
    lines: Vec<String>,
}

impl Source {
    fn read(path: &Path, root: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        Self {
            path: path.strip_prefix(root).unwrap().to_owned(),
            lines: text.lines().map(str::to_owned).collect(),
        }
    }

    /// The room: the first folder, or the file itself.
    fn room(&self) -> String {
        let first = self.path.components().next().unwrap();
        Path::new(&first)
            .file_stem()
            .unwrap()
            .to_string_lossy()
            .into_owned()
    }

    fn is_door(&self) -> bool {
        DOORS.iter().any(|door| self.path == Path::new(door))
    }

    /// Lines of code with their numbers, comments left out.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let numbered = self.lines.iter().enumerate();
        numbered
            .map(|(index, line)| (index + 1, line.split("//").next().unwrap_or_default()))
            .filter(|(_, code)| !code.trim().is_empty())
    }

    /// The code before the test module, which stands at the end of a file.
    fn code_without_tests(&self) -> impl Iterator<Item = (usize, &str)> {
        self.code()
            .take_while(|(_, code)| code.trim() != "#[cfg(test)]")
    }
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut folders = vec![root.clone()];
    let mut sources = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                sources.push(Source::read(&path, &root));
            }
        }
    }
    assert!(sources.len() > 50, "the sources were not found");
    sources
}

/// Names that follow `crate::` in a line.
fn rooms_named(code: &str) -> impl Iterator<Item = &str> {
    code.split("crate::").skip(1).map(|rest| {
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
        &rest[..end.unwrap_or(rest.len())]
    })
}

fn rank(room: &str) -> Option<usize> {
    ROOMS
        .iter()
        .find(|(name, _)| *name == room)
        .map(|(_, rank)| *rank)
}

#[test]
fn imports_point_one_way() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| !source.is_door()) {
        let room = source.room();
        let own = rank(&room).unwrap_or_else(|| panic!("src/{room} is no room of the house"));
        for (number, code) in source.code() {
            for named in rooms_named(code) {
                let allowed = named == room || rank(named).is_some_and(|rank| rank > own);
                if !allowed {
                    wrong.push(format!(
                        "{}:{number}: {room} names {named:?}",
                        source.path.display()
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_check_of_imports_sees_what_it_should() {
    let named = |code| rooms_named(code).collect::<Vec<_>>();
    assert_eq!(named("use crate::lab::{Event, Run};"), ["lab"]);
    assert_eq!(
        named("fn f(a: crate::cli::A, b: crate::files::B)"),
        ["cli", "files"]
    );
    // A list of rooms is not understood, so it is not allowed: it names the room "".
    assert_eq!(named("use crate::{cli, lab};"), [""]);
    assert_eq!(rank(""), None);
}

/// The worlds: the folders of `src/worlds`.
fn worlds() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/worlds");
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let folders = entries.filter(|entry| entry.path().is_dir());
    folders
        .map(|folder| folder.file_name().into_string().unwrap())
        .collect()
}

/// Whether `code` names something of the world `four_rooms`: `four_rooms::START`, `FourRoomsWorld`.
fn names(code: &str, world: &str) -> bool {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    let camel_case: String = world.split('_').map(capital).collect();
    let mut words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
    code.contains(&format!("{world}::")) || words.any(|word| word.starts_with(&camel_case))
}

#[test]
fn a_world_is_known_in_its_own_folder_alone() {
    let worlds = worlds();
    assert!(worlds.len() >= 3, "the worlds were not found");
    let mut wrong = Vec::new();
    for source in sources() {
        for (number, code) in source.code_without_tests() {
            for world in worlds.iter().filter(|world| names(code, world)) {
                let listed = source.path == Path::new("worlds/mod.rs");
                if !listed && !source.path.starts_with(Path::new("worlds").join(world)) {
                    wrong.push(format!("{}:{number}: {code}", source.path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_check_of_worlds_sees_what_it_should() {
    assert!(names("use crate::worlds::taxi::Passenger;", "taxi"));
    assert!(names("WorldSettings::FourRooms(model) =>", "four_rooms"));
    assert!(names(
        "let world = FourRoomsWorld::new(model);",
        "four_rooms"
    ));
    // The name of a scenario, in a message or an example.
    assert!(!names("maxq-lab learn taxi-fickle", "taxi"));
}

#[test]
fn only_the_dashboard_knows_the_terminal() {
    for source in sources()
        .iter()
        .filter(|source| source.room() != "dashboard")
    {
        for (number, code) in source.code() {
            let known = code.contains("ratatui") || code.contains("crossterm");
            assert!(!known, "{}:{number}: {code}", source.path.display());
        }
    }
}

#[test]
fn nothing_is_unsafe_and_nothing_gives_up() {
    for source in sources() {
        for (number, code) in source.code() {
            let words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
            let is_unsafe = words.into_iter().any(|word| word == "unsafe");
            assert!(!is_unsafe, "{}:{number}: {code}", source.path.display());
        }
        for (number, code) in source.code_without_tests() {
            for giving_up in [
                ".unwrap()",
                ".expect(",
                "panic!(",
                "todo!(",
                "unimplemented!(",
            ] {
                let found = code.contains(giving_up);
                assert!(!found, "{}:{number}: {code}", source.path.display());
            }
        }
    }
}

#[test]
fn files_are_short() {
    for source in sources() {
        let (path, length) = (source.path.display(), source.lines.len());
        assert!(
            length <= LONGEST_FILE,
            "src/{path} has {length} lines; allowed: {LONGEST_FILE}"
        );
    }
}

/// The list in `worlds/mod.rs` is complete.
#[test]
fn every_folder_of_worlds_is_a_world() {
    let list = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/worlds/mod.rs");
    let list = fs::read_to_string(list).unwrap();
    for world in worlds() {
        assert!(list.contains(&format!("pub mod {world};")), "{world}");
    }
}

/// The floors of the dashboard, from the ground up: a file may import from its own floor and
/// from the floors before it.
const FLOORS: [&str; 12] = [
    "look", "view_id", "keys", "panel", "context", "scene", "views", "chrome", "app", "runs",
    "terminal", "session",
];

fn floor(name: &str) -> Option<usize> {
    FLOORS.iter().position(|floor| *floor == name)
}

/// Names that stand directly below `dashboard::` in a line of code, in a file whose module is
/// `depth` levels below `dashboard`.
fn floors_named(code: &str, depth: usize) -> Vec<&str> {
    let name = |rest| str::split(rest, |c: char| !c.is_alphanumeric() && c != '_').next();
    let absolute = code.split("crate::dashboard::").skip(1).filter_map(name);
    let climb = "super::".repeat(depth);
    let starts = code.match_indices(&climb).map(|(at, _)| at);
    let starts = starts.filter(|at| !code[..*at].ends_with("super::"));
    let relative = starts.filter_map(|at| name(&code[at + climb.len()..]));
    absolute
        .chain(relative.filter(|name| *name != "super"))
        .collect()
}

#[test]
fn the_dashboard_is_built_floor_upon_floor() {
    let mut wrong = Vec::new();
    for source in sources() {
        let Ok(path) = source.path.strip_prefix("dashboard") else {
            continue;
        };
        if path == Path::new("mod.rs") {
            continue;
        }
        let folded = path.file_name().unwrap() == "mod.rs";
        let depth = path.components().count() - usize::from(folded);
        let first = Path::new(path.components().next().unwrap().as_os_str());
        let own = first.file_stem().unwrap().to_str().unwrap();
        let own = floor(own).unwrap_or_else(|| panic!("{own} is on no floor"));
        for (number, code) in source.code_without_tests() {
            for named in floors_named(code, depth) {
                if floor(named).is_none_or(|floor| floor > own) {
                    let place = source.path.display();
                    wrong.push(format!("{place}:{number}: {} names {named:?}", FLOORS[own]));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_check_of_floors_sees_what_it_should() {
    let code = "use crate::dashboard::look::{Look, Paint};";
    assert_eq!(floors_named(code, 1), ["look"]);
    assert_eq!(floors_named("use super::keys::Key;", 1), ["keys"]);
    assert_eq!(floors_named("use super::row::RunRow;", 2), [""; 0]);
    assert_eq!(floors_named("use super::super::keys::Key;", 2), ["keys"]);
    // A list hides the floors, so it is not allowed: it names the floor "".
    assert_eq!(floors_named("use super::{App, Input};", 1), [""]);
    assert_eq!(floor(""), None);
}
