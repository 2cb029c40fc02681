//! Says on a terminal that work goes on which may take long before there is anything to show.

use std::io::{IsTerminal, Write};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How long work goes on before anything is said of it, and between two words about it.
const EVERY: Duration = Duration::from_secs(1);

/// Does work. Where standard error is a terminal, a line there says from the second second on what is being done and for how
/// long; it is gone when the work is done.
pub(crate) fn waiting<T>(what: &str, work: impl FnOnce() -> T) -> T {
    if !std::io::stderr().is_terminal() {
        return work();
    }
    thread::scope(|scope| {
        // The other end goes when the work is done, also where that ends in a panic.
        let (working, done) = mpsc::channel::<()>();
        scope.spawn(move || tell(what, EVERY, &done, &mut std::io::stderr()));
        let made = work();
        drop(working);
        made
    })
}

/// Writes a line again and again until the other end of the channel is gone; then takes it back. A terminal that takes no more
/// changes nothing about the work.
fn tell(what: &str, every: Duration, done: &Receiver<()>, out: &mut impl Write) {
    let mut count = 0;
    while done.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
        count += 1;
        let _ = write!(out, "\r{what}: {} s\x1b[K", count * every.as_secs());
        let _ = out.flush();
    }
    if count > 0 {
        let _ = write!(out, "\r\x1b[K");
        let _ = out.flush();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_how_long_and_is_taken_back() {
        let (working, done) = mpsc::channel::<()>();
        let told = thread::spawn(move || {
            let mut out = Told { text: Vec::new(), working: Some(working) };
            tell("reading", Duration::from_millis(1), &done, &mut out);
            out.text
        });
        let text = String::from_utf8(told.join().unwrap()).unwrap();
        assert!(text.starts_with("\rreading: 0 s\x1b[K") && text.ends_with("\r\x1b[K"), "{text:?}");
    }

    /// Ends the work once something was told of it.
    struct Told {
        text: Vec<u8>,
        working: Option<mpsc::Sender<()>>,
    }

    impl Write for Told {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.text.extend(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            self.working = None;
            Ok(())
        }
    }

    #[test]
    fn work_that_is_done_at_once_is_not_told_of() {
        let (working, done) = mpsc::channel::<()>();
        drop(working);
        let mut out = Vec::new();
        tell("reading", EVERY, &done, &mut out);
        assert!(out.is_empty());
        assert_eq!(waiting("adding", || 1 + 1), 2);
    }
}
