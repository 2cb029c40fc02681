//! A search that a signal or a clock can end.

use crate::exit::Failure;
use crate::signals::Signals;
use roadmill::Cancel;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// Between two looks at the signals and the clock.
const PAUSE: Duration = Duration::from_millis(20);

/// Does some work with a switch that is put once a signal has come or, with a limit of time, so many seconds are over.
///
/// # Errors
/// Exit code 1: the system refuses the thread that looks.
pub(super) fn bounded<T>(
    signals: &Signals,
    seconds: Option<f64>,
    work: impl FnOnce(&Cancel) -> T,
) -> Result<T, Failure> {
    let (begun, cancel) = (Instant::now(), Cancel::new());
    let (working, ended) = channel::<()>();
    thread::scope(|scope| {
        let look = || {
            let is_over = |seconds| begun.elapsed().as_secs_f64() >= seconds;
            if signals.came() || seconds.is_some_and(is_over) {
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
