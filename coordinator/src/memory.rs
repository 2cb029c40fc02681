//! Memory of this process and of its children.

use std::fs;

/// Bytes of physical memory that this process and its children hold, pages that they share counted in
/// each.
pub fn resident_bytes() -> u64 {
    let children = fs::read_to_string("/proc/thread-self/children").unwrap_or_default();
    let own = std::process::id().to_string();
    let pids = children.split_whitespace().chain([own.as_str()]);
    pids.map(resident_pages).sum::<u64>() * rustix::param::page_size() as u64
}

fn resident_pages(pid: &str) -> u64 {
    let sizes = fs::read_to_string(format!("/proc/{pid}/statm")).unwrap_or_default();
    // One that has just ended holds nothing.
    sizes.split_whitespace().nth(1).and_then(|pages| pages.parse().ok()).unwrap_or(0)
}
