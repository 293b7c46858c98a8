//! A server of files in memory: a request a connection, GET and HEAD alone, and a bound on everything that a client may make it keep.
//!
//! A connection takes one of [`MOST_CONNECTIONS`] places until it has its answer. Where all are taken, the client that has had the longest time to send its
//! request, and has not, gives up its place to the next one; if all of them take their answers, the next one is refused. Both get the status 503, and the time
//! to read it.

use super::Site;
use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Bytes of a request's head at most.
pub const MOST_HEAD: usize = 8 << 10;
/// Connections at a time: each takes a thread and a head.
pub const MOST_CONNECTIONS: usize = 32;
/// Connections that have their answer and are not closed yet: each takes a thread for [`CLOSE_TIME`] at most. Others wait in the system's queue.
const MOST_CLOSING: usize = 96;
/// How long a request's head may take to come, and how long a client may take no byte of the answer.
pub const PATIENCE: Duration = Duration::from_secs(5);
/// How long a client has for its request's head in any case, where others wait for its place.
const SHORT_PATIENCE: Duration = Duration::from_millis(200);
/// The time in which a client must have taken its answer, plus one second per [`SLOWEST`] bytes.
pub const ANSWER_TIME: Duration = Duration::from_secs(10);
/// Bytes per second at which a client must take an answer.
pub const SLOWEST: usize = 512 << 10;
/// The time that a client has to close the connection after its answer.
const CLOSE_TIME: Duration = Duration::from_millis(500);
const MOST_HEADERS: usize = 64;
/// Bytes that are read of what a client still sends once it has its answer: unread, they would take it back from the client.
const MOST_REST: usize = 64 << 10;

/// Serves for ever. A listener on a loopback address answers only requests whose header `Host`, if there is one, names this machine and the port: a page of
/// another site whose name leads here gets nothing.
pub fn serve(listener: &TcpListener, site: Site) {
    let site = Arc::new(site);
    let places = Arc::new(Places::default());
    let local = listener.local_addr().ok().filter(|address| address.ip().is_loopback());
    for stream in listener.incoming() {
        // A connection that is gone before it was taken, or no file handle for one: others may come.
        let Ok(stream) = stream else {
            thread::sleep(Duration::from_millis(10));
            continue;
        };
        let guest = Places::enter(&places);
        let site = site.clone();
        // Without a thread, the connection is dropped.
        let _ = thread::Builder::new().stack_size(256 << 10).spawn(move || {
            // What goes wrong between us concerns no other client.
            let _ = attend(&stream, &site, local, guest);
        });
    }
}

/// The places of connections.
#[derive(Default)]
struct Places {
    taken: Mutex<Taken>,
    changed: Condvar,
}

#[derive(Default)]
struct Taken {
    /// The number of the next connection.
    next: u64,
    /// Connections whose request is still to come, by their numbers, with the time when they came.
    asking: BTreeMap<u64, Instant>,
    /// Number of those that take their answer.
    answered: usize,
    /// Number of those that have their answer, or were refused.
    closing: usize,
}

/// What a connection is at.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Asking,
    Answered,
    Closing,
}

/// One of the connections that are open.
struct Guest {
    places: Arc<Places>,
    number: u64,
    stage: Stage,
}

impl Places {
    /// Finds a place for a connection. It is refused, which its stage says, where all others take their answers.
    fn enter(places: &Arc<Places>) -> Guest {
        let mut taken = places.lock();
        let stage = loop {
            let now = Instant::now();
            let oldest = taken.asking.first_key_value().map(|(&number, &since)| (number, since + SHORT_PATIENCE));
            let full = taken.asking.len() + taken.answered >= MOST_CONNECTIONS;
            match oldest {
                _ if taken.closing >= MOST_CLOSING => taken = places.wait(taken, CLOSE_TIME),
                _ if !full => break Stage::Asking,
                Some((number, until)) if until <= now => {
                    // Its thread sees that soon.
                    taken.asking.remove(&number);
                    taken.closing += 1;
                }
                Some((_, until)) => taken = places.wait(taken, until - now),
                None => break Stage::Closing,
            }
        };
        let number = taken.next;
        taken.next += 1;
        match stage {
            Stage::Asking => drop(taken.asking.insert(number, Instant::now())),
            Stage::Answered => taken.answered += 1,
            Stage::Closing => taken.closing += 1,
        }
        Guest { places: places.clone(), number, stage }
    }

    fn lock(&self) -> MutexGuard<'_, Taken> {
        self.taken.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until a place is free, or for `most`.
    fn wait<'a>(&self, taken: MutexGuard<'a, Taken>, most: Duration) -> MutexGuard<'a, Taken> {
        self.changed.wait_timeout(taken, most).unwrap_or_else(PoisonError::into_inner).0
    }
}

impl Guest {
    /// Whether another connection has got the place while the request was to come.
    fn lost_its_place(&self) -> bool {
        self.stage == Stage::Asking && !self.places.lock().asking.contains_key(&self.number)
    }

    /// Goes on to `stage`. Returns whether the connection still had its place: another one may have got it while the request was to come.
    fn go_on(&mut self, stage: Stage) -> bool {
        let mut taken = self.places.lock();
        let kept = taken.leave(self.number, self.stage);
        self.stage = if kept { stage } else { Stage::Closing };
        match self.stage {
            Stage::Asking => {}
            Stage::Answered => taken.answered += 1,
            // One that lost its place is counted already.
            Stage::Closing => taken.closing += usize::from(kept),
        }
        self.places.changed.notify_all();
        kept
    }
}

impl Taken {
    /// Frees a place. Returns whether the connection had it.
    fn leave(&mut self, number: u64, stage: Stage) -> bool {
        match stage {
            Stage::Asking => return self.asking.remove(&number).is_some(),
            Stage::Answered => self.answered -= 1,
            Stage::Closing => self.closing -= 1,
        }
        true
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        let mut taken = self.places.lock();
        if !taken.leave(self.number, self.stage) {
            // It lost its place and has not heard of it.
            taken.closing -= 1;
        }
        self.places.changed.notify_all();
    }
}

#[derive(Clone, Copy)]
enum Status {
    Good,
    Malformed,
    Forbidden,
    Missing,
    Method,
    Late,
    TooLong,
    Busy,
}

impl Status {
    fn line(self) -> &'static str {
        match self {
            Status::Good => "200 OK",
            Status::Malformed => "400 Bad Request",
            Status::Forbidden => "403 Forbidden",
            Status::Missing => "404 Not Found",
            Status::Method => "405 Method Not Allowed",
            Status::Late => "408 Request Timeout",
            Status::TooLong => "431 Request Header Fields Too Large",
            Status::Busy => "503 Service Unavailable",
        }
    }
}

fn attend(stream: &TcpStream, site: &Site, local: Option<SocketAddr>, mut guest: Guest) -> io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut buffer = [0; MOST_HEAD];
    let refused = guest.stage == Stage::Closing;
    let request = if refused { Err(Status::Busy) } else { head(stream, &mut buffer, &guest) };
    let kept = !refused && guest.go_on(Stage::Answered);
    match request {
        _ if !kept => answer(stream, Status::Busy, None, true, CLOSE_TIME)?,
        Err(status) => answer(stream, status, None, true, ANSWER_TIME)?,
        Ok(Request { hosts, .. }) if !local.is_none_or(|local| hosts.iter().all(|host| is_here(host, local))) => {
            answer(stream, Status::Forbidden, None, true, ANSWER_TIME)?;
        }
        Ok(Request { method, path, .. }) => match site.file(path.split('?').next().unwrap_or_default()) {
            _ if method != "GET" && method != "HEAD" => answer(stream, Status::Method, None, true, ANSWER_TIME)?,
            None => answer(stream, Status::Missing, None, method == "GET", ANSWER_TIME)?,
            file => answer(stream, Status::Good, file, method == "GET", ANSWER_TIME)?,
        },
    }
    if kept {
        guest.go_on(Stage::Closing);
    }
    finish(stream)
}

struct Request<'b> {
    method: &'b str,
    path: &'b str,
    /// What its headers `Host` say.
    hosts: Vec<&'b [u8]>,
}

/// Whether a header `Host` names the server at the loopback address `local`.
fn is_here(host: &[u8], local: SocketAddr) -> bool {
    let port = local.port();
    let names = ["localhost", "127.0.0.1", "[::1]"].map(|name| format!("{name}:{port}"));
    let is = |name: &str| {
        let bare = name.strip_suffix(":80").unwrap_or(name);
        host.eq_ignore_ascii_case(name.as_bytes()) || host.eq_ignore_ascii_case(bare.as_bytes())
    };
    names.iter().any(|name| is(name)) || is(&local.to_string())
}

/// Reads until the head is whole, or the place is lost.
fn head<'b>(mut stream: &TcpStream, buffer: &'b mut [u8; MOST_HEAD], guest: &Guest) -> Result<Request<'b>, Status> {
    let until = Instant::now() + PATIENCE;
    let mut len = 0;
    loop {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() || stream.set_read_timeout(Some(left.min(SHORT_PATIENCE))).is_err() {
            return Err(Status::Late);
        }
        if guest.lost_its_place() {
            return Err(Status::Busy);
        }
        match stream.read(&mut buffer[len..]) {
            Ok(0) if len == MOST_HEAD => return Err(Status::TooLong),
            Ok(0) => return Err(Status::Malformed),
            Ok(count) => len += count,
            // Such as the end of a turn of waiting.
            Err(error) if matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                continue;
            }
            Err(_) => return Err(Status::Late),
        }
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        match httparse::Request::new(&mut headers).parse(&buffer[..len]) {
            Ok(httparse::Status::Complete(_)) => break,
            Ok(httparse::Status::Partial) => {}
            Err(httparse::Error::TooManyHeaders) => return Err(Status::TooLong),
            Err(_) => return Err(Status::Malformed),
        }
    }
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut request = httparse::Request::new(&mut headers);
    // It was whole above; what it borrows could not be handed out there.
    let parsed = request.parse(&buffer[..len]);
    match (parsed, request.method, request.path) {
        (Ok(_), Some(method), Some(path)) => {
            let hosts = request.headers.iter().filter(|header| header.name.eq_ignore_ascii_case("host"));
            Ok(Request { method, path, hosts: hosts.map(|header| header.value).collect() })
        }
        _ => Err(Status::Malformed),
    }
}

/// Writes an answer within `time` and what a file's length adds to it.
fn answer(stream: &TcpStream, status: Status, file: Option<&super::File>, body: bool, time: Duration) -> io::Result<()> {
    let line = status.line();
    let help = match status {
        Status::Forbidden => "The Host header names another server. Open the URL that `pantin serve` prints.\n",
        _ => "",
    };
    let own = format!("{line}\n{help}");
    let (bytes, kind) = file.map_or((own.as_bytes(), "text/plain"), |file| (&file.bytes, file.kind));
    let allow = if let Status::Method = status { "Allow: GET, HEAD\r\n" } else { "" };
    let head = format!(
        "HTTP/1.1 {line}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{allow}X-Content-Type-Options: nosniff\r\n\
         Cache-Control: no-cache\r\nConnection: close\r\n\r\n",
        bytes.len()
    );
    let until = Instant::now() + time + Duration::from_secs((bytes.len() / SLOWEST) as u64);
    write_until(stream, head.as_bytes(), until)?;
    if body { write_until(stream, bytes, until) } else { Ok(()) }
}

/// Writes all bytes, or fails at the deadline: a client that takes a byte now and then must not hold its connection for ever.
fn write_until(mut stream: &TcpStream, mut bytes: &[u8], until: Instant) -> io::Result<()> {
    while !bytes.is_empty() {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.set_write_timeout(Some(left.min(PATIENCE)))?;
        match stream.write(bytes) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// Lets the client read the answer before the connection closes: what it still sends is read for [`CLOSE_TIME`] at most.
fn finish(mut stream: &TcpStream) -> io::Result<()> {
    stream.shutdown(Shutdown::Write)?;
    let until = Instant::now() + CLOSE_TIME;
    let (mut rest, mut buffer) = (0, [0; 1024]);
    while rest < MOST_REST {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            break;
        }
        stream.set_read_timeout(Some(left))?;
        match stream.read(&mut buffer)? {
            0 => break,
            count => rest += count,
        }
    }
    Ok(())
}
