//! Open files that are held so that others can be opened later.

use std::io;
use std::os::fd::OwnedFd;

use rustix::fs::{Mode, OFlags, open};

/// Some of the files that this process may have open, held in reserve. To remove a folder it has to be opened, which
/// the system refuses once a process has too many files open. Whoever makes a folder that is to be removed at the end
/// takes a reserve first, and drops it before the removal.
#[derive(Debug)]
pub struct Reserve {
    _files: Vec<OwnedFd>,
}

impl Reserve {
    /// Takes so many open files.
    ///
    /// # Errors
    /// When the system allows fewer than that.
    pub fn take(count: usize) -> io::Result<Reserve> {
        // The path is opened as a place only, neither read nor looked into.
        let flags = OFlags::PATH | OFlags::CLOEXEC;
        let files = (0..count).map(|_| open("/", flags, Mode::empty()));
        Ok(Reserve { _files: files.collect::<Result<_, _>>()? })
    }
}
