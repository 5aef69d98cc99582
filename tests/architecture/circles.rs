//! Which files import which, and the circles among them.
//!
//! Every path of a `use` item, and every path that begins with `crate` or `super`, leads to the
//! file that defines the item: re-exports of a `mod.rs` are followed.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The path of a module below the crate; the crate itself is the empty path.
type Module = Vec<String>;

/// The files of a `src` folder as modules.
struct Modules {
    text: BTreeMap<Module, String>,
    uses: BTreeMap<Module, Vec<Use>>,
}

/// A path that a file names, and whether it re-exports it.
struct Use {
    path: Vec<String>,
    exported: bool,
}

/// Returns every group of files that import each other, one path a file.
pub fn circles(src: &Path) -> Vec<Vec<String>> {
    let modules = Modules::read(src);
    let edges: BTreeMap<&Module, BTreeSet<Module>> = modules
        .text
        .keys()
        .map(|module| (module, modules.imports(module)))
        .collect();
    let reach = |from: &Module| {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&Module> = vec![from];
        while let Some(module) = open.pop() {
            for next in &edges[module] {
                if reached.insert(next) {
                    open.push(next);
                }
            }
        }
        reached
    };
    let reached: BTreeMap<&Module, _> = edges
        .keys()
        .map(|&module| (module, reach(module)))
        .collect();
    let mut circles = BTreeSet::new();
    for (module, all) in &reached {
        let group = all.iter().filter(|other| reached[**other].contains(module));
        let group: Vec<String> = group.map(|module| module.join("/")).collect();
        if group.len() > 1 {
            circles.insert(group);
        }
    }
    circles.into_iter().collect()
}

impl Modules {
    fn read(src: &Path) -> Self {
        let mut text = BTreeMap::new();
        read_folder(src, &Vec::new(), &mut text);
        let mut modules = Self {
            uses: text
                .iter()
                .map(|(module, text)| (module.clone(), uses(text)))
                .collect(),
            text,
        };
        for (module, uses) in &mut modules.uses {
            for used in uses.iter_mut() {
                used.path = absolute(module, &used.path, &modules.text).unwrap_or_default();
            }
            uses.retain(|used| !used.path.is_empty());
        }
        modules
    }

    fn imports(&self, module: &Module) -> BTreeSet<Module> {
        let named = self.uses[module].iter().filter(|used| !used.exported);
        let files = named.map(|used| self.defining(&used.path, 0));
        files
            .filter(|file| !file.is_empty() && file != module)
            .collect()
    }

    /// The file that defines what a path names.
    fn defining(&self, path: &[String], depth: usize) -> Module {
        let longest = (0..=path.len())
            .rev()
            .find(|&end| self.text.contains_key(&path[..end]));
        let (module, rest) = path.split_at(longest.unwrap_or(0));
        let Some(item) = rest.first().filter(|_| depth < 6) else {
            return module.to_vec();
        };
        let exported = self.uses[module].iter().filter(|used| used.exported);
        for used in exported {
            let (last, above) = used.path.split_last().unwrap();
            if last == item {
                return self.defining(&[&used.path[..], &rest[1..]].concat(), depth + 1);
            }
            if last == "*" && self.defines(above, item) {
                return above.to_vec();
            }
        }
        module.to_vec()
    }

    fn defines(&self, module: &[String], item: &str) -> bool {
        let text = self.text.get(module).map_or("", |text| text);
        let kinds = ["struct", "enum", "const", "fn", "type", "trait"];
        kinds.iter().any(|kind| {
            let definition = format!("{kind} {item}");
            let mut found = text.match_indices(&definition);
            found.any(|(at, _)| !text[at + definition.len()..].starts_with(is_word))
        })
    }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn read_folder(folder: &Path, module: &Module, text: &mut BTreeMap<Module, String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let below = || [&module[..], &[name.to_owned()]].concat();
        if path.is_dir() {
            read_folder(&path, &below(), text);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let module = match name {
                "main" | "build" => continue,
                "lib" | "mod" => module.clone(),
                _ => below(),
            };
            text.insert(module, code(&fs::read_to_string(path).unwrap()));
        }
    }
}

/// The code of a file without its test module and comments.
fn code(text: &str) -> String {
    let lines = text.lines().take_while(|line| *line != "#[cfg(test)]");
    lines
        .map(|line| line.split("//").next().unwrap_or_default().to_owned() + "\n")
        .collect()
}

/// The paths that a file names.
fn uses(text: &str) -> Vec<Use> {
    let mut uses = Vec::new();
    let mut rest = String::new();
    let mut item: Option<(bool, String)> = None;
    for line in text.lines() {
        if item.is_none() {
            let words = line.trim_start();
            let (exported, words) = match words.strip_prefix("pub") {
                Some(after) if after.starts_with('(') => {
                    (true, after.split_once(") ").map_or("", |(_, words)| words))
                }
                Some(after) => (true, after.trim_start()),
                None => (false, words),
            };
            if let Some(path) = words.strip_prefix("use ") {
                item = Some((exported, path.to_owned()));
            } else {
                rest.push_str(line);
                rest.push('\n');
            }
        } else if let Some((_, path)) = &mut item {
            path.push_str(line);
        }
        if let Some((exported, path)) = item.take_if(|(_, path)| path.contains(';')) {
            let path = path.split(';').next().unwrap();
            let paths = expanded("", path).into_iter();
            uses.extend(paths.map(|path| Use { path, exported }));
        }
    }
    for first in ["crate::", "super::"] {
        for (at, _) in rest.match_indices(first) {
            let before = rest[..at].chars().next_back();
            if before.is_none_or(|c| !is_word(c) && c != ':') {
                let end = rest[at..].find(|c| !is_word(c) && c != ':');
                let path = &rest[at..end.map_or(rest.len(), |end| at + end)];
                let path = path.split("::").filter(|part| !part.is_empty());
                uses.push(Use {
                    path: path.map(str::to_owned).collect(),
                    exported: false,
                });
            }
        }
    }
    uses
}

/// The paths of a `use` tree: `a::{b, c::{d, e}}` names three.
fn expanded(prefix: &str, tree: &str) -> Vec<Vec<String>> {
    let mut depth = 0;
    let parts = tree.split(|c| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    let mut paths = Vec::new();
    for part in parts.map(str::trim).filter(|part| !part.is_empty()) {
        if let Some((outer, inner)) = part.split_once('{') {
            let inner = inner.strip_suffix('}').unwrap_or(inner);
            paths.extend(expanded(&format!("{prefix}{outer}"), inner));
        } else {
            let path = part.split(" as ").next().unwrap();
            let path = format!("{prefix}{path}");
            paths.push(
                path.split("::")
                    .map(|part| part.trim().to_owned())
                    .collect(),
            );
        }
    }
    paths
}

/// A path from the crate down; none of what comes from another crate.
fn absolute(
    module: &Module,
    path: &[String],
    modules: &BTreeMap<Module, String>,
) -> Option<Module> {
    let steps = path
        .iter()
        .take_while(|part| *part == "super" || *part == "self")
        .count();
    if path[0] == "crate" {
        return Some(path[1..].to_vec());
    }
    if steps > 0 {
        let up = path[..steps].iter().filter(|part| *part == "super").count();
        let above = module.len().checked_sub(up)?;
        return Some([&module[..above], &path[steps..]].concat());
    }
    let child = [&module[..], &path[..1]].concat();
    let local = modules.contains_key(&child);
    local.then(|| [&child[..], &path[1..]].concat())
}

/// The check itself: it sees a circle through a re-export, and none where there is none.
#[test]
fn a_circle_through_a_re_export_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    fs::create_dir(folder.path().join("room")).unwrap();
    write("lib.rs", "mod room;\n");
    write(
        "room/mod.rs",
        "mod a;\nmod b;\npub use self::{a::A, b::{B, C as D}};\n",
    );
    write(
        "room/b.rs",
        "use super::a::A;\npub struct B(A);\npub struct C;\n",
    );
    write(
        "room/a.rs",
        "pub struct A; // super::B\n#[cfg(test)]\nmod tests { use super::super::B; }\n",
    );
    assert!(circles(folder.path()).is_empty());
    for import in [
        "use super::B;",
        "pub fn b(_: crate::room::B) {}",
        "use crate::{room::{B}};",
    ] {
        write("room/a.rs", &format!("{import}\npub struct A;\n"));
        assert_eq!(circles(folder.path()), [["room/a", "room/b"]], "{import}");
    }
}
