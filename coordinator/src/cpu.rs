//! CPU time of this process and of the children it has waited for.

use rustix::time::{ClockId, clock_gettime};

/// CPU time of one thread that went into one kind of work.
#[derive(Clone, Copy, Debug, Default)]
pub struct Meter {
    seconds: f64,
}

impl Meter {
    /// The time of this thread now: what [`Meter::end`] wants.
    pub fn begin() -> f64 {
        seconds_of(ClockId::ThreadCPUTime)
    }

    /// Adds the time since then.
    pub fn end(&mut self, begun: f64) {
        self.seconds += Meter::begin() - begun;
    }

    /// CPU seconds so far.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }
}

/// CPU time since the clock was started. A process may have a past that is not its own: whoever calls
/// `exec`, as `cargo run` does, hands on what it and its children have used.
#[derive(Clone, Copy, Debug)]
pub struct CpuClock {
    own: f64,
    children: f64,
}

impl CpuClock {
    /// Starts a clock.
    pub fn start() -> CpuClock {
        CpuClock { own: own_seconds(), children: children_seconds() }
    }

    /// CPU seconds of this process since then.
    pub fn own_seconds(&self) -> f64 {
        own_seconds() - self.own
    }

    /// CPU seconds of the children waited for since then, in the system's ticks (usually 10 ms).
    pub fn children_seconds(&self) -> f64 {
        children_seconds() - self.children
    }
}

fn own_seconds() -> f64 {
    seconds_of(ClockId::ProcessCPUTime)
}

fn seconds_of(clock: ClockId) -> f64 {
    let time = clock_gettime(clock);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

fn children_seconds() -> f64 {
    // Fields 16 and 17 (cutime, cstime); the command's name before them may hold anything but is
    // closed by the last parenthesis.
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let fields = after_name.split_whitespace().skip(13).take(2);
    let ticks: u64 = fields.filter_map(|field| field.parse::<u64>().ok()).sum();
    ticks as f64 / rustix::param::clock_ticks_per_second() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_used_before_the_clock_started_does_not_count() {
        let begun = own_seconds();
        while own_seconds() < begun + 0.02 {}
        let clock = CpuClock::start();
        let own = clock.own_seconds();
        assert!(own >= 0.0 && own <= own_seconds() - begun - 0.02);
        assert_eq!(clock.children_seconds(), 0.0);
    }
}
