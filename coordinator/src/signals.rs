//! SIGINT, SIGTERM and SIGHUP as something to look at between events.

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Notes signals that ask the process to end. A second one ends it at once.
pub struct Signals {
    came: Arc<AtomicBool>,
    bell: UnixStream,
}

impl Signals {
    /// Starts noting.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn listen() -> std::io::Result<Signals> {
        let came = Arc::new(AtomicBool::new(false));
        let (bell, striker) = UnixStream::pair()?;
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            // Registered first, so that it acts on the second signal only.
            let code = i32::from(crate::exit::Code::Interrupted as u8);
            signal_hook::flag::register_conditional_shutdown(signal, code, came.clone())?;
            signal_hook::flag::register(signal, came.clone())?;
            signal_hook::low_level::pipe::register(signal, striker.try_clone()?)?;
        }
        Ok(Signals { came, bell })
    }

    /// Whether one has come.
    pub fn came(&self) -> bool {
        self.came.load(Ordering::SeqCst)
    }

    /// Readable once one has come.
    pub fn as_fd(&self) -> BorrowedFd<'_> {
        self.bell.as_fd()
    }
}
