//! Finds what the program is made of but nobody lists: the commit, the worlds, the scenarios.

use std::error::Error;
use std::path::{Component, Path, PathBuf};
use std::process::Command;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(env::var("OUT_DIR")?).canonicalize()?;
    println!("cargo::rerun-if-changed=src/build.rs");
    name_commit();
    fs::write(out.join("worlds.rs"), worlds("src/worlds", &out)?)?;
    fs::write(out.join("scenarios.rs"), embedded("scenarios", &out)?)?;
    fs::write(out.join("plans.rs"), embedded("scenarios/studies", &out)?)?;
    Ok(())
}

/// Records the commit that the program is built from, so that every run can name it.
fn name_commit() {
    println!("cargo::rerun-if-changed=.git/HEAD");
    println!("cargo::rerun-if-changed=.git/logs/HEAD");
    let described = Command::new("git")
        .args(["describe", "--always", "--dirty", "--abbrev=12"])
        .output();
    let commit = match described {
        Ok(output) if output.status.success() => {
            String::from_utf8_lossy(&output.stdout).trim().to_owned()
        }
        _ => String::from("unknown"),
    };
    println!("cargo::rustc-env=MAXQ_LAB_COMMIT={commit}");
}

/// The modules of all worlds - the folders in `all` with a `mod.rs` -, and a call of `worlds!` with
/// them, for `src/worlds/mod.rs`.
fn worlds(all: &str, out: &Path) -> Result<String, Box<dyn Error>> {
    let (mut modules, mut list) = (String::new(), String::new());
    for path in entries(all)? {
        let module = path.join("mod.rs");
        // A folder without one is what another branch left behind.
        if !module.is_file() {
            continue;
        }
        println!("cargo::rerun-if-changed={}", module.display());
        let source = fs::read_to_string(&module)?;
        let module = seen_from(out, &module)?;
        let summary = source.lines().next().unwrap_or_default();
        let summary = summary.trim_start_matches("//!").trim();
        let folder = stem(&path)?;
        let name = camel_case(folder);
        modules += &format!("#[path = {module:?}]\npub mod {folder};\n");
        list += &format!("    /// {summary}\n    {name}: {folder:?}, {folder}::{name}Model;\n");
    }
    Ok(format!("{modules}\nworlds! {{\n{list}}}\n"))
}

/// A list of the names and texts of all JSON files in `folder`, for `src/scenario/embedded.rs`.
fn embedded(folder: &str, out: &Path) -> Result<String, Box<dyn Error>> {
    let mut list = String::new();
    for path in entries(folder)?
        .iter()
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
    {
        let (name, path) = (stem(path)?, seen_from(out, path)?);
        list += &format!("    Embedded {{ name: {name:?}, json: include_str!({path:?}) }},\n");
    }
    Ok(format!("&[\n{list}]\n"))
}

/// What is in `folder`, in the order of names; the build is done anew when that changes.
fn entries(folder: &str) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    println!("cargo::rerun-if-changed={folder}");
    let mut paths = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<_>, _>>()?;
    paths.sort_by(|one, other| one.file_stem().cmp(&other.file_stem()));
    Ok(paths)
}

/// The relative path from the folder `out` to `path`. Were it absolute, a checkout that is
/// copied with its target folder would go on being built from the files of the first.
fn seen_from(out: &Path, path: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let path = path.canonicalize()?;
    let pairs = out.components().zip(path.components());
    let shared = pairs.take_while(|(one, other)| one == other).count();
    let up = out.components().skip(shared).map(|_| Component::ParentDir);
    Ok(up.chain(path.components().skip(shared)).collect())
}

fn stem(path: &Path) -> Result<&str, Box<dyn Error>> {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    stem.ok_or_else(|| format!("{}: the name is not UTF-8", path.display()).into())
}

/// `four_rooms` as `FourRooms`.
fn camel_case(snake_case: &str) -> String {
    let mut words = String::new();
    for word in snake_case.split('_') {
        let mut letters = word.chars();
        words.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        words.push_str(letters.as_str());
    }
    words
}
