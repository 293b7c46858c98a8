//! A server of files in memory: a request a connection, GET and HEAD alone, and a bound on everything that a client may make it keep.

use super::Site;
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Bytes of a request's head at most.
pub const MOST_HEAD: usize = 8 << 10;
/// Connections at a time: each takes a thread and a head.
pub const MOST_CONNECTIONS: usize = 32;
/// How long a request's head may take to come, and how long a client may take no byte of the answer.
pub const PATIENCE: Duration = Duration::from_secs(5);
/// The time in which a client must have taken its answer, plus one second per [`SLOWEST`] bytes.
pub const ANSWER_TIME: Duration = Duration::from_secs(10);
/// Bytes per second at which a client must take an answer.
pub const SLOWEST: usize = 512 << 10;
/// The time that a client has to close the connection after its answer.
const CLOSE_TIME: Duration = Duration::from_millis(500);
const MOST_HEADERS: usize = 64;
/// Bytes that are read of what a client still sends once it has its answer: unread, they would take it back from the client.
const MOST_REST: usize = 64 << 10;

/// Serves for ever.
pub fn serve(listener: &TcpListener, site: Site) {
    let site = Arc::new(site);
    let open = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming() {
        // A connection that is gone before it was taken, or no file handle for one: others may come.
        let Ok(stream) = stream else {
            thread::sleep(Duration::from_millis(10));
            continue;
        };
        let guest = Guest::new(&open);
        if guest.number > MOST_CONNECTIONS {
            let _ = stream.set_write_timeout(Some(Duration::from_millis(100)));
            let _ = answer(&stream, Status::Busy, None, true);
            continue;
        }
        let site = site.clone();
        // Without a thread, the connection is dropped.
        let _ = thread::Builder::new().stack_size(256 << 10).spawn(move || {
            let _guest = guest;
            // What goes wrong between us concerns no other client.
            let _ = attend(&stream, &site);
        });
    }
}

/// One of the connections that are open.
struct Guest {
    open: Arc<AtomicUsize>,
    number: usize,
}

impl Guest {
    fn new(open: &Arc<AtomicUsize>) -> Guest {
        Guest { open: open.clone(), number: open.fetch_add(1, Ordering::Relaxed) + 1 }
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        self.open.fetch_sub(1, Ordering::Relaxed);
    }
}

#[derive(Clone, Copy)]
enum Status {
    Good,
    Malformed,
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
            Status::Missing => "404 Not Found",
            Status::Method => "405 Method Not Allowed",
            Status::Late => "408 Request Timeout",
            Status::TooLong => "431 Request Header Fields Too Large",
            Status::Busy => "503 Service Unavailable",
        }
    }
}

fn attend(stream: &TcpStream, site: &Site) -> io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut buffer = [0; MOST_HEAD];
    match head(stream, &mut buffer) {
        Err(status) => answer(stream, status, None, true)?,
        Ok(Request { method, path }) => match site.file(path.split('?').next().unwrap_or_default()) {
            _ if method != "GET" && method != "HEAD" => answer(stream, Status::Method, None, true)?,
            None => answer(stream, Status::Missing, None, method == "GET")?,
            file => answer(stream, Status::Good, file, method == "GET")?,
        },
    }
    finish(stream)
}

struct Request<'b> {
    method: &'b str,
    path: &'b str,
}

/// Reads until the head is whole.
fn head<'b>(mut stream: &TcpStream, buffer: &'b mut [u8; MOST_HEAD]) -> Result<Request<'b>, Status> {
    let until = Instant::now() + PATIENCE;
    let mut len = 0;
    loop {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
            return Err(Status::Late);
        }
        match stream.read(&mut buffer[len..]) {
            Ok(0) if len == MOST_HEAD => return Err(Status::TooLong),
            Ok(0) => return Err(Status::Malformed),
            Ok(count) => len += count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
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
        (Ok(_), Some(method), Some(path)) => Ok(Request { method, path }),
        _ => Err(Status::Malformed),
    }
}

fn answer(stream: &TcpStream, status: Status, file: Option<&super::File>, body: bool) -> io::Result<()> {
    let line = status.line();
    let own = format!("{line}\n");
    let (bytes, kind) = file.map_or((own.as_bytes(), "text/plain"), |file| (&file.bytes, file.kind));
    let allow = if let Status::Method = status { "Allow: GET, HEAD\r\n" } else { "" };
    let head = format!(
        "HTTP/1.1 {line}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{allow}X-Content-Type-Options: nosniff\r\n\
         Cache-Control: no-cache\r\nConnection: close\r\n\r\n",
        bytes.len()
    );
    let until = Instant::now() + ANSWER_TIME + Duration::from_secs((bytes.len() / SLOWEST) as u64);
    write_until(stream, head.as_bytes(), until)?;
    if body { write_until(stream, bytes, until) } else { Ok(()) }
}

/// Writes all bytes, or fails at the deadline: a client that takes a byte now and then must not hold its connection for ever.
fn write_until(mut stream: &TcpStream, mut bytes: &[u8], until: Instant) -> io::Result<()> {
    while !bytes.is_empty() {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        stream.set_write_timeout(Some(left.min(PATIENCE)))?;
        match stream.write(bytes) {
            Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
            Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
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
