use roadmill_workers::channel::WorkerId;
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use std::fs::File;
use std::io::Read;
use std::os::fd::{AsFd, AsRawFd, BorrowedFd};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// A worker whose heart has not beaten for this long is stopped or stuck, and is replaced. Jobs
/// may take as long as they like: the heart has a thread of its own.
const SILENCE_MAX: Duration = Duration::from_secs(30);

/// The executable of this process, held open: an upgrade may replace the file.
#[derive(Debug)]
pub struct Executable(File);

impl Executable {
    /// Opens it.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn open() -> std::io::Result<Executable> {
        File::open("/proc/self/exe").map(Executable)
    }
}

/// A worker process.
#[derive(Debug)]
pub struct WorkerProcess {
    child: Child,
    heart: ChildStdout,
    last_beat: Instant,
    gone: bool,
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
        let mut child = Command::new(format!("/proc/self/fd/{}", executable.0.as_raw_fd()))
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
        let heart = child.stdout.take().ok_or(std::io::ErrorKind::BrokenPipe)?;
        fcntl_setfl(&heart, fcntl_getfl(&heart)? | OFlags::NONBLOCK)?;
        Ok(WorkerProcess { child, heart, last_beat: Instant::now(), gone: false })
    }

    /// Readable when the heart has beaten or the process has ended.
    pub fn as_fd(&self) -> BorrowedFd<'_> {
        self.heart.as_fd()
    }

    /// Takes note of heartbeats; whether the process has ended. Ends one that has fallen silent.
    pub fn look(&mut self) -> bool {
        let mut beats = [0; 64];
        loop {
            match self.heart.read(&mut beats) {
                // Only the worker holds the other end.
                Ok(0) => self.gone = true,
                Ok(_) => {
                    self.last_beat = Instant::now();
                    continue;
                }
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => continue,
                Err(_) => {}
            }
            break;
        }
        if self.last_beat.elapsed() > SILENCE_MAX {
            self.gone = true;
        }
        self.gone
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
