//! Contract: imports between the rooms of `src/` point one way, and no files import each other in
//! a circle. Only `dashboard/` knows the terminal. Files are short, and errors are returned.
//!
//! Why it matters: the library must run without a terminal, evolution must be testable
//! without files, and a file must be understood without those that use it.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[allow(dead_code)] // Its `main` is for Cargo.
#[path = "../src/build.rs"]
mod build;
#[path = "architecture/circles.rs"]
mod circles;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use maxq_lab::scenario::{EMBEDDED, EMBEDDED_PLANS, Embedded};

/// The rooms with their ranks. A room may import from itself and from rooms of higher ranks.
/// Every room may use the tools `files`, `random`, `rules` and `words`.
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
    ("words", 9),
];

/// Files that belong to no room: they list the rooms.
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

    /// The room is the first folder, or the file itself.
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

    /// Lines of code with their numbers, without comments.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let numbered = self.lines.iter().enumerate();
        numbered
            .map(|(index, line)| (index + 1, line.split("//").next().unwrap_or_default()))
            .filter(|(_, code)| !code.trim().is_empty())
    }

    /// The code before the test module, which is the last item of a file.
    fn code_without_tests(&self) -> impl Iterator<Item = (usize, &str)> {
        self.code()
            .take_while(|(_, code)| code.trim() != "#[cfg(test)]")
    }
}

fn package(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn sources() -> Vec<Source> {
    let root = package("src");
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

/// The names that follow `crate::` in a line.
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
    // A list of rooms is not allowed: it names the room "".
    assert_eq!(named("use crate::{cli, lab};"), [""]);
    assert_eq!(rank(""), None);
}

/// Every file imports only from below: the circles of `circles::circles`, which says how a
/// re-export is followed.
#[test]
fn no_files_import_each_other_in_a_circle() {
    let circles = circles::circles(&package("src"));
    assert!(circles.is_empty(), "{circles:#?}");
}

/// The names of the folders, or else of the files, in a folder, without their extensions.
fn entries(folder: &str, folders: bool) -> BTreeSet<String> {
    let entries = fs::read_dir(package(folder)).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let wanted = paths.filter(|path| path.is_dir() == folders);
    wanted
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect()
}

/// `FourRooms` of the world `four_rooms`.
fn camel_case(world: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    world.split('_').map(capital).collect()
}

/// Whether `code` names an item of the world `four_rooms`: `four_rooms::START`, `FourRoomsWorld`.
fn names(code: &str, world: &str) -> bool {
    let camel_case = camel_case(world);
    let mut words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
    code.contains(&format!("{world}::")) || words.any(|word| word.starts_with(&camel_case))
}

#[test]
fn only_its_own_folder_knows_a_world() {
    let worlds = entries("src/worlds", true);
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
    // The name of a scenario in a message or an example does not count.
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
fn nothing_is_unsafe_and_nothing_panics() {
    for source in sources() {
        for (number, code) in source.code() {
            let words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
            let is_unsafe = words.into_iter().any(|word| word == "unsafe");
            assert!(!is_unsafe, "{}:{number}: {code}", source.path.display());
        }
        for (number, code) in source.code_without_tests() {
            for panicking in [
                ".unwrap()",
                ".expect(",
                "panic!(",
                "todo!(",
                "unimplemented!(",
            ] {
                let found = code.contains(panicking);
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

/// The list in `worlds/mod.rs` names every folder, and only folders.
#[test]
fn the_folders_of_worlds_are_the_variants_of_world_settings() {
    let list = fs::read_to_string(package("src/worlds/mod.rs")).unwrap();
    let (_, list) = list.split_once("worlds! {").unwrap();
    let (list, _) = list.split_once("\n}").unwrap();
    let lines = list.lines().map(str::trim);
    let listed: BTreeSet<_> = lines.filter(|line| line.ends_with(';')).collect();
    let expected: BTreeSet<_> = entries("src/worlds", true)
        .iter()
        .map(|world| {
            let name = camel_case(world);
            format!("{name}: \"{world}\", {world}::{name}Settings;")
        })
        .collect();
    assert_eq!(listed, expected.iter().map(String::as_str).collect());
}

#[test]
fn the_files_of_scenarios_are_embedded() {
    let embedded = |all: &[Embedded]| -> BTreeSet<_> {
        all.iter()
            .map(|embedded| embedded.name.to_owned())
            .collect()
    };
    let mut files = entries("scenarios", false);
    files.remove("README");
    assert_eq!(embedded(EMBEDDED), files);
    let mut files = entries("scenarios/studies", false);
    files.remove("README");
    assert_eq!(embedded(EMBEDDED_PLANS), files);
}

/// A package that was unpacked below another repository does not name that one's commit.
#[test]
fn the_commit_is_that_of_the_packages_own_repository() {
    let folder = tempfile::tempdir().unwrap();
    let package = folder.path().join("package");
    fs::create_dir(&package).unwrap();
    let git = |at: &Path, arguments: &[&str]| {
        let mut git = Command::new("git");
        let git = git
            .current_dir(at)
            .args(["-c", "user.name=N", "-c", "user.email=n@example.org"]);
        git.args(arguments)
            .output()
            .is_ok_and(|output| output.status.success())
    };
    let commit_in = |at: &Path| {
        let commit = [
            "commit",
            "--quiet",
            "--allow-empty",
            "--message",
            "A commit",
        ];
        git(at, &["init", "--quiet"]) && git(at, &commit)
    };
    assert_eq!(build::commit(&package), None, "no repository");
    if !commit_in(folder.path()) {
        return; // Without git there is nothing to record.
    }
    assert_eq!(build::commit(&package), None, "a foreign repository");
    assert!(commit_in(&package));
    let (clean, watched) = build::commit(&package).unwrap();
    assert!(
        clean.len() >= 7 && clean.chars().all(|c| c.is_ascii_hexdigit()),
        "{clean}"
    );
    let ends = |end: &str| watched.iter().any(|path| path.ends_with(end));
    assert!(ends(".git/HEAD") && ends(".git/logs/HEAD"), "{watched:?}");
    fs::write(package.join("file"), "").unwrap();
    assert!(git(&package, &["add", "file"]));
    let (dirty, watched) = build::commit(&package).unwrap();
    assert_eq!(dirty, format!("{clean}-dirty"));
    assert!(
        watched.iter().any(|path| path.ends_with(".git/index")),
        "{watched:?}"
    );
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
