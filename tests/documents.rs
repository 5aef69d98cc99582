//! Contract: the pages of the repository are true: every command line that they quote is one
//! that the program understands, every file and heading that they name exists, and the README
//! stays short.
//!
//! Why it matters: a stranger trusts the first page, and tries its first command.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use clap::error::ErrorKind;

const LONGEST_README: usize = 12_000;

/// Folders whose paths the pages give in full, from the root of the repository.
const FOLDERS: &[&str] = &[
    "benches/",
    "examples/",
    "scenarios/",
    "snapshots/",
    "src/",
    "tests/",
];

/// The world that the page of worlds adds as an example.
const IMAGINED: &str = "corridor";

struct Page {
    /// Path from the root of the repository.
    path: PathBuf,
    text: String,
}

impl Page {
    /// Returns the lines of shell blocks, continued lines put together.
    fn shell_lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut fence = None;
        for line in self.text.lines() {
            match (fence, line.trim_start().strip_prefix("```")) {
                (None, Some(language)) => fence = Some(language),
                (Some(_), Some(_)) => fence = None,
                (Some("sh"), None) => lines.push(line),
                (Some(_) | None, None) => {}
            }
        }
        let text = lines.join("\n").replace("\\\n", " ");
        text.lines().map(str::to_owned).collect()
    }

    /// Returns the text between single backquotes, outside of blocks.
    fn inline_code(&self) -> Vec<String> {
        let prose: Vec<_> = self.text.split("```").step_by(2).collect();
        let prose = prose.join("\n");
        let paragraphs = prose.split("\n\n");
        let code = paragraphs.flat_map(|paragraph| paragraph.split('`').skip(1).step_by(2));
        code.map(|code| code.replace('\n', " ")).collect()
    }

    /// Returns the targets of links that are files: no web addresses, no items of the code.
    fn links(&self) -> impl Iterator<Item = &str> {
        let targets = self.text.split("](").skip(1);
        let targets = targets.filter_map(|rest| rest.split_once(')').map(|(target, _)| target));
        targets.filter(|target| !target.contains("://") && !target.contains("::"))
    }

    /// Returns the anchors of the headings.
    fn anchors(&self) -> Vec<String> {
        let headings = self.text.lines().filter(|line| line.starts_with('#'));
        let anchor = |heading: &str| {
            let words = heading.trim_start_matches('#').trim().to_lowercase();
            let kept = words
                .chars()
                .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        };
        headings.map(anchor).collect()
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn pages() -> Vec<Page> {
    let mut folders = vec![root().to_owned()];
    let mut pages = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            let is_ours = !["target", "runs", "studies", "shared"].contains(&name.as_str());
            if path.is_dir() && !name.starts_with('.') && (is_ours || folder != root()) {
                folders.push(path);
            } else if name.ends_with(".md") {
                let text = fs::read_to_string(&path).unwrap();
                let path = path.strip_prefix(root()).unwrap().to_owned();
                pages.push(Page { path, text });
            }
        }
    }
    assert!(pages.len() >= 5, "the pages were not found");
    pages
}

/// Splits a line of shell into commands of words: quotes, comments, `|`, `;` and `>` are
/// understood, and that is all.
fn commands(line: &str) -> Vec<Vec<String>> {
    let mut commands = vec![Vec::new()];
    let mut word: Option<String> = None;
    let mut quote = None;
    let finish = |word: &mut Option<String>, commands: &mut Vec<Vec<String>>| {
        commands.last_mut().unwrap().extend(word.take());
    };
    for c in line.chars() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), c) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '#') if word.is_none() => break,
            (None, '|' | ';' | '>' | '&') => {
                finish(&mut word, &mut commands);
                commands.push(Vec::new());
            }
            (None, ' ') => finish(&mut word, &mut commands),
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    finish(&mut word, &mut commands);
    commands
}

/// Returns the arguments of the program, where the command runs it.
fn arguments(command: &[String]) -> Option<&[String]> {
    let words: Vec<_> = command.iter().map(String::as_str).collect();
    match words[..] {
        ["maxq-lab", ..] => Some(command),
        // `cargo run --release -- ARGUMENTS`: the words from `--` on, which takes the place of
        // the program's name.
        ["cargo", "run", ..] => {
            let from = words.iter().position(|&word| word == "--")?;
            Some(&command[from..])
        }
        _ => None,
    }
}

#[test]
fn the_readme_is_short() {
    let length = fs::read(root().join("README.md")).unwrap().len();
    assert!(
        length <= LONGEST_README,
        "README.md has {length} bytes; allowed: {LONGEST_README}"
    );
}

#[test]
fn every_quoted_command_line_is_understood() {
    let mut count = 0;
    for page in pages() {
        for line in page.shell_lines() {
            for command in commands(&line) {
                let Some(arguments) = arguments(&command) else {
                    continue;
                };
                let parsed = maxq_lab::cli::command().try_get_matches_from(arguments);
                assert!(
                    parsed.is_ok(),
                    "{}: {line}\n{parsed:?}",
                    page.path.display()
                );
                count += 1;
            }
        }
    }
    assert!(count > 40, "only {count} command lines were found");
}

/// Prose leaves arguments out, and writes `maxq-lab study merge` alone.
#[test]
fn every_command_in_prose_exists() {
    for page in pages() {
        for code in page.inline_code() {
            for command in commands(&code) {
                let Some(arguments) = arguments(&command) else {
                    continue;
                };
                if let Err(error) = maxq_lab::cli::command().try_get_matches_from(arguments) {
                    let incomplete = [
                        ErrorKind::MissingRequiredArgument,
                        ErrorKind::MissingSubcommand,
                        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand,
                    ];
                    let path = page.path.display();
                    assert!(
                        incomplete.contains(&error.kind()),
                        "{path}: {code}\n{error}"
                    );
                }
            }
        }
    }
}

#[test]
fn every_benchmark_and_test_that_is_named_exists() {
    for page in pages() {
        let code = [page.shell_lines(), page.inline_code()].concat();
        for command in code.iter().flat_map(|line| commands(line)) {
            for pair in command.windows(2) {
                let places = match pair[0].as_str() {
                    "--bench" => vec![format!("benches/{}.rs", pair[1])],
                    "--example" => vec![format!("examples/{}.rs", pair[1])],
                    "--test" => vec![
                        format!("tests/{}.rs", pair[1]),
                        format!("tests/{}/main.rs", pair[1]),
                    ],
                    _ => continue,
                };
                let exists = places.iter().any(|place| root().join(place).exists());
                assert!(exists, "{}: {}", page.path.display(), pair.join(" "));
            }
        }
    }
}

#[test]
fn every_file_that_a_page_names_exists() {
    let pages = pages();
    for page in &pages {
        let folder = root().join(&page.path).parent().unwrap().to_owned();
        for link in page.links() {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() {
                root().join(&page.path)
            } else {
                folder.join(file)
            };
            let path = page.path.display();
            assert!(target.exists(), "{path} links to {link}");
            if !anchor.is_empty() {
                let target = target.canonicalize().unwrap();
                let place = target.strip_prefix(root().canonicalize().unwrap()).unwrap();
                let linked = pages.iter().find(|page| page.path == place).unwrap();
                let found = linked.anchors().iter().any(|found| found == anchor);
                assert!(found, "{path} links to {link}, which has no such heading");
            }
        }
        for code in page.inline_code() {
            let named = FOLDERS.iter().any(|folder| code.starts_with(folder));
            let is_path = named && !code.contains(['*', ' ']) && !code.contains(IMAGINED);
            assert!(
                !is_path || root().join(&code).exists(),
                "{} names {code}",
                page.path.display()
            );
        }
    }
}

/// The walks through the house in `src/lib.rs` name files and functions.
#[test]
fn the_walks_through_the_house_lead_through_real_rooms() {
    let page = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    let mut count = 0;
    for line in page.lines().filter(|line| line.contains(".rs`, `")) {
        let (place, _) = line.split_once(": ").unwrap();
        let mut names = place.split('`').skip(1).step_by(2);
        let file = names.next().unwrap();
        let source = fs::read_to_string(root().join("src").join(file));
        let source = source.unwrap_or_else(|error| panic!("src/{file}: {error}"));
        for name in names {
            let is_there = ["(", "<"].map(|open| source.contains(&format!("fn {name}{open}")));
            assert!(is_there.contains(&true), "src/{file} has no {name}: {line}");
            count += 1;
        }
    }
    assert!(count > 20, "the walks were not found");
}

#[test]
fn the_citation_can_be_read() {
    let text = fs::read_to_string(root().join("CITATION.cff")).unwrap();
    let citation: serde_json::Value = serde_yaml_ng::from_str(&text).unwrap();
    assert_eq!(citation["cff-version"], "1.2.0");
    assert_eq!(citation["version"], env!("CARGO_PKG_VERSION"));
    for field in ["message", "title"] {
        assert!(citation[field].is_string(), "{field}");
    }
    for field in ["authors", "references"] {
        assert!(!citation[field].as_array().unwrap().is_empty(), "{field}");
    }
}

#[test]
fn the_check_of_commands_sees_what_it_should() {
    let words = |line| commands(line).concat().join(",");
    assert_eq!(
        words("maxq-lab tree show '(Root A)' # draws"),
        "maxq-lab,tree,show,(Root A)"
    );
    assert_eq!(commands("maxq-lab a | b; c > d").len(), 4);
    assert_eq!(words(r#"T='"(Root)"'"#), r#"T="(Root)""#);
    let cargo = &commands("cargo run --release -- run smoke")[0];
    assert_eq!(arguments(cargo).unwrap(), ["--", "run", "smoke"]);
}
