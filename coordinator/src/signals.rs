//! SIGINT, SIGTERM and SIGHUP as something to look at between events.

use crate::exit::Code;
use rustix::net::{RecvFlags, recv};
use signal_hook::consts::{SIGBUS, SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
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
            let code = i32::from(Code::Interrupted as u8);
            signal_hook::flag::register_conditional_shutdown(signal, code, came.clone())?;
            signal_hook::flag::register(signal, came.clone())?;
            signal_hook::low_level::pipe::register(signal, striker.try_clone()?)?;
        }
        Ok(Signals { came, bell })
    }

    /// Whether one has come. Does not return where two have.
    pub fn came(&self) -> bool {
        let came = self.came.load(Ordering::SeqCst);
        // Two signals can reach two threads at the same moment, so that both are taken for the first. Each of them has
        // put a byte into the bell, which stays there.
        let two = &mut [0u8; 2][..];
        let peek = RecvFlags::PEEK | RecvFlags::DONTWAIT;
        if came && recv(&self.bell, two, peek).is_ok_and(|(read, _)| read == 2) {
            std::process::exit(i32::from(Code::Interrupted as u8));
        }
        came
    }

    /// Readable once one has come.
    pub fn as_fd(&self) -> BorrowedFd<'_> {
        self.bell.as_fd()
    }
}

/// What is said where memory cannot be provided.
const OUT_OF_MEMORY: &[u8] =
    b"roadmill: memory that was promised is not there (SIGBUS): /dev/shm is full, or a file \
in use was shortened; what the ledger has is safe, and `resume` goes on from there\n";

/// Makes a failed write of signals that would end this process without a word: a file beyond `ulimit -f` is an
/// error of the write, and memory that cannot be provided ends the process with a message.
///
/// # Errors
/// When the system refuses.
pub(crate) fn take_limits_for_errors() -> std::io::Result<()> {
    // A handler, not to be ignored, which children would inherit. The write then fails with `EFBIG`.
    signal_hook::flag::register(SIGXFSZ, Arc::default())?;
    let say = || {
        // SAFETY: nobody closes standard error.
        let stderr = unsafe { BorrowedFd::borrow_raw(2) };
        // The message may be lost; the process must not go on.
        let _ = rustix::io::write(stderr, OUT_OF_MEMORY);
        signal_hook::low_level::exit(i32::from(Code::System as u8));
    };
    // SAFETY: the handler makes two system calls, `write` and `_exit`, which are async-signal-safe, and touches no
    // memory but a constant.
    unsafe { signal_hook::low_level::register(SIGBUS, say) }?;
    Ok(())
}
