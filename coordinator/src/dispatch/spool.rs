use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::Path;

/// Bytes on a disk, for as long as a build lasts: what has to be told to agents that come late need not lie in memory.
/// The file has no name, so that nothing is left of it whatever ends the process.
#[derive(Debug)]
pub struct Spool {
    file: File,
    length: u64,
}

impl Spool {
    /// An empty one, on the disk of this folder.
    ///
    /// # Errors
    /// When no file can be made there.
    pub fn in_folder(folder: &Path) -> io::Result<Spool> {
        Ok(Spool { file: tempfile::tempfile_in(folder)?, length: 0 })
    }

    /// Appends bytes; where they begin.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn append(&mut self, bytes: &[u8]) -> io::Result<u64> {
        let offset = self.length;
        self.file.write_all_at(bytes, offset)?;
        self.length += bytes.len() as u64;
        Ok(offset)
    }

    /// Reads bytes that were appended.
    ///
    /// # Errors
    /// When they cannot be read.
    pub fn read(&self, offset: u64, length: u64) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; length as usize];
        self.file.read_exact_at(&mut bytes, offset)?;
        Ok(bytes)
    }
}
