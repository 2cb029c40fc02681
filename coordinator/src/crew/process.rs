use super::SILENCE_MAX;
use super::executable::Executable;
use roadmill_workers::WorkerId;
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use std::io::{ErrorKind, Read};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::time::Instant;

/// Whether a worker process shows that it lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pulse {
    /// It does.
    Beating,
    /// It has ended.
    Ended,
    /// It has shown nothing for [`SILENCE_MAX`].
    Silent,
}

/// A worker process.
#[derive(Debug)]
pub struct WorkerProcess {
    child: Child,
    /// Its standard output, on which a byte a second shows that it lives.
    heart: ChildStdout,
    last_beat: Instant,
}

impl WorkerProcess {
    /// Starts a worker. To be called from a thread that lives as long as the worker should: the
    /// kernel ends the worker with it.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn start(
        executable: &Executable,
        channel: &Path,
        worker: WorkerId,
    ) -> std::io::Result<WorkerProcess> {
        let mut child = Command::new(executable.descriptor_path())
            .arg0("roadmill")
            .arg("worker")
            .arg("--channel")
            .arg(channel)
            .args(["--worker", &worker.to_string()])
            .args(["--coordinator", &std::process::id().to_string()])
            // Ctrl-C at a terminal is for the coordinator.
            .process_group(0)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()?;
        let heart = child.stdout.take().ok_or(ErrorKind::BrokenPipe)?;
        fcntl_setfl(&heart, fcntl_getfl(&heart)? | OFlags::NONBLOCK)?;
        Ok(WorkerProcess { child, heart, last_beat: Instant::now() })
    }

    /// Readable when the process has shown that it lives, or has ended.
    pub fn as_fd(&self) -> BorrowedFd<'_> {
        self.heart.as_fd()
    }

    /// Takes note of the signs of life that have come.
    pub fn look(&mut self) -> Pulse {
        let mut beats = [0; 64];
        loop {
            match self.heart.read(&mut beats) {
                // Only the worker holds the other end.
                Ok(0) => return Pulse::Ended,
                Ok(_) => self.last_beat = Instant::now(),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
        if self.last_beat.elapsed() > SILENCE_MAX { Pulse::Silent } else { Pulse::Beating }
    }

    /// Ends the process, if it has not ended, and waits for it.
    pub fn end(&mut self) -> Option<ExitStatus> {
        // By SIGKILL, which ends a stopped process too; one that has ended cannot be ended.
        let _ = self.child.kill();
        self.child.wait().ok()
    }
}

impl Drop for WorkerProcess {
    fn drop(&mut self) {
        self.end();
    }
}
