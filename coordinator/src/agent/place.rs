use crate::exit::Failure;
use crate::files::open_regular;
use rustix::fs::OFlags;
use rustix::process::{Signal, set_parent_process_death_signal};
use std::fmt;
use std::io::{self, Read};
use std::os::fd::OwnedFd;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Stdio};

/// Where an agent runs, and the command that starts it there and carries its standard input and output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    name: String,
    words: Vec<String>,
}

/// What stands for the name of a place in a command.
const NAME: &str = "{}";
/// The most places.
pub const PLACES_MAX: usize = 1024;
/// The most bytes of a list of names.
const LIST_BYTES_MAX: u64 = 1 << 20;

impl Place {
    /// A place of this name, whose agent is started by `command`: a program and its arguments, in which `{}` stands for the
    /// name. They are parted at spaces, and quotes keep together what a shell would keep together; no shell sees
    /// them.
    ///
    /// # Errors
    /// When the name could be taken for an option, or the command cannot be parted.
    pub fn new(name: &str, command: &str) -> Result<Place, Failure> {
        let refuse = |found: &str| {
            Failure::usage(format!(
                "--agents: {found} found, names of machines expected, without spaces and not beginning with -"
            ))
        };
        if name.is_empty() {
            return Err(refuse("an empty name"));
        }
        if name.starts_with('-') || name.chars().any(|c| c.is_whitespace() || c.is_control()) {
            return Err(refuse(&format!("{name:?}")));
        }
        let words = shlex::split(command).filter(|words| !words.is_empty());
        let words = words.ok_or_else(|| {
            Failure::usage(format!(
                "--agent-command: {command:?} found, a program and its arguments expected"
            ))
        })?;
        let words = words.into_iter().map(|word| word.replace(NAME, name)).collect();
        Ok(Place { name: name.to_owned(), words })
    }

    /// The places that a list names: names with commas between them, or `@FILE` with a name per line, empty ones and those
    /// that begin with # left out.
    ///
    /// # Errors
    /// When the file cannot be read, there is no name, or one is none.
    pub fn list(names: &str, command: &str) -> Result<Vec<Place>, Failure> {
        let (text, file) = match names.strip_prefix('@') {
            None => (names.to_owned(), None),
            Some(file) => {
                let text = read(Path::new(file)).map_err(|error| {
                    Failure::usage(format!("--agents: {file}: cannot read: {error}"))
                })?;
                (text, Some(file))
            }
        };
        let names: Vec<&str> = match file {
            None => text.split(',').map(str::trim).collect(),
            Some(_) => {
                let lines = text.lines().map(str::trim);
                lines.filter(|line| !line.is_empty() && !line.starts_with('#')).collect()
            }
        };
        if names.is_empty() || names.len() > PLACES_MAX {
            let found = names.len();
            return Err(Failure::usage(format!(
                "--agents: {found} names found, 1 to {PLACES_MAX} expected"
            )));
        }
        names.into_iter().map(|name| Place::new(name, command)).collect()
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Starts what carries the agent. The kernel tells it to end when the thread that started it ends, should nobody else.
    pub(super) fn start(&self) -> io::Result<Carrier> {
        let (program, arguments) = self.words.split_first().ok_or(io::ErrorKind::InvalidInput)?;
        let mut command = Command::new(program);
        command
            .args(arguments)
            // Ctrl-C at a terminal is for the coordinator, which ends its agents.
            .process_group(0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        // SAFETY: the closure makes one system call, `prctl`, and touches no memory.
        unsafe {
            command.pre_exec(|| Ok(set_parent_process_death_signal(Some(Signal::TERM))?));
        }
        let started = command.spawn();
        let mut child =
            started.map_err(|error| io::Error::new(error.kind(), format!("{program}: {error}")))?;
        let gone = || io::Error::from(io::ErrorKind::BrokenPipe);
        let stdin = child.stdin.take().ok_or_else(gone)?;
        let stdout = child.stdout.take().ok_or_else(gone)?;
        let stderr = child.stderr.take().ok_or_else(gone)?;
        Ok(Carrier { child, reader: stdout.into(), writer: stdin.into(), errors: stderr })
    }
}

/// The text of a list of names.
fn read(file: &Path) -> io::Result<String> {
    let mut text = String::new();
    open_regular(file, OFlags::RDONLY)?.take(LIST_BYTES_MAX).read_to_string(&mut text)?;
    Ok(text)
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

/// A process that carries an agent's streams.
#[derive(Debug)]
pub(super) struct Carrier {
    pub child: Child,
    pub reader: OwnedFd,
    pub writer: OwnedFd,
    pub errors: ChildStderr,
}
