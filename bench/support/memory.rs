//! How much memory a program and its children hold.

use std::fs;
use std::process::Child;
use std::thread::sleep;
use std::time::Duration;

/// Waits for a build; the most bytes that it and its workers held meanwhile, pages that several of them
/// share counted once (the sum of their proportional set sizes), and what they read from shared memory
/// without mapping it.
pub fn peak_bytes(child: &mut Child) -> u64 {
    let mut peak = 0;
    while child.try_wait().expect("it can be waited for").is_none() {
        let pid = child.id();
        let children = fs::read_to_string(format!("/proc/{pid}/task/{pid}/children"));
        let children = children.unwrap_or_default();
        let pids = children.split_whitespace().filter_map(|pid| pid.parse().ok()).chain([pid]);
        peak = peak.max(pids.map(proportional_bytes).sum::<u64>() + stored_bytes(pid));
        sleep(Duration::from_millis(20));
    }
    peak
}

/// What a coordinator has written for its workers.
fn stored_bytes(pid: u32) -> u64 {
    let entries = fs::read_dir("/dev/shm").into_iter().flatten().flatten();
    let stores = entries.filter(|entry| {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        name.starts_with(&format!("roadmill-{pid}-")) && name.ends_with("_store")
    });
    stores.filter_map(|entry| entry.metadata().ok()).map(|metadata| metadata.len()).sum()
}

/// 0 where the process has ended.
fn proportional_bytes(pid: u32) -> u64 {
    let text = fs::read_to_string(format!("/proc/{pid}/smaps_rollup")).unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("Pss:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kib.unwrap_or(0) << 10
}
