//! The kept states of a run: which there are, and which can take the place of a damaged checkpoint.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use super::checkpoint::{CheckpointHead, LogPosition};
use super::folder::{EVENTS, GENERATIONS, RunFolder, kept_path};
use super::log::{LogError, check_prefix, checksums};
use super::manifest::Manifest;
use crate::files::{FileError, link_atomically};
use crate::words::shell_path;

/// Returns the generations whose states are kept in a run folder, in order.
#[must_use]
pub fn kept_generations(folder: &Path) -> Vec<u64> {
    let entries = fs::read_dir(folder.join(GENERATIONS)).into_iter().flatten();
    let mut kept: Vec<u64> = entries
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name();
            let digits = name.to_str()?.strip_suffix(".json")?;
            let generation = digits.parse().ok()?;
            (kept_path(folder, generation) == entry.path()).then_some(generation)
        })
        .collect();
    kept.sort_unstable();
    kept
}

/// Returns numbers in order as few words: `1 to 3, 6, 8`.
#[must_use]
pub(super) fn ranges(numbers: &[u64]) -> String {
    let mut ranges: Vec<(u64, u64)> = Vec::new();
    for &number in numbers {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => ranges.push((number, number)),
        }
    }
    let words = ranges.iter().map(|(first, last)| match last - first {
        0 => first.to_string(),
        1 => format!("{first}, {last}"),
        _ => format!("{first} to {last}"),
    });
    let words: Vec<_> = words.collect();
    match words.as_slice() {
        [] => String::from("none"),
        [start @ .., last] if start.len() > MOST => {
            format!("{}, ... {last}", start[..MOST].join(", "))
        }
        all => all.join(", "),
    }
}

/// Most ranges that are listed before the last.
const MOST: usize = 6;

/// Adds to the error of a damaged checkpoint or log which kept state can take its place.
pub(super) fn with_way_out(folder: &Path, manifest: &Manifest, error: FileError) -> FileError {
    let way_out = match usable(folder, manifest) {
        Some(generation) => format!(
            "the kept state after generation {generation} can take its place: maxq-lab resume {} \
             --at {generation}",
            shell_path(folder)
        ),
        None => String::from(
            "no kept state in generations/ can take its place; without checkpoint.json, resuming \
             computes the run again from its start",
        ),
    };
    FileError {
        source: format!("{}; {way_out}", error.source).into(),
        ..error
    }
}

/// Returns the latest generation whose state is whole, of this run, and preceded by a whole log.
fn usable(folder: &Path, manifest: &Manifest) -> Option<u64> {
    let checksums = read_checksums(&folder.join(EVENTS)).unwrap_or_default();
    let is_usable = |generation: &u64| {
        let head = CheckpointHead::read(&kept_path(folder, *generation));
        head.ok().flatten().is_some_and(|head| {
            head.check_origin(&manifest.scenario, manifest.seed).is_ok()
                && checksums.get(&head.events.bytes) == Some(&head.events.crc32)
        })
    };
    let kept = kept_generations(folder);
    kept.into_iter().rev().find(is_usable)
}

/// Lets the run in `folder` stand where it stood after a kept generation, whose log ends at
/// `position`: its state becomes the checkpoint, and what came later is removed, except for the
/// rest of the log. Returns what is dropped, in words.
///
/// # Errors
/// When the log is not the one of the state, or the operating system refuses.
pub(super) fn go_back(
    folder: &RunFolder,
    generation: u64,
    position: LogPosition,
) -> Result<String, FileError> {
    let log = folder.events();
    let lines = lines_after(&log, position).map_err(|error| FileError::new(&log, error))?;
    let kept = kept_generations(folder.path());
    let later: Vec<_> = kept.into_iter().filter(|&kept| kept > generation).collect();
    // If this process dies in between, the log is longer than the checkpoint says, and resuming
    // cuts it off.
    let summary = folder.summary();
    match fs::remove_file(&summary) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            return Err(FileError::new(summary, error));
        }
        _ => {}
    }
    let checkpoint = folder.checkpoint();
    link_atomically(&folder.generation(generation), &checkpoint)
        .map_err(|error| FileError::new(checkpoint, error))?;
    for &later in &later {
        let path = folder.generation(later);
        fs::remove_file(&path).map_err(|error| FileError::new(path, error))?;
    }
    Ok(format!(
        "goes back to generation {generation}; dropped, to be computed again: {lines} lines of \
         {EVENTS}, kept states: {}",
        ranges(&later)
    ))
}

/// Counts the lines of a log after the events before `position`, which must be whole.
fn lines_after(log: &Path, position: LogPosition) -> Result<usize, LogError> {
    let mut reader = BufReader::new(File::open(log)?);
    check_prefix(&mut reader, position)?;
    let (mut lines, mut line) = (0, Vec::new());
    while reader.read_until(b'\n', &mut line)? > 0 {
        lines += 1;
        line.clear();
    }
    Ok(lines)
}

fn read_checksums(path: &Path) -> io::Result<BTreeMap<u64, u32>> {
    checksums(&mut BufReader::new(File::open(path)?))
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn numbers_are_listed_in_ranges() {
        assert_eq!(ranges(&[]), "none");
        assert_eq!(ranges(&[3]), "3");
        assert_eq!(ranges(&[1, 2, 4, 5, 6, 9]), "1, 2, 4 to 6, 9");
        let even: Vec<_> = (1..=20).map(|n| 2 * n).collect();
        assert_eq!(ranges(&even), "2, 4, 6, 8, 10, 12, ... 40");
    }
}
