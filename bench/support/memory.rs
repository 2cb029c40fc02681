//! How much memory a program and its children hold.

use std::fs::{self, Metadata};
use std::os::unix::fs::MetadataExt;
use std::process::Child;
use std::thread::sleep;
use std::time::Duration;

/// Waits for a build; the most bytes that it and its workers held meanwhile: the files of their shared memory,
/// and all else by proportional set sizes, in which pages that several share count once.
pub fn peak_bytes(child: &mut Child) -> u64 {
    let mut peak = 0;
    while child.try_wait().expect("it can be waited for").is_none() {
        let pid = child.id();
        let children = fs::read_to_string(format!("/proc/{pid}/task/{pid}/children"));
        let children = children.unwrap_or_default();
        // A worker that has just been forked still has the memory of its parent.
        let is_itself = |child: &u32| command(*child) != command(pid);
        let pids = children.split_whitespace().filter_map(|pid| pid.parse().ok());
        let pids = pids.filter(is_itself).chain([pid]);
        let shared = shared_files(pid);
        let others = pids.map(|pid| other_bytes(pid, &shared)).sum::<u64>();
        peak = peak.max(others + shared.iter().map(|file| file.blocks() * 512).sum::<u64>());
        sleep(Duration::from_millis(20));
    }
    peak
}

fn command(pid: u32) -> Vec<u8> {
    fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default()
}

/// The files of a coordinator's shared memory, which are in a folder of its own.
fn shared_files(pid: u32) -> Vec<Metadata> {
    let entries = fs::read_dir("/dev/shm").into_iter().flatten().flatten();
    let prefix = format!("roadmill-{pid}-");
    let own = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(&prefix));
    let files = own.flat_map(|folder| fs::read_dir(folder.path()).into_iter().flatten().flatten());
    files.filter_map(|file| file.metadata().ok()).filter(Metadata::is_file).collect()
}

/// The proportional set size of a process without those files; 0 where it has ended. Files that have lost
/// their names count as long as they are mapped.
fn other_bytes(pid: u32, shared: &[Metadata]) -> u64 {
    let text = fs::read_to_string(format!("/proc/{pid}/smaps")).unwrap_or_default();
    let (mut kib, mut is_counted) = (0, true);
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["Pss:", number, _] if is_counted => kib += number.parse().unwrap_or(0),
            // A mapping's first line: its number, not its name, tells which file it is.
            [_, _, _, _, number, name, ..] if name.starts_with("/dev/shm") => {
                is_counted = !shared.iter().any(|file| file.ino().to_string() == number);
            }
            [addresses, ..] if addresses.contains('-') => is_counted = true,
            _ => {}
        }
    }
    kib << 10
}
