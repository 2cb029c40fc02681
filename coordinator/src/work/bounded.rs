//! A search that a signal or a clock can end.

use crate::exit::Failure;
use roadmill::Cancel;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Between two looks at the signals and the clock.
const PAUSE: Duration = Duration::from_millis(20);

/// Does some work with a switch that is put once `came` says that something has come which ends it, such as a signal, or, with a limit of time, so
/// many seconds are over.
///
/// # Errors
/// Exit code 1: the system refuses the thread that looks.
pub(crate) fn bounded<T>(
    came: impl Fn() -> bool + Sync,
    seconds: Option<f64>,
    work: impl FnOnce(&Cancel) -> T,
) -> Result<T, Failure> {
    let (begun, cancel) = (Instant::now(), Cancel::new());
    let (working, ended) = channel::<()>();
    thread::scope(|scope| {
        let look = || {
            let is_over = |seconds| begun.elapsed().as_secs_f64() >= seconds;
            if came() || seconds.is_some_and(is_over) {
                cancel.cancel();
            }
        };
        // Before the work, too, so that no time at all is none.
        look();
        thread::Builder::new()
            .spawn_scoped(scope, move || {
                // The work's end of the channel goes with the work.
                while ended.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                    look();
                }
            })
            .map_err(|error| Failure::system(format!("cannot start a thread: {error}")))?;
        let done = work(&cancel);
        drop(working);
        Ok(done)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    fn until(cancel: &Cancel) {
        while !cancel.is_cancelled() {
            thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn work_ends_once_something_has_come_or_time_is_over() {
        let looks = AtomicU32::new(0);
        // Not before the work has begun.
        bounded(|| looks.fetch_add(1, Ordering::SeqCst) >= 2, None, until).unwrap();
        assert!(looks.into_inner() >= 3);
        bounded(|| false, Some(0.03), until).unwrap();
        // No time at all is none.
        assert!(bounded(|| false, Some(0.0), Cancel::is_cancelled).unwrap());
        assert!(!bounded(|| false, None, Cancel::is_cancelled).unwrap());
    }
}
