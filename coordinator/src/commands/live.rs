//! A page that follows a build, served to the browsers of this machine.
//!
//! What is served is a roadmap, which others on the machine may have no right to read. So the server listens on the loopback
//! interface alone; its address has a random token, which never stands on a command line, where others could see it: the
//! browser is given a private file that leads to the address. The `Host` of a request must be the server's own, so that no page
//! from elsewhere reaches the server by a name that it has made to mean this machine (*DNS rebinding*).
//!
//! Every connection has a thread of its own, so that one that says nothing holds up neither the others nor the end of the
//! server. At most [`GUESTS_MAX`] connections are open: the oldest is closed for one more, so that connections that say nothing
//! cannot keep a browser out either.

use super::hand::Hand;
use super::view::{cannot_be_drawn, open, seen};
use crate::cli::ViewArguments;
use crate::exit::{Code, Failure};
use crate::output::note;
use crate::run::ledger::LEDGER;
use crate::signals::Signals;
use crate::work::Run;
use roadmill::export::Live;
use rustix::event::{PollFd, PollFlags, poll};
use std::collections::VecDeque;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant, SystemTime};
use tempfile::NamedTempFile;

/// The longest head of a request, in bytes.
const HEAD_MAX: usize = 8 << 10;
/// A request must have come whole within this time, and an answer is given up that is not taken for so long.
const PATIENCE: Duration = Duration::from_secs(5);
/// Who has its answer is waited for no longer than this to close the connection.
const FAREWELL: Duration = Duration::from_millis(200);
/// The run is read again at the earliest this long after it was read, and after so many times as long as that took.
const REST: Duration = Duration::from_secs(1);
const REST_FACTOR: u32 = 4;
/// The most connections that are open at a time.
const GUESTS_MAX: usize = 32;

/// Serves a page that follows a build until a signal comes, which is how the command is meant to end.
pub(super) fn follow(arguments: &ViewArguments) -> Result<Code, Failure> {
    let shown = Shown::read_as(&arguments.run, 0, None)?;
    let signals = Signals::listen().map_err(Failure::system)?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).map_err(Failure::system)?;
    listener.set_nonblocking(true).map_err(Failure::system)?;
    let port = listener.local_addr().map_err(Failure::system)?.port();
    let token = token().map_err(Failure::system)?;
    let address = format!("http://127.0.0.1:{port}/{token}/");
    let way = way_to(&address).map_err(Failure::system)?;
    let is_open = !arguments.no_open && open(way.path());
    let opened = if is_open { "opened in a browser" } else { "to be opened in a browser" };
    note(format_args!("{address}: {opened}; Ctrl-C ends it"));
    let server = Arc::new(Server {
        allowed: Allowed { port, token },
        run: arguments.run.clone(),
        shown: Mutex::new(Arc::new(shown)),
        refreshing: Mutex::default(),
        guests: Mutex::default(),
    });
    loop {
        let mut ready = [listener.as_fd(), signals.as_fd()]
            .map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN));
        match poll(&mut ready, None) {
            Ok(_) | Err(rustix::io::Errno::INTR) => {}
            Err(error) => return Err(Failure::system(error)),
        }
        if signals.came() {
            // Threads that still serve somebody end with the process.
            note("the page is no longer served");
            return Ok(Code::Done);
        }
        if let Ok((stream, _)) = listener.accept() {
            // Whoever cannot be served is gone; all others are served as before.
            let _ = server.receive(stream);
        }
    }
}

/// What serves the page: shared by the threads of all connections.
struct Server {
    allowed: Allowed,
    /// The run folder.
    run: PathBuf,
    /// What is served. Whoever serves it keeps it, while it may be replaced for the next one.
    shown: Mutex<Arc<Shown>>,
    /// Held by the one thread that reads the run again.
    refreshing: Mutex<()>,
    guests: Mutex<Guests>,
}

/// The connections that are open, the oldest first, each with a number of its own.
#[derive(Default)]
struct Guests {
    streams: VecDeque<(u64, TcpStream)>,
    next: u64,
}

impl Guests {
    /// Notes a connection; if there are too many, the oldest is closed, which ends its thread.
    fn enter(&mut self, stream: TcpStream) -> u64 {
        if self.streams.len() >= GUESTS_MAX
            && let Some((_, oldest)) = self.streams.pop_front()
        {
            // One that the other side has closed already needs no closing.
            let _ = oldest.shutdown(Shutdown::Both);
        }
        let number = self.next;
        self.next += 1;
        self.streams.push_back((number, stream));
        number
    }

    fn leave(&mut self, number: u64) {
        self.streams.retain(|(of, _)| *of != number);
    }
}

/// What a mutex holds, also where a thread that held it has panicked: no value here is ever half of anything.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Server {
    /// Serves a connection in a thread of its own.
    fn receive(self: &Arc<Server>, stream: TcpStream) -> io::Result<()> {
        let number = locked(&self.guests).enter(stream.try_clone()?);
        let server = self.clone();
        let serving = thread::Builder::new().spawn(move || {
            // Who breaks off is gone.
            let _ = server.serve(stream);
            locked(&server.guests).leave(number);
        });
        if serving.is_err() {
            locked(&self.guests).leave(number);
        }
        serving.map(|_| ())
    }

    /// Answers one request.
    fn serve(&self, mut stream: TcpStream) -> io::Result<()> {
        stream.set_nonblocking(false)?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let Some(head) = head_of(&mut stream)? else {
            return answer(&mut stream, "431 Request Header Fields Too Large", "text/plain", "");
        };
        match self.allowed.asked(&head) {
            Asked::Refused(status) => answer(&mut stream, status, "text/plain", status),
            Asked::Page => {
                let shown = self.shown();
                answer(&mut stream, "200 OK", "text/html; charset=utf-8", &shown.page)
            }
            Asked::Data { known } => {
                let shown = self.shown();
                if known == Some(shown.live.version) {
                    return answer(&mut stream, "204 No Content", "application/json", "");
                }
                answer(&mut stream, "200 OK", "application/json", &shown.data)
            }
            Asked::Collides { values } => {
                let hand = locked(&self.shown).hand.clone();
                match hand.map_or(Err("404 Not Found"), |hand| hand.told(&values)) {
                    Ok(told) => answer(&mut stream, "200 OK", "application/json", &told),
                    Err(status) => answer(&mut stream, status, "text/plain", status),
                }
            }
        }
    }

    /// What is to be served: read again if the run has changed and the last time is long enough ago, by one thread at a time,
    /// for which nobody else waits. What cannot be read, since it is being replaced, say, is tried another time.
    fn shown(&self) -> Arc<Shown> {
        let known = || locked(&self.shown).clone();
        let Ok(_refreshing) = self.refreshing.try_lock() else { return known() };
        let shown = known();
        if Instant::now() < shown.rested || ledger_of(&self.run) == shown.ledger {
            return shown;
        }
        let newer = match Shown::read_as(&self.run, shown.live.version + 1, shown.hand.as_ref()) {
            Ok(newer) => newer,
            Err(_) => Shown { rested: Instant::now() + REST, ..(*shown).clone() },
        };
        // What was shown before may hold a hand, which ends its thread: not while others wait for the lock.
        let before = std::mem::replace(&mut *locked(&self.shown), Arc::new(newer));
        drop(before);
        known()
    }
}

/// 128 bits of chance as text, from the system.
fn token() -> io::Result<String> {
    let mut bytes = [0; 16];
    File::open("/dev/urandom")?.read_exact(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// A file that only its owner can read, and that leads a browser to the address; removed when it is dropped.
fn way_to(address: &str) -> io::Result<NamedTempFile> {
    let mut file = tempfile::Builder::new().prefix("roadmill-view-").suffix(".html").tempfile()?;
    write!(file, "<!DOCTYPE html><meta http-equiv=\"refresh\" content=\"0;url={address}\">")?;
    Ok(file)
}

/// What was last read of the run, as it is served.
#[derive(Clone)]
struct Shown {
    live: Live,
    page: Arc<str>,
    data: Arc<str>,
    /// The ledger's length and time when it was read.
    ledger: Option<(u64, SystemTime)>,
    /// When the run may be read again.
    rested: Instant,
    /// Of a run whose configurations the model alone judges.
    hand: Option<Arc<Hand>>,
}

impl Shown {
    /// Reads the run; a hand that moved the robot of the same problem goes on.
    fn read_as(folder: &Path, version: u64, hand: Option<&Arc<Hand>>) -> Result<Shown, Failure> {
        let begun = Instant::now();
        let ledger = ledger_of(folder);
        let run = Run::at(folder).read()?;
        let live = Live { version, has_ended: run.stopped().is_some() };
        let both = seen(&run, false, Some(live), |viewer| Some((viewer.page()?, viewer.data()?)));
        let (page, data) = both.ok_or_else(|| cannot_be_drawn(folder, &run))?;
        let rested = Instant::now() + REST.max(begun.elapsed() * REST_FACTOR);
        let hand = hand.filter(|hand| hand.is_of(run.problem())).cloned();
        let hand = hand.unwrap_or_else(|| Arc::new(Hand::of(run.problem())));
        // A validity function of another program is not known here.
        let hand = run.expect_validity_function().is_ok().then_some(hand);
        Ok(Shown { live, page: page.into(), data: data.into(), ledger, rested, hand })
    }
}

fn ledger_of(folder: &Path) -> Option<(u64, SystemTime)> {
    let metadata = fs::metadata(folder.join(LEDGER)).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

/// What a request must have.
struct Allowed {
    port: u16,
    token: String,
}

/// What is asked for.
#[derive(Debug, PartialEq, Eq)]
enum Asked {
    Page,
    /// The data, unless they have the version that is known.
    Data {
        known: Option<u64>,
    },
    /// Whether the robot collides at a configuration, whose values have commas between.
    Collides {
        values: String,
    },
    /// Nothing that there is: the status of the answer.
    Refused(&'static str),
}

impl Allowed {
    /// What the head of a request asks for.
    fn asked(&self, head: &str) -> Asked {
        let mut lines = head.split("\r\n");
        let request: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
        let [method, target, "HTTP/1.1" | "HTTP/1.0"] = request[..] else {
            return Asked::Refused("400 Bad Request");
        };
        let hosts: Vec<&str> = lines
            .filter_map(|line| line.split_once(':'))
            .filter(|(name, _)| name.eq_ignore_ascii_case("host"))
            .map(|(_, host)| host.trim())
            .collect();
        let port = self.port;
        let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        if !matches!(hosts[..], [host] if own.iter().any(|own| own == host)) {
            return Asked::Refused("403 Forbidden");
        }
        if method != "GET" {
            return Asked::Refused("405 Method Not Allowed");
        }
        let rest = target.strip_prefix('/').and_then(|rest| rest.split_once('/'));
        match rest {
            Some((token, rest)) if is_same(token, &self.token) => match rest.split_once('?') {
                None if rest.is_empty() => Asked::Page,
                None if rest == "data" => Asked::Data { known: None },
                Some(("data", query)) => Asked::Data {
                    known: query.strip_prefix("known=").and_then(|number| number.parse().ok()),
                },
                Some(("collides", query)) => match query.strip_prefix("q=") {
                    Some(values) => Asked::Collides { values: values.to_owned() },
                    None => Asked::Refused("400 Bad Request"),
                },
                _ => Asked::Refused("404 Not Found"),
            },
            _ => Asked::Refused("404 Not Found"),
        }
    }
}

/// Whether two texts are the same, in a time that does not tell how much of them is.
fn is_same(a: &str, b: &str) -> bool {
    let differing = a.bytes().zip(b.bytes()).fold(0, |differing, (a, b)| differing | (a ^ b));
    a.len() == b.len() && differing == 0
}

/// The head of a request; `None` if it is too long. What follows it is not read: no request that is answered has a body.
fn head_of(stream: &mut TcpStream) -> io::Result<Option<String>> {
    let deadline = Instant::now() + PATIENCE;
    let (mut head, mut part) = (Vec::new(), [0; 1024]);
    while head.len() < HEAD_MAX {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
        let read = stream.read(&mut part)?;
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        head.extend_from_slice(&part[..read]);
        if let Some(end) = head.windows(4).position(|four| four == b"\r\n\r\n") {
            head.truncate(end);
            return Ok(Some(String::from_utf8_lossy(&head).into_owned()));
        }
    }
    Ok(None)
}

fn answer(stream: &mut TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\
         Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\nX-Frame-Options: DENY\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body.as_bytes())?;
    // What was sent and not read would make the system reset the connection, and the answer be lost.
    stream.shutdown(Shutdown::Write)?;
    stream.set_read_timeout(Some(FAREWELL))?;
    let mut rest = [0; HEAD_MAX];
    for _ in 0..8 {
        if stream.read(&mut rest)? == 0 {
            break;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOKEN: &str = "0123456789abcdef0123456789abcdef";

    fn asked(line: &str, host: &str) -> Asked {
        let allowed = Allowed { port: 4711, token: TOKEN.to_owned() };
        allowed.asked(&format!("{line}\r\nAccept: */*\r\n{host}"))
    }

    #[test]
    fn only_who_knows_the_token_and_the_host_is_answered() {
        let (own, page) = ("Host: 127.0.0.1:4711", format!("GET /{TOKEN}/ HTTP/1.1"));
        assert_eq!(asked(&page, own), Asked::Page);
        assert_eq!(asked(&page, "host:localhost:4711"), Asked::Page);
        let data = |query: &str| asked(&format!("GET /{TOKEN}/data{query} HTTP/1.1"), own);
        assert_eq!(data(""), Asked::Data { known: None });
        assert_eq!(data("?known=3"), Asked::Data { known: Some(3) });
        assert_eq!(data("?known=x"), Asked::Data { known: None });
        let collides = |query: &str| asked(&format!("GET /{TOKEN}/collides{query} HTTP/1.1"), own);
        assert_eq!(collides("?q=1,2"), Asked::Collides { values: "1,2".to_owned() });
        assert_eq!(collides("?1,2"), Asked::Refused("400 Bad Request"));
        for host in ["", "Host: example.org:4711", "Host: 127.0.0.1", "Host: 127.0.0.1:47110"] {
            assert_eq!(asked(&page, host), Asked::Refused("403 Forbidden"), "{host}");
        }
        let twice = format!("{own}\r\nHost: example.org");
        assert_eq!(asked(&page, &twice), Asked::Refused("403 Forbidden"));
        for (line, status) in [
            ("GET / HTTP/1.1".to_owned(), "404 Not Found"),
            (format!("GET /{}/ HTTP/1.1", TOKEN.replace('f', "e")), "404 Not Found"),
            (format!("GET /{}/ HTTP/1.1", &TOKEN[1..]), "404 Not Found"),
            (format!("GET /{TOKEN} HTTP/1.1"), "404 Not Found"),
            (format!("GET /{TOKEN}/../ledger HTTP/1.1"), "404 Not Found"),
            (format!("POST /{TOKEN}/ HTTP/1.1"), "405 Method Not Allowed"),
            (format!("GET /{TOKEN}/ HTTP/2"), "400 Bad Request"),
            ("".to_owned(), "400 Bad Request"),
        ] {
            assert_eq!(asked(&line, own), Asked::Refused(status), "{line}");
        }
    }

    #[test]
    fn the_oldest_connection_is_closed_for_one_too_many() {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
        let address = listener.local_addr().expect("an address");
        let mut guests = Guests::default();
        let mut enter = || {
            let outside = TcpStream::connect(address).expect("it listens");
            let (inside, _) = listener.accept().expect("a connection");
            (guests.enter(inside), outside)
        };
        let mut outside: Vec<_> = (0..=GUESTS_MAX).map(|_| enter()).collect();
        let mut is_closed = |index: usize| {
            let stream: &mut TcpStream = &mut outside[index].1;
            stream.set_nonblocking(index > 0).expect("it can be set");
            matches!(stream.read(&mut [0]), Ok(0))
        };
        assert_eq!([is_closed(0), is_closed(1), is_closed(GUESTS_MAX)], [true, false, false]);
        assert_eq!(guests.streams.len(), GUESTS_MAX);
        let numbers: Vec<u64> = outside.iter().map(|(number, _)| *number).collect();
        assert_eq!(numbers, (0..=GUESTS_MAX as u64).collect::<Vec<_>>());
        // The one that was closed leaves a second time.
        guests.leave(0);
        guests.leave(1);
        assert_eq!(guests.streams.len(), GUESTS_MAX - 1);
    }

    #[test]
    fn tokens_differ() {
        let tokens = [token().expect("chance"), token().expect("chance")];
        assert!(tokens[0] != tokens[1] && tokens.iter().all(|token| token.len() == 32));
    }
}
