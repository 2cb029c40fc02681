use super::CrewError;
use roadmill::roadmap::Digest;
use roadmill_workers::build_id_of;
use rustix::io::{FdFlags, fcntl_setfd};
use std::fs::File;
use std::io;
use std::os::fd::AsRawFd;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// The program that worker processes run, held open: an upgrade may give its name to another file.
#[derive(Debug)]
pub struct Executable {
    file: File,
    /// Its name when it was opened, for people.
    path: PathBuf,
    build: Digest,
}

impl Executable {
    /// The program of this process: for `roadmill` itself, which is a worker when it is told to be.
    ///
    /// # Errors
    /// When it cannot be opened.
    pub fn own() -> Result<Executable, CrewError> {
        let running = Path::new("/proc/self/exe");
        let path = std::env::current_exe().unwrap_or_else(|_| running.to_owned());
        Executable::open(running, path)
    }

    /// The program `roadmill` at `path`: for other programs that use this library, which are no workers.
    ///
    /// # Errors
    /// When there is no such file, or it cannot be executed. Whether it is a worker is seen when it is
    /// started: see [`Dispatcher`](crate::dispatch::Dispatcher).
    pub fn at(path: &Path) -> Result<Executable, CrewError> {
        Executable::open(path, path.to_owned())
    }

    fn open(file: &Path, path: PathBuf) -> Result<Executable, CrewError> {
        let what = format!("cannot use {} as the workers' program", path.display());
        let open = || {
            let file = File::open(file)?;
            let metadata = file.metadata()?;
            let other = |found| {
                let message = format!("{found} found, an executable file expected");
                Err(io::Error::new(io::ErrorKind::InvalidInput, message))
            };
            if !metadata.is_file() {
                return other("something that is no file");
            }
            if metadata.permissions().mode() & 0o111 == 0 {
                return other("a file that nobody may execute");
            }
            // Workers inherit the descriptor by whose name they are started, so that the name still leads to their program: an
            // emulator of another processor, such as `qemu-aarch64`, looks it up after the start.
            fcntl_setfd(&file, FdFlags::empty())?;
            Ok((file, build_id_of(&metadata)))
        };
        let (file, build) = open().map_err(CrewError::system(what))?;
        Ok(Executable { file, path, build })
    }

    /// Which file it is, as a worker that runs it says.
    pub fn build(&self) -> Digest {
        self.build
    }

    /// Its name when it was opened.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A name under which this process and its children find the file, whatever has become of its own.
    pub(super) fn descriptor_path(&self) -> PathBuf {
        format!("/proc/self/fd/{}", self.file.as_raw_fd()).into()
    }
}
