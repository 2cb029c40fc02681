//! One process at a time works on a run.
//!
//! The file `lock` names the holder: host, boot, process, since when, and a beat that the holder raises
//! every few seconds. On one machine `flock` decides: it ends with its process, however that ends. On a
//! disk that hosts share `flock` may reach across them or not, depending on how it is mounted; a holder
//! of another boot is therefore watched, and taken for dead only if its beat stands still.

use crate::exit::{Code, Failure};
use crate::files::open_in_run;
use crate::output::{Plain, note};
use rustix::fs::{FlockOperation, OFlags, flock, fstatfs};
use rustix::io::Errno;
use rustix::system::uname;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io;
use std::os::unix::fs::{FileExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// The file in a run folder; empty when nobody works on it.
pub const LOCK: &str = "lock";

const BEAT: Duration = Duration::from_secs(5);
const WATCH_PAUSE: Duration = Duration::from_millis(100);
const LOCK_PAUSE: Duration = Duration::from_millis(10);
/// Room for the holder, and more: the file is written in one piece.
const BYTES: usize = 512;

/// Kinds of file systems that no other host mounts, by the magic numbers of `statfs(2)`: ext2 to ext4,
/// XFS, Btrfs, ZFS, F2FS, tmpfs, overlayfs.
const LOCAL: [u64; 7] =
    [0xEF53, 0x5846_5342, 0x9123_683E, 0x2FC1_2FC1, 0xF2F5_2010, 0x0102_1994, 0x794C_7630];

/// Who works on a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Holder {
    /// Name of the host.
    pub host: String,
    /// What tells this start of its kernel from all others.
    pub boot: String,
    /// The process.
    pub pid: u32,
    /// When the process was started, in ticks since the boot.
    pub started: u64,
    /// When it took the run, in seconds since 1970.
    pub since: u64,
    /// Raised every few seconds.
    pub beat: u64,
}

impl Holder {
    /// Who holds the run, as far as its file tells.
    pub fn read(folder: &Path) -> Option<Holder> {
        read(&folder.join(LOCK))
    }

    /// Whether the holder is at work; `None` where that cannot be told from here.
    pub fn lives(&self) -> Option<bool> {
        (self.boot == boot()).then(|| started(self.pid) == Some(self.started))
    }

    fn is_same(&self, other: &Holder) -> bool {
        (&self.boot, self.pid, self.started) == (&other.boot, other.pid, other.started)
    }
}

impl std::fmt::Display for Holder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let host = Plain(&self.host);
        write!(f, "process {} on host {host} since {}", self.pid, utc(self.since))
    }
}

/// How a holder of another boot is told from a dead one.
struct Caution {
    /// Whether the file system is trusted to be this host's alone.
    is_local: fn(&File) -> bool,
    /// How long the beat is watched.
    watch: Duration,
    /// How long others who have watched as long get to write their names.
    settle: Duration,
    /// How long a lock is waited for whose holder is dead. A worker process that the holder was about to start when
    /// it was killed has the lock, too, until it runs its program.
    children: Duration,
}

const CAUTION: Caution = Caution {
    is_local,
    watch: Duration::from_secs(30),
    settle: Duration::from_secs(2),
    children: Duration::from_secs(10),
};

/// How long a lock is waited for that is to be had at once: as long as a child takes to run its program on a busy machine.
const AT_ONCE: Duration = Duration::from_secs(2);

/// A run held by this process.
#[derive(Debug)]
pub struct RunLock {
    path: PathBuf,
    file: File,
    holder: Holder,
    last_beat: Instant,
    /// Whether other hosts may be looking.
    is_shared: bool,
}

impl RunLock {
    /// Takes hold of a run folder. A holder on another host is watched first, unless `is_ended` says
    /// that there is no time for that.
    ///
    /// # Errors
    /// Exit code 2: another process holds the run; 1: the system refuses.
    pub fn take(folder: &Path, is_ended: impl Fn() -> bool) -> Result<RunLock, Failure> {
        RunLock::take_with(folder, &CAUTION, is_ended)
    }

    fn take_with(
        folder: &Path,
        caution: &Caution,
        is_ended: impl Fn() -> bool,
    ) -> Result<RunLock, Failure> {
        let path = folder.join(LOCK);
        let (file, is_locked) = lock(folder, &path, caution, &is_ended)?;
        let is_shared = !(is_locked && (caution.is_local)(&file));
        let is_dead = |other: &Holder| !is_shared || is_locked && other.boot == boot();
        let other = read(&path).filter(|other| !is_dead(other));
        let watched = other.is_some();
        if let Some(other) = other {
            let begun = Instant::now();
            note(format_args!(
                "{}: {other} held it; watching for a sign of life",
                folder.display()
            ));
            while begun.elapsed() < caution.watch {
                if is_ended() {
                    return Err(interrupted());
                }
                sleep(WATCH_PAUSE);
                if read(&path).is_none_or(|now| now != other) {
                    return Err(held(folder, read(&path).as_ref()));
                }
            }
        }
        let holder = Holder {
            host: uname().nodename().to_string_lossy().into_owned(),
            boot: boot(),
            pid: std::process::id(),
            started: started(std::process::id()).unwrap_or_default(),
            since: SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs(),
            beat: 0,
        };
        let lock = RunLock { path, file, holder, last_beat: Instant::now(), is_shared };
        lock.write()
            .map_err(|error| Failure::system(format!("{}: {error}", lock.path.display())))?;
        if watched {
            // Another may have watched as long; the last to write has it.
            sleep(caution.settle);
            lock.confirm()?;
        }
        Ok(lock)
    }

    /// Takes hold of a run folder at once, or not at all where anybody may be at work on it. A child that a dead holder was
    /// about to start has the lock for a moment, too.
    pub(super) fn take_if_free(folder: &Path) -> Option<RunLock> {
        let other = Holder::read(folder);
        let is_nobodys = other.is_none_or(|other| other.lives() == Some(false));
        let caution = Caution { children: AT_ONCE, ..CAUTION };
        is_nobodys.then(|| RunLock::take_with(folder, &caution, || false).ok())?
    }

    /// The run folder has been moved here, with the lock in it.
    pub(super) fn moved(&mut self, folder: &Path) {
        self.path = folder.join(LOCK);
    }

    /// Shows a sign of life if it is time, after looking whether the run is still held: a process that
    /// slept for long may have been taken for dead.
    ///
    /// # Errors
    /// Exit code 1: another process has taken the run over.
    pub fn beat(&mut self) -> Result<(), Failure> {
        if self.last_beat.elapsed() < BEAT {
            return Ok(());
        }
        self.confirm()?;
        self.last_beat = Instant::now();
        self.holder.beat += 1;
        // A disk that is full for a moment is the ledger's business, which says so.
        let _ = self.write();
        Ok(())
    }

    fn confirm(&self) -> Result<(), Failure> {
        match read(&self.path) {
            Some(now) if now.is_same(&self.holder) => Ok(()),
            Some(other) => {
                let path = self.path.display();
                Err(Failure::system(format!("{path}: {other} has taken the run over")))
            }
            None => Err(Failure::system(format!("{}: the lock is gone", self.path.display()))),
        }
    }

    fn write(&self) -> io::Result<()> {
        let mut text = serde_json::to_vec(&self.holder)?;
        text.resize(BYTES.max(text.len() + 1) - 1, b' ');
        text.push(b'\n');
        self.file.write_all_at(&text, 0)?;
        // Other hosts see what has been sent to the server.
        if self.is_shared { self.file.sync_data() } else { Ok(()) }
    }
}

impl Drop for RunLock {
    fn drop(&mut self) {
        if self.confirm().is_ok() {
            // Left as it is it would be a dead holder's.
            let _ = self.file.set_len(0);
        }
    }
}

/// Opens the file and locks it; whether the file system knows such locks.
fn lock(
    folder: &Path,
    path: &Path,
    caution: &Caution,
    is_ended: &impl Fn() -> bool,
) -> Result<(File, bool), Failure> {
    let cannot = |error: io::Error| {
        Failure::system(format!("{}: cannot lock the run: {error}", path.display()))
    };
    let begun = Instant::now();
    loop {
        let file = open_in_run(path, OFlags::RDWR | OFlags::CREATE).map_err(cannot)?;
        match flock(&file, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) if is_at(path, &file) => return Ok((file, true)),
            // Another run has taken the place of this one meanwhile: it is that one's lock that counts.
            Ok(()) => {}
            Err(Errno::WOULDBLOCK) => {
                let holder = read(path);
                // A lock without a holder is being taken, or a child has it that its holder, who is gone, was about to start.
                let is_dead = holder.as_ref().is_none_or(|other| other.lives() == Some(false));
                if !is_dead || begun.elapsed() >= caution.children {
                    return Err(held(folder, holder.as_ref()));
                }
                sleep(LOCK_PAUSE);
            }
            // Some shared file systems know no such locks.
            Err(Errno::NOSYS | Errno::NOTSUP | Errno::NOLCK | Errno::INVAL) => {
                return Ok((file, false));
            }
            Err(error) => return Err(cannot(error.into())),
        }
        if is_ended() {
            return Err(interrupted());
        }
    }
}

/// Whether the file at `path` is this one.
fn is_at(path: &Path, file: &File) -> bool {
    match (fs::symlink_metadata(path), file.metadata()) {
        (Ok(now), Ok(opened)) => (now.dev(), now.ino()) == (opened.dev(), opened.ino()),
        _ => false,
    }
}

fn interrupted() -> Failure {
    Failure::new(Code::Interrupted, "a signal came")
}

/// The refusal of a run that somebody holds.
pub(super) fn held(folder: &Path, holder: Option<&Holder>) -> Failure {
    let holder = holder.map_or_else(|| "another process".to_owned(), Holder::to_string);
    Failure::usage(format!("{}: {holder} works on this run", folder.display()))
}

fn read(path: &Path) -> Option<Holder> {
    let mut bytes = [0; 4 * BYTES];
    // Opened anew each time, which makes network file systems look.
    let length = open_in_run(path, OFlags::RDONLY).and_then(|file| file.read_at(&mut bytes, 0));
    let length = length.ok()?;
    serde_json::from_slice(&bytes[..length]).ok()
}

fn is_local(file: &File) -> bool {
    fstatfs(file).is_ok_and(|system| LOCAL.contains(&(system.f_type as u64 & 0xFFFF_FFFF)))
}

fn boot() -> String {
    let id = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    id.trim().to_owned()
}

/// When a process was started; `None` if there is none of this id.
pub(crate) fn started(pid: u32) -> Option<u64> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The name before the last parenthesis may hold anything; field 22 is the 20th after it.
    stat.rsplit(')').next()?.split_whitespace().nth(19)?.parse().ok()
}

/// A time as people write it, in UTC.
fn utc(seconds: u64) -> String {
    let (days, second) = (seconds / 86400, seconds % 86400);
    // Days to civil date by H. Hinnant, http://howardhinnant.github.io/date_algorithms.html
    let z = days + 719_468;
    let (era, day_of_era) = (z / 146_097, z % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 { shifted_month + 3 } else { shifted_month - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    let (hour, minute) = (second / 3600, second / 60 % 60);
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02} UTC")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As on a disk that other hosts mount, with less patience.
    const SHARED: Caution = Caution {
        is_local: |_| false,
        watch: Duration::from_millis(300),
        settle: Duration::from_millis(10),
        children: Duration::from_secs(60),
    };

    fn left_by(boot: &str) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let lock = RunLock::take(folder.path(), || false).unwrap();
        let holder = Holder { boot: boot.to_owned(), pid: 1, started: 5, ..lock.holder.clone() };
        drop(lock);
        std::fs::write(folder.path().join(LOCK), serde_json::to_vec(&holder).unwrap()).unwrap();
        folder
    }

    #[test]
    fn a_run_has_one_holder_and_is_free_when_it_ends() {
        let folder = tempfile::tempdir().unwrap();
        let lock = RunLock::take(folder.path(), || false).unwrap();
        let holder = Holder::read(folder.path()).unwrap();
        assert_eq!((holder.pid, holder.lives()), (std::process::id(), Some(true)));
        let refused = RunLock::take(folder.path(), || false).unwrap_err();
        assert!(
            refused.message.contains(&format!("process {} on host", holder.pid)),
            "{refused:?}"
        );
        drop(lock);
        assert_eq!(Holder::read(folder.path()), None);
        RunLock::take(folder.path(), || false).unwrap();
    }

    #[test]
    fn what_the_dead_of_this_boot_left_is_taken_over() {
        let folder = left_by(&boot());
        assert_eq!(Holder::read(folder.path()).unwrap().lives(), Some(false));
        RunLock::take_with(folder.path(), &SHARED, || true).unwrap();
    }

    #[test]
    fn a_holder_on_another_host_is_watched_and_taken_over_only_if_its_beat_stands_still() {
        let folder = left_by("another");
        assert_eq!(Holder::read(folder.path()).unwrap().lives(), None);
        let ended = RunLock::take_with(folder.path(), &SHARED, || true).unwrap_err();
        assert_eq!(ended.code, crate::exit::Code::Interrupted);
        let lock = RunLock::take_with(folder.path(), &SHARED, || false).unwrap();
        drop(lock);

        let folder = left_by("another");
        let path = folder.path().join(LOCK);
        let refused = std::thread::scope(|scope| {
            scope.spawn(|| {
                sleep(Duration::from_millis(100));
                let mut holder = read(&path).unwrap();
                holder.beat += 1;
                std::fs::write(&path, serde_json::to_vec(&holder).unwrap()).unwrap();
            });
            RunLock::take_with(
                folder.path(),
                &Caution { watch: Duration::from_secs(60), ..SHARED },
                || false,
            )
        });
        assert_eq!(refused.unwrap_err().code, crate::exit::Code::Usage);
    }

    #[test]
    fn a_holder_that_slept_while_another_took_over_notices() {
        let folder = tempfile::tempdir().unwrap();
        let mut lock = RunLock::take(folder.path(), || false).unwrap();
        lock.last_beat -= BEAT;
        lock.beat().unwrap();
        assert_eq!(Holder::read(folder.path()).unwrap().beat, 1);
        let other = Holder { boot: "another".to_owned(), ..lock.holder.clone() };
        std::fs::write(folder.path().join(LOCK), serde_json::to_vec(&other).unwrap()).unwrap();
        lock.last_beat -= BEAT;
        assert!(lock.beat().unwrap_err().message.contains("has taken the run over"));
        drop(lock);
        assert_eq!(Holder::read(folder.path()), Some(other), "what is another's stays");
    }

    /// As a worker process that was about to be started when its coordinator was killed.
    #[test]
    fn a_lock_that_only_a_dead_holders_child_has_is_waited_for() {
        let folder = left_by(&boot());
        let path = folder.path().join(LOCK);
        let child = File::options().read(true).write(true).open(&path).unwrap();
        flock(&child, FlockOperation::NonBlockingLockExclusive).unwrap();
        let impatient = Caution { children: Duration::ZERO, ..CAUTION };
        let refused = RunLock::take_with(folder.path(), &impatient, || false).unwrap_err();
        assert!(refused.message.contains("works on this run"), "{refused}");
        assert!(RunLock::take_if_free(folder.path()).is_none());
        std::thread::scope(|scope| {
            scope.spawn(|| {
                sleep(Duration::from_millis(50));
                drop(child);
            });
            RunLock::take_with(folder.path(), &SHARED, || false).unwrap();
        });
    }

    #[test]
    fn the_lock_of_a_run_that_was_replaced_meanwhile_is_not_the_runs() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(LOCK);
        let old = File::create(&path).unwrap();
        fs::rename(&path, folder.path().join("old")).unwrap();
        fs::write(&path, "").unwrap();
        assert!(!is_at(&path, &old));
        let lock = RunLock::take(folder.path(), || false).unwrap();
        assert!(is_at(&path, &lock.file));
    }

    #[test]
    fn a_lock_that_is_a_link_or_no_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let (path, elsewhere) = (folder.path().join(LOCK), folder.path().join("elsewhere"));
        fs::write(&elsewhere, "precious").unwrap();
        std::os::unix::fs::symlink(&elsewhere, &path).unwrap();
        let refused = RunLock::take(folder.path(), || false).unwrap_err();
        assert!(refused.message.contains("a link found"), "{refused}");
        assert_eq!(fs::read_to_string(&elsewhere).unwrap(), "precious");
    }

    #[test]
    fn times_are_written_as_people_do() {
        assert_eq!(utc(0), "1970-01-01 00:00 UTC");
        assert_eq!(utc(951_868_740), "2000-02-29 23:59 UTC");
        assert_eq!(utc(1_767_225_600), "2026-01-01 00:00 UTC");
    }
}
