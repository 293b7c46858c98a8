//! A server of files in memory: a request a connection, GET and HEAD alone, and a bound on everything that a client may make it keep.
//!
//! A connection takes one of [`MOST_CONNECTIONS`] places until it has its answer. Where all are taken, the client that has had the longest time to send its
//! request, and has not, gives up its place to the next one; if all of them take their answers, the next one is refused. Both get the status 503, and the time
//! to read it.

use super::{CODINGS, File, Site};
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
/// [`Times::request`] of `pantin serve`.
pub const PATIENCE: Duration = Duration::from_secs(5);
/// How long a client has for its request's head in any case, where others wait for its place.
const SHORT_PATIENCE: Duration = Duration::from_millis(200);
/// [`Times::answer`] of `pantin serve`.
const ANSWER_TIME: Duration = Duration::from_secs(10);
/// Bytes per second at which a client must take an answer.
const SLOWEST: usize = 512 << 10;
/// The time that a client has to close the connection after its answer.
const CLOSE_TIME: Duration = Duration::from_millis(500);
const MOST_HEADERS: usize = 64;
/// Bytes that are read of what a client still sends once it has its answer: unread, they would take it back from the client.
const MOST_REST: usize = 64 << 10;

/// The times that clients have.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    /// How long a request's head may take to come, and how long a client may take no byte of the answer.
    pub request: Duration,
    /// The time in which a client must have taken its answer, plus one second per 512 KiB.
    pub answer: Duration,
}

impl Default for Times {
    /// [`PATIENCE`] and 10 s.
    fn default() -> Times {
        Times { request: PATIENCE, answer: ANSWER_TIME }
    }
}

/// Serves for ever. A listener on a loopback address answers only requests whose header `Host`, if there is one, names this machine and the port: a page of
/// another site whose name leads here gets nothing.
pub fn serve(listener: &TcpListener, site: Site, times: Times) {
    let site = Arc::new(site);
    let places = Arc::new(Places { times, ..Places::default() });
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
    times: Times,
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
    Part,
    Unchanged,
    Malformed,
    Forbidden,
    Missing,
    Method,
    Late,
    Beyond,
    TooLong,
    Busy,
}

impl Status {
    fn line(self) -> &'static str {
        match self {
            Status::Good => "200 OK",
            Status::Part => "206 Partial Content",
            Status::Unchanged => "304 Not Modified",
            Status::Malformed => "400 Bad Request",
            Status::Forbidden => "403 Forbidden",
            Status::Missing => "404 Not Found",
            Status::Method => "405 Method Not Allowed",
            Status::Late => "408 Request Timeout",
            Status::Beyond => "416 Range Not Satisfiable",
            Status::TooLong => "431 Request Header Fields Too Large",
            Status::Busy => "503 Service Unavailable",
        }
    }
}

fn attend(stream: &TcpStream, site: &Site, local: Option<SocketAddr>, mut guest: Guest) -> io::Result<()> {
    let times = guest.places.times;
    stream.set_write_timeout(Some(times.request))?;
    let mut buffer = [0; MOST_HEAD];
    let refused = guest.stage == Stage::Closing;
    let request = if refused { Err(Status::Busy) } else { head(stream, &mut buffer, &guest) };
    let kept = !refused && guest.go_on(Stage::Answered);
    match request {
        _ if !kept => refuse(stream, Status::Busy, true, Times { answer: CLOSE_TIME, ..times })?,
        Err(status) => refuse(stream, status, true, times)?,
        Ok(Request { hosts, .. }) if !local.is_none_or(|local| hosts.iter().all(|host| is_here(host, local))) => {
            refuse(stream, Status::Forbidden, true, times)?;
        }
        Ok(request) => {
            let path = request.path.split('?').next().unwrap_or_default();
            let (wants_body, allowed) = (request.method == "GET", ["GET", "HEAD"].contains(&request.method));
            match site.file(path) {
                _ if !allowed => refuse(stream, Status::Method, true, times)?,
                None => refuse(stream, Status::Missing, wants_body, times)?,
                Some(file) => send(stream, site, path, file, &request, times)?,
            }
        }
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
    /// What the client has, takes and asks for: headers `If-None-Match`, `Accept-Encoding` and `Range`, empty without them.
    tags: &'b str,
    codings: &'b str,
    range: &'b str,
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
    let until = Instant::now() + guest.places.times.request;
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
            let named = |name: &'static str| request.headers.iter().filter(move |header| header.name.eq_ignore_ascii_case(name));
            let text = |name| named(name).next().and_then(|header| std::str::from_utf8(header.value).ok()).unwrap_or_default();
            let hosts = named("host").map(|header| header.value).collect();
            let [tags, codings, range] = ["if-none-match", "accept-encoding", "range"].map(text);
            Ok(Request { method, path, hosts, tags, codings, range })
        }
        _ => Err(Status::Malformed),
    }
}

/// Sends a file: in a coding that the client takes, or a part of it, or word that it has not changed.
fn send(stream: &TcpStream, site: &Site, path: &str, file: &File, request: &Request<'_>, times: Times) -> io::Result<()> {
    // A part of a file is one of its own bytes.
    let mut codings = CODINGS.iter().filter(|coding| request.range.is_empty() && takes(request.codings, coding.name));
    let coded = codings.find_map(|coding| Some((coding, site.coded(path, coding)?)));
    let tag = coded.as_ref().map_or(&file.tag, |(_, file)| &file.tag);
    let mut head = format!("Content-Type: {}\r\nETag: {tag}\r\nAccept-Ranges: bytes\r\nVary: Accept-Encoding\r\n", file.kind);
    if site.shared {
        head += "Access-Control-Allow-Origin: *\r\n";
    }
    let all = file.bytes.as_slice();
    let (status, bytes) = match (&coded, part(request.range, all.len())) {
        _ if request.tags.split(',').any(|known| known.trim().trim_start_matches("W/") == tag) => (Status::Unchanged, &[][..]),
        (Some((coding, file)), _) => {
            head += &format!("Content-Encoding: {}\r\n", coding.name);
            (Status::Good, file.bytes.as_slice())
        }
        (None, Some(Some((from, to)))) => {
            head += &format!("Content-Range: bytes {from}-{}/{}\r\n", to - 1, all.len());
            (Status::Part, all.get(from..to).unwrap_or_default())
        }
        (None, Some(None)) => {
            head += &format!("Content-Range: bytes */{}\r\n", all.len());
            (Status::Beyond, &[][..])
        }
        (None, None) => (Status::Good, all),
    };
    answer(stream, status, &head, bytes, request.method == "GET", times)
}

/// Whether a header `Accept-Encoding` names a coding, and not with the weight 0.
fn takes(header: &str, coding: &str) -> bool {
    header.split(',').any(|choice| {
        let mut parts = choice.split(';').map(str::trim);
        let named = parts.next().is_some_and(|name| name.eq_ignore_ascii_case(coding));
        named && !parts.any(|part| part.strip_prefix("q=").is_some_and(|weight| weight.parse() == Ok(0.0)))
    })
}

/// The bytes that a header `Range` asks for, from one to before another; `Some(None)` if the file has none of them, `None` for all. Several ranges get all.
fn part(header: &str, len: usize) -> Option<Option<(usize, usize)>> {
    let (from, to) = header.strip_prefix("bytes=")?.split_once('-')?;
    let number = |text: &str| text.trim().parse::<usize>();
    let range = match (number(from), number(to)) {
        (Ok(from), Ok(to)) if to >= from => (from, to.saturating_add(1).min(len)),
        (Ok(from), Err(_)) if to.trim().is_empty() => (from, len),
        (Err(_), Ok(last)) if from.trim().is_empty() => (len.saturating_sub(last), len),
        _ => return None,
    };
    Some(Some(range).filter(|(from, to)| from < to))
}

/// Writes an answer without a file.
fn refuse(stream: &TcpStream, status: Status, body: bool, times: Times) -> io::Result<()> {
    let help = match status {
        Status::Forbidden => "The Host header names another server. Open the URL that `pantin serve` prints.\n",
        _ => "",
    };
    let allow = if let Status::Method = status { "Allow: GET, HEAD\r\n" } else { "" };
    let text = format!("{}\n{help}", status.line());
    answer(stream, status, &format!("Content-Type: text/plain\r\n{allow}"), text.as_bytes(), body, times)
}

/// Writes an answer within its time and what its length adds to that.
fn answer(stream: &TcpStream, status: Status, head: &str, bytes: &[u8], body: bool, times: Times) -> io::Result<()> {
    let head = format!(
        "HTTP/1.1 {}\r\nContent-Length: {}\r\n{head}X-Content-Type-Options: nosniff\r\nCache-Control: no-cache\r\nConnection: close\r\n\r\n",
        status.line(),
        bytes.len()
    );
    let until = Instant::now() + times.answer + Duration::from_secs((bytes.len() / SLOWEST) as u64);
    write_until(stream, head.as_bytes(), until, times)?;
    if body { write_until(stream, bytes, until, times) } else { Ok(()) }
}

/// Writes all bytes, or fails at the deadline: a client that takes a byte now and then must not hold its connection for ever.
fn write_until(mut stream: &TcpStream, mut bytes: &[u8], until: Instant, times: Times) -> io::Result<()> {
    while !bytes.is_empty() {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.set_write_timeout(Some(left.min(times.request)))?;
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
