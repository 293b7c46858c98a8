//! A face that is recorded now: Live Link Face's datagrams, or lines of its CSV on stdin.

use anyhow::{Context, Result, bail, ensure};
use pantin_convert::import::live_link_name;
use pantin_convert::import::text::quoted;
use pantin_convert::input;
use std::io::{self, BufRead, BufReader, ErrorKind};
use std::net::UdpSocket;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

/// Lines that are read before they are asked for.
const LINES_AHEAD: usize = 64;
/// How often a feed that waits for a line looks whether it was stopped.
const STOP_CHECK: Duration = Duration::from_millis(50);

/// Values of a frame by name, in the order of [`Feed::names`].
pub type Values = Vec<f64>;

/// Where frames come from.
pub enum Feed {
    /// A header, then a line a frame.
    Lines {
        /// What is left to read.
        lines: Receiver<Result<String>>,
        /// Names of the columns behind the first two.
        names: Vec<String>,
    },
    /// Datagrams: the last one counts.
    Datagrams {
        /// Where they come.
        socket: UdpSocket,
        /// How many held no face, or a value that is no number, and were left out.
        left_out: u32,
    },
}

/// Blend shapes and angles of a datagram: as in the app's files, but for the jaw's and the mouth's left and right.
fn datagram_names() -> Vec<String> {
    let mut names: Vec<String> = pantin::names::LIVE_LINK.split(' ').map(String::from).collect();
    for [one, other] in [["JawLeft", "JawRight"], ["MouthLeft", "MouthRight"]] {
        let place = |name: &str| names.iter().position(|own| own == name);
        if let (Some(a), Some(b)) = (place(one), place(other)) {
            names.swap(a, b);
        }
    }
    names
}

/// The values of a datagram: version, device (37 bytes), length and letters of the subject's name, frame (8), rate (8), how many, and as many floats,
/// the most significant byte first. None for one without a face, or with a value that is no number.
fn parse_datagram(bytes: &[u8]) -> Option<Values> {
    let (name, rest) = bytes.get(41..)?.split_first_chunk::<4>().map(|(len, rest)| (u32::from_be_bytes(*len) as usize, rest))?;
    let (head, values) = rest.get(name..)?.split_first_chunk::<17>()?;
    let (values, _) = values.as_chunks::<4>();
    let count = usize::from(head[16]);
    let values: Values = values.get(..count)?.iter().map(|bytes| f64::from(f32::from_be_bytes(*bytes))).collect();
    (count == 61 && values.iter().all(|value| value.is_finite())).then_some(values)
}

impl Feed {
    /// `-` is stdin, `udp:PORT` the datagrams that come to that port. Returns an error if `stop` is set before there is a header.
    pub fn open(from: &str, stop: &AtomicBool) -> Result<Feed> {
        if from == "-" {
            return Feed::lines(BufReader::new(io::stdin()), stop);
        }
        let port = from.strip_prefix("udp:").and_then(|port| port.parse::<u16>().ok());
        let port = port.context("expected udp:PORT, or - for lines on stdin")?;
        let socket = UdpSocket::bind(("0.0.0.0", port)).context("the port cannot be had")?;
        Ok(Feed::Datagrams { socket, left_out: 0 })
    }

    fn lines(source: impl BufRead + Send + 'static, stop: &AtomicBool) -> Result<Feed> {
        let lines = read_lines(source);
        let header = next_line(&lines, stop)?.context("nothing on stdin; expected a header of Live Link Face")?;
        let mut cells = header.trim_start_matches('\u{feff}').split(',').map(|cell| cell.trim().to_owned());
        let named = |cell: Option<String>, name: &str| cell.is_some_and(|cell| cell.eq_ignore_ascii_case(name));
        ensure!(
            named(cells.next(), "Timecode") && named(cells.next(), "BlendshapeCount"),
            "line 1: expected `Timecode,BlendshapeCount,` and names of blend shapes"
        );
        let names = cells.map(|name| live_link_name(&name)).collect();
        Ok(Feed::Lines { lines, names })
    }

    /// Names of a frame's values.
    pub fn names(&self) -> Vec<String> {
        match self {
            Feed::Lines { names, .. } => names.clone(),
            Feed::Datagrams { .. } => datagram_names(),
        }
    }

    /// Datagrams that were left out so far.
    pub fn left_out(&self) -> u32 {
        match self {
            Feed::Lines { .. } => 0,
            Feed::Datagrams { left_out, .. } => *left_out,
        }
    }

    /// The next frame of lines, or the last datagram that came within `wait`; `Ok(None)` at the end, and where `stop` is set.
    pub fn next(&mut self, wait: Duration, last: &Values, stop: &AtomicBool) -> Result<Option<Values>> {
        match self {
            Feed::Lines { lines, names } => loop {
                let Some(line) = next_line(lines, stop)? else { return Ok(None) };
                let cells: Vec<&str> = line.split(',').skip(2).map(str::trim).collect();
                if line.trim().is_empty() || line.split(',').nth(1).is_some_and(|count| count.trim() == "0") {
                    continue;
                }
                let values: Option<Values> =
                    cells.iter().map(|cell| cell.parse().ok().filter(|value: &f64| value.is_finite())).collect();
                match values.filter(|values| values.len() == names.len()) {
                    Some(values) => return Ok(Some(values)),
                    None => bail!("expected a timecode, a count and {} numbers, found {}", names.len(), quoted(&line)),
                }
            },
            Feed::Datagrams { socket, left_out } => {
                let mut latest = last.clone();
                let until = std::time::Instant::now() + wait;
                let mut room = [0; 2048];
                loop {
                    let left = until.saturating_duration_since(std::time::Instant::now());
                    if left.is_zero() {
                        return Ok(Some(latest));
                    }
                    socket.set_read_timeout(Some(left))?;
                    match socket.recv(&mut room) {
                        Ok(len) => match room.get(..len).and_then(parse_datagram) {
                            Some(values) => latest = values,
                            None => *left_out = left_out.saturating_add(1),
                        },
                        Err(error)
                            if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {}
                        Err(error) => return Err(error.into()),
                    }
                }
            }
        }
    }
}

/// Reads lines in a thread of their own: a read that waits cannot be stopped. The thread ends with the program.
fn read_lines(mut source: impl BufRead + Send + 'static) -> Receiver<Result<String>> {
    let (sender, lines) = sync_channel(LINES_AHEAD);
    thread::spawn(move || {
        while let Some(line) = input::line(&mut source).transpose() {
            let failed = line.is_err();
            if sender.send(line).is_err() || failed {
                break;
            }
        }
    });
    lines
}

/// The next line; `None` at the end, and where `stop` is set.
fn next_line(lines: &Receiver<Result<String>>, stop: &AtomicBool) -> Result<Option<String>> {
    while !stop.load(Ordering::Relaxed) {
        match lines.recv_timeout(STOP_CHECK) {
            Ok(line) => return line.map(Some).context("stdin"),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_datagram() {
        let mut bytes = 6u32.to_le_bytes().to_vec();
        bytes.extend([b'D'; 37]);
        bytes.extend(4u32.to_be_bytes());
        bytes.extend(b"face");
        bytes.extend([0; 16]);
        bytes.push(61);
        (0..61).for_each(|i| bytes.extend((i as f32 / 64.0).to_be_bytes()));
        let values = parse_datagram(&bytes).expect("a face");
        let names = datagram_names();
        let place = |name: &str| names.iter().position(|own| own == name).expect("its name");
        assert_eq!((values.len(), names.len(), values[place("JawOpen")]), (61, 61, 17.0 / 64.0));
        assert_eq!((place("JawLeft"), place("JawRight"), place("MouthLeft")), (15, 16, 21));
        for len in 0..bytes.len() {
            assert_eq!(parse_datagram(&bytes[..len]), None, "{len}");
        }
        let last = bytes.len() - 4;
        for odd in [f32::NAN, f32::INFINITY] {
            bytes[last..].copy_from_slice(&odd.to_be_bytes());
            assert_eq!(parse_datagram(&bytes), None, "{odd}");
        }
        bytes[41..45].fill(0xff);
        assert_eq!(parse_datagram(&bytes), None);
    }

    #[test]
    fn datagrams_that_hold_no_face_are_counted() {
        let mut feed = Feed::open("udp:0", &AtomicBool::new(false)).expect("a port");
        let Feed::Datagrams { socket, .. } = &feed else { panic!("datagrams") };
        let port = socket.local_addr().expect("its address").port();
        let sender = UdpSocket::bind("127.0.0.1:0").expect("a port");
        for _ in 0..3 {
            sender.send_to(b"no face", ("127.0.0.1", port)).expect("sent");
        }
        let last = vec![0.5; 61];
        let next = feed.next(Duration::from_millis(100), &last, &AtomicBool::new(false)).expect("a frame");
        assert_eq!((next, feed.left_out()), (Some(last), 3));
    }

    #[test]
    fn lines_of_its_csv() {
        let text = "Timecode,BlendShapeCount,EyeBlinkLeft,jawOpen\n0:0:0:1.0,2,0.5,0.25\n0:0:0:2.0,0\n0:0:0:3.0,2,x,1\n";
        let stop = AtomicBool::new(false);
        let mut feed = Feed::lines(text.as_bytes(), &stop).expect("a header");
        assert_eq!(feed.names(), ["EyeBlinkLeft", "JawOpen"]);
        assert_eq!(feed.next(Duration::ZERO, &vec![], &stop).unwrap(), Some(vec![0.5, 0.25]));
        assert!(feed.next(Duration::ZERO, &vec![], &stop).unwrap_err().to_string().contains("2 numbers"));
        assert_eq!(feed.next(Duration::ZERO, &vec![], &stop).unwrap(), None);
    }
}
