//! The lock of a run folder: one process at a time works on a run.
//!
//! The file `lock` is locked by the operating system. Where the file system cannot lock files (some
//! Lustre, FUSE and NFS mounts), `owner.json` stands in: it names the process and its machine, and
//! the process rewrites it as long as it works. A file that was not rewritten for a while, or whose
//! process does not exist on this machine, is that of a dead process.
//!
//! A lock is an aid against misuse, so a run never fails for want of one.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};
use std::time::{Duration, SystemTime};

use crossbeam_channel::{RecvTimeoutError, Sender, bounded};
use serde::{Deserialize, Serialize};

use super::folder_error::FolderError;
use super::manifest::host_name;
use super::pulse::PULSE_FILE;
use crate::files::{FileError, WRITING, is_unsupported, read_bytes};

/// Name of the file that the process working on a run keeps locked.
pub(super) const LOCK: &str = "lock";
/// Name of the file that names this process, where files cannot be locked.
pub(super) const OWNER: &str = "owner.json";

/// Largest `owner.json` or `pulse.json` that is read, in bytes.
const MAX_OWNER_BYTES: u64 = 1 << 16;

/// Time between two writes of `owner.json`.
const BEAT: Duration = Duration::from_secs(2);

/// Age at which an `owner.json` counts as left by a dead process. A busy file server may take
/// seconds for a write.
const STALE: Duration = Duration::from_secs(30);

/// The lock of a run folder; it is released when this is dropped.
#[derive(Debug)]
pub(super) enum RunLock {
    /// A lock of the operating system.
    System {
        /// Held until it is dropped.
        _held: SystemLock,
    },
    /// A file that is kept alive.
    Owner(OwnerFile),
}

impl RunLock {
    /// Takes the lock of `folder`, which errors call `shown`.
    ///
    /// # Errors
    /// When another process holds it, or the operating system refuses to create a file.
    pub(super) fn take(folder: &Path, shown: &Path) -> Result<Self, FolderError> {
        let in_use = || FolderError::InUse {
            path: shown.display().to_string(),
        };
        let refused = |error: io::Error| FileError::new(shown.join(LOCK), error);
        let path = folder.join(LOCK);
        let mut open = OpenOptions::new();
        let open = open.create(true).truncate(false).write(true);
        let file = open.open(&path).map_err(refused)?;
        let locked = match file.try_lock() {
            Ok(()) => Some(SystemLock(file)),
            Err(TryLockError::WouldBlock) => return Err(in_use()),
            Err(TryLockError::Error(error)) if cannot_lock(&error) => None,
            Err(TryLockError::Error(error)) => return Err(refused(error).into()),
        };
        // A machine on which files cannot be locked may work on the run.
        let found = Owner::read(&folder.join(OWNER));
        if found.as_ref().is_some_and(|found| found.lives(folder)) {
            return Err(in_use());
        }
        if let Some(lock) = locked {
            return Ok(Self::System { _held: lock });
        }
        // A machine on which files can be locked has no owner.json, but a pulse.
        if Owner::read(&folder.join(PULSE_FILE)).is_some_and(|pulse| pulse.lives(folder)) {
            return Err(in_use());
        }
        match OwnerFile::create(folder, found) {
            Ok(owner) => Ok(Self::Owner(owner)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(in_use()),
            Err(error) => Err(FileError::new(shown.join(OWNER), error).into()),
        }
    }

    /// Follows the folder to its new path.
    pub(super) fn moved_to(&mut self, folder: &Path) {
        if let Self::Owner(owner) = self {
            owner.path = folder.join(OWNER);
        }
    }

    /// Returns what a user should know where files cannot be locked.
    pub(super) fn warning(&self) -> Option<String> {
        match self {
            Self::System { .. } => None,
            Self::Owner(_) => Some(unlocked()),
        }
    }

    /// Checks that no other process has taken the folder over.
    ///
    /// # Errors
    /// When one has: this process was suspended for long, or could not reach the folder.
    pub(super) fn check_ours(&self) -> io::Result<()> {
        let Self::Owner(owner) = self else {
            return Ok(());
        };
        match Owner::read(&owner.path) {
            Some(found) if found.process.as_ref() != Some(&owner.owner) => Err(io::Error::other(
                "another process works on this run now: this one gave no sign of life for long",
            )),
            _ => Ok(()),
        }
    }
}

/// Returns what a user should know if files in `folder` cannot be locked.
#[must_use]
pub fn lock_warning(folder: &Path) -> Option<String> {
    let probe = tempfile::Builder::new().prefix(WRITING).tempfile_in(folder);
    match probe.ok()?.as_file().try_lock() {
        Err(TryLockError::Error(error)) if cannot_lock(&error) => Some(unlocked()),
        _ => None,
    }
}

fn unlocked() -> String {
    format!(
        "files cannot be locked here; {OWNER} guards a run folder instead, and after a crash \
         another machine waits {} seconds before it takes a run over",
        STALE.as_secs()
    )
}

/// Returns whether an error of locking says that files cannot be locked here.
fn cannot_lock(error: &io::Error) -> bool {
    use rustix::io::Errno;
    is_unsupported(error) || Errno::from_io_error(error) == Some(Errno::NOLCK)
}

/// A locked file.
///
/// It is released explicitly: a child process that another thread starts at this moment inherits
/// the open file, and closing it here alone would not release the lock.
#[derive(Debug)]
pub(super) struct SystemLock(File);

impl Drop for SystemLock {
    fn drop(&mut self) {
        // If this fails, closing the file releases the lock.
        let _ = self.0.unlock();
    }
}

/// The process that a file names; other fields of the file are ignored.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Process {
    /// Name of the machine.
    host: String,
    /// Process id on that machine.
    process: u32,
    /// When the process took the folder, in nanoseconds: tells two processes with one id apart.
    #[serde(default)]
    since: u64,
}

impl Process {
    fn this() -> Self {
        let since = SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default();
        Self {
            host: host_name(),
            process: std::process::id(),
            since: u64::try_from(since.as_nanos()).unwrap_or(u64::MAX),
        }
    }
}

/// What a file says of its owner.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Owner {
    /// `None` if the file cannot be read: perhaps it is being written.
    process: Option<Process>,
    /// When the file was written last.
    written: SystemTime,
}

impl Owner {
    /// Reads the file at `path`; returns `None` if there is no file.
    fn read(path: &Path) -> Option<Self> {
        let written = fs::metadata(path).and_then(|data| data.modified()).ok()?;
        let bytes = read_bytes(path, MAX_OWNER_BYTES).ok();
        Some(Self {
            process: bytes.and_then(|bytes| serde_json::from_slice(&bytes).ok()),
            written,
        })
    }

    /// Returns whether this is the file of a process which works in `folder` now.
    fn lives(&self, folder: &Path) -> bool {
        let age = now_in(folder).duration_since(self.written);
        let is_dead = |process: &Process| is_dead(&process.host, process.process);
        age.unwrap_or_default() < STALE && !self.process.as_ref().is_some_and(is_dead)
    }
}

/// Returns the present time by the clock that dates the files in `folder`: that of a file server
/// may differ from that of this machine.
fn now_in(folder: &Path) -> SystemTime {
    let dated = || {
        let mut probe = tempfile::Builder::new()
            .prefix(WRITING)
            .tempfile_in(folder)?;
        probe.write_all(b"now")?;
        probe.as_file().metadata()?.modified()
    };
    dated().unwrap_or_else(|_: io::Error| SystemTime::now())
}

/// Returns whether a process is known to be dead: it ran on this machine and does not exist.
pub(super) fn is_dead(host: &str, process: u32) -> bool {
    use rustix::io::Errno;
    use rustix::process::{Pid, test_kill_process};
    let process = i32::try_from(process).ok().and_then(Pid::from_raw);
    host == host_name()
        && process.is_some_and(|process| test_kill_process(process).err() == Some(Errno::SRCH))
}

/// `owner.json`, which a thread rewrites; dropping this stops the thread and removes the file.
#[derive(Debug)]
pub(super) struct OwnerFile {
    path: PathBuf,
    owner: Process,
    beating: Option<(Sender<()>, JoinHandle<()>)>,
}

impl OwnerFile {
    /// Creates the file in `folder`, in the place of the file `dead` that a dead process has left.
    ///
    /// # Errors
    /// With [`ErrorKind::AlreadyExists`] when another process was faster.
    fn create(folder: &Path, dead: Option<Owner>) -> io::Result<Self> {
        let path = folder.join(OWNER);
        if let Some(dead) = dead {
            remove(&path, &dead)?;
        }
        let owner = Process::this();
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&path)?;
        let bytes = serde_json::to_vec(&owner)?;
        file.write_all(&bytes)?;
        Ok(Self {
            path,
            owner,
            beating: beat(file, bytes)?,
        })
    }
}

impl Drop for OwnerFile {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.beating.take() {
            drop(stop);
            // A panicked thread has stopped too.
            let _ = thread.join();
        }
        let found = Owner::read(&self.path).and_then(|found| found.process);
        if found.as_ref() == Some(&self.owner) {
            let _stays = fs::remove_file(&self.path);
        }
    }
}

/// Removes the file of the process `dead`. Of several processes that try at once, one succeeds.
fn remove(path: &Path, dead: &Owner) -> io::Result<()> {
    let aside = path.with_file_name(format!("{WRITING}owner-{}", std::process::id()));
    match fs::rename(path, &aside) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        renamed => renamed?,
    }
    if Owner::read(&aside).as_ref() == Some(dead) {
        return fs::remove_file(&aside);
    }
    // Another process has taken the folder meanwhile.
    fs::rename(&aside, path)?;
    Err(ErrorKind::AlreadyExists.into())
}

/// Starts the thread that rewrites the file.
///
/// It writes through the open file, which follows the folder to a new name; and it writes instead
/// of setting a time, so that the file server's clock dates the file.
fn beat(mut file: File, bytes: Vec<u8>) -> io::Result<Option<(Sender<()>, JoinHandle<()>)>> {
    let (stop, stopped) = bounded(0);
    let thread = thread::Builder::new()
        .name(String::from("owner"))
        .spawn(move || {
            while stopped.recv_timeout(BEAT) == Err(RecvTimeoutError::Timeout) {
                let start = file.seek(SeekFrom::Start(0));
                let _ignored = start.and_then(|_| file.write_all(&bytes));
            }
        })?;
    Ok(Some((stop, thread)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder whose `owner.json` names a process and was written `age` ago.
    fn owned_by(host: &str, process: u32, age: Duration) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let owner = Process {
            host: host.to_owned(),
            process,
            since: 1,
        };
        let file = File::create(folder.path().join(OWNER)).unwrap();
        serde_json::to_writer(&file, &owner).unwrap();
        file.set_modified(SystemTime::now() - age).unwrap();
        folder
    }

    #[test]
    fn a_living_owner_keeps_the_folder_and_a_dead_one_loses_it() {
        let own = std::process::id();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        child.wait().unwrap();
        let (fresh, old) = (Duration::from_secs(5), STALE + Duration::from_secs(5));
        let cases = [
            ("elsewhere", own, fresh, true),
            ("elsewhere", own, old, false),
            (&host_name(), own, fresh, true),
            (&host_name(), own, old, false),
            (&host_name(), child.id(), fresh, false),
        ];
        for (host, process, age, is_kept) in cases {
            let folder = owned_by(host, process, age);
            let taken = RunLock::take(folder.path(), Path::new("shown"));
            assert_eq!(taken.is_err(), is_kept, "{host} {process} {age:?}");
            if let Err(error) = taken {
                assert!(error.to_string().starts_with("shown: another process"));
            }
        }
    }

    #[test]
    fn an_owner_notices_when_it_was_taken_for_dead() {
        let folder = tempfile::tempdir().unwrap();
        let lock = RunLock::Owner(OwnerFile::create(folder.path(), None).unwrap());
        assert!(lock.check_ours().is_ok());
        assert!(lock.warning().is_some());
        let other = owned_by("elsewhere", 1, Duration::ZERO);
        fs::copy(other.path().join(OWNER), folder.path().join(OWNER)).unwrap();
        assert!(lock.check_ours().is_err());
        drop(lock);
        assert!(folder.path().join(OWNER).exists(), "it is not ours");
    }

    #[test]
    fn the_owner_file_goes_with_its_process_and_follows_its_folder() {
        let parent = tempfile::tempdir().unwrap();
        let (hidden, shown) = (parent.path().join("hidden"), parent.path().join("shown"));
        fs::create_dir(&hidden).unwrap();
        let mut lock = RunLock::Owner(OwnerFile::create(&hidden, None).unwrap());
        let second = OwnerFile::create(&hidden, None).map(|_| ());
        assert_eq!(second.unwrap_err().kind(), ErrorKind::AlreadyExists);
        fs::rename(&hidden, &shown).unwrap();
        lock.moved_to(&shown);
        assert!(RunLock::take(&shown, &shown).is_err());
        drop(lock);
        let left = fs::read_dir(&shown).unwrap();
        let left: Vec<_> = left.map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, [LOCK]);
    }
}
