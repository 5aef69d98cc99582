//! Records the commit that the program is built from, so that every run can name it.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let package = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(PathBuf::new, PathBuf::from);
    let (commit, watched) = commit(&package).unwrap_or((String::from("unknown"), Vec::new()));
    println!("cargo::rustc-env=MAXQ_LAB_COMMIT={commit}");
    // Changed sources may make the commit dirty.
    let sources = ["src", "scenarios"].map(|folder| package.join(folder));
    for path in sources.into_iter().chain(watched) {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}

/// Returns the commit of the repository whose top level is the folder `package`, and the files
/// that change with it.
///
/// `None` anywhere else: a package that was unpacked below another repository must not name
/// that repository's commit.
pub fn commit(package: &Path) -> Option<(String, Vec<PathBuf>)> {
    let git = |arguments: &[&str]| {
        let mut git = Command::new("git");
        let git = git
            .current_dir(package)
            .env_remove("GIT_DIR")
            .env_remove("GIT_WORK_TREE");
        let output = git
            .args(arguments)
            .output()
            .ok()
            .filter(|output| output.status.success())?;
        Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
    };
    let top = git(&["rev-parse", "--show-toplevel"])?;
    if Path::new(&top).canonicalize().ok()? != package.canonicalize().ok()? {
        return None;
    }
    let commit = git(&["describe", "--always", "--dirty", "--abbrev=12"])?;
    let paths = ["HEAD", "logs/HEAD", "index"].map(|name| git(&["rev-parse", "--git-path", name]));
    let paths = paths.into_iter().flatten().map(|path| package.join(path));
    // A file that does not exist would count as changed in every build.
    Some((commit, paths.filter(|path| path.exists()).collect()))
}
