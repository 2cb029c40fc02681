//! How much memory a program and its children hold.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::process::Child;
use std::thread::sleep;
use std::time::Duration;

/// Where a build's shared memory has its names.
const SHARED: &str = "/dev/shm/roadmill-";

/// Waits for a build; the most bytes that it and its workers held meanwhile: the files of their shared memory,
/// and all else by proportional set sizes, in which pages that several share count once.
pub fn peak_bytes(child: &mut Child) -> u64 {
    let mut peak = 0;
    while child.try_wait().expect("it can be waited for").is_none() {
        let pid = child.id();
        let children = fs::read_to_string(format!("/proc/{pid}/task/{pid}/children"));
        let children = children.unwrap_or_default();
        let pids = children.split_whitespace().filter_map(|pid| pid.parse().ok()).chain([pid]);
        peak = peak.max(pids.map(other_bytes).sum::<u64>() + shared_bytes(pid));
        sleep(Duration::from_millis(20));
    }
    peak
}

/// What the files of a coordinator's shared memory take.
fn shared_bytes(pid: u32) -> u64 {
    let entries = fs::read_dir("/dev/shm").into_iter().flatten().flatten();
    let own = entries
        .filter(|entry| entry.path().to_string_lossy().starts_with(&format!("{SHARED}{pid}-")));
    own.filter_map(|entry| entry.metadata().ok()).map(|metadata| metadata.blocks() * 512).sum()
}

/// The proportional set size of a process without those files; 0 where it has ended. Files that have lost
/// their names count as long as they are mapped.
fn other_bytes(pid: u32) -> u64 {
    let text = fs::read_to_string(format!("/proc/{pid}/smaps")).unwrap_or_default();
    let (mut kib, mut is_counted) = (0, true);
    for line in text.lines() {
        match line.strip_prefix("Pss:") {
            Some(rest) if is_counted => {
                kib += rest.split_whitespace().next().and_then(|n| n.parse().ok()).unwrap_or(0);
            }
            // A mapping's first line, with addresses and the file's name.
            None if line.starts_with(|c: char| c.is_ascii_digit() || c.is_ascii_lowercase()) => {
                is_counted = !line.contains(SHARED) || line.ends_with("(deleted)");
            }
            _ => {}
        }
    }
    kib << 10
}
