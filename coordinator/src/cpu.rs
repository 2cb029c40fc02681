//! CPU time of this process and of the children it has waited for.

use rustix::time::{ClockId, clock_gettime};

/// CPU seconds of this process so far.
pub fn own_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// CPU seconds of all children waited for so far, in the system's ticks (usually 10 ms).
pub fn children_seconds() -> f64 {
    // Fields 16 and 17 (cutime, cstime); the command's name before them may hold anything but is
    // closed by the last parenthesis.
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let fields = after_name.split_whitespace().skip(13).take(2);
    let ticks: u64 = fields.filter_map(|field| field.parse::<u64>().ok()).sum();
    ticks as f64 / rustix::param::clock_ticks_per_second() as f64
}
