//! Lines to boards.

use anyhow::{Context, Result};
use serial2::SerialPort;
use std::fmt;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::str::FromStr;
use std::time::Duration;

/// How long a look for bytes takes.
const LOOK: Duration = Duration::from_millis(20);
/// How long a board may not take bytes before that is an error.
const STUCK: Duration = Duration::from_secs(5);
/// The boards' speed.
const BAUD: u32 = 115_200;

/// Where a board is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// At a serial port.
    Serial {
        /// Its name.
        port: String,
        /// Bits a second.
        baud: u32,
    },
    /// Behind a TCP connection.
    Tcp(String),
}

impl FromStr for Place {
    type Err = String;

    fn from_str(text: &str) -> Result<Place, String> {
        let expected = "expected serial:PORT[@BAUD], like serial:/dev/ttyACM0@115200, or tcp:HOST:PORT";
        if let Some(port) = text.strip_prefix("serial:") {
            let (port, baud) = match port.rsplit_once('@') {
                Some((port, baud)) => (port, baud.parse().map_err(|_| format!("\"{baud}\" is no number; {expected}"))?),
                None => (port, BAUD),
            };
            if !port.is_empty() && baud > 0 {
                return Ok(Place::Serial { port: port.into(), baud });
            }
        }
        match text.strip_prefix("tcp:") {
            Some(address) if address.contains(':') => Ok(Place::Tcp(address.into())),
            _ => Err(expected.into()),
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Serial { port, baud } => write!(f, "{port} at {baud} baud"),
            Place::Tcp(address) => f.write_str(address),
        }
    }
}

/// An open line. Reading takes no longer than a look.
pub enum Line {
    /// A serial port.
    Serial(SerialPort),
    /// A TCP connection.
    Tcp(TcpStream),
}

impl Line {
    /// Opens it.
    pub fn open(place: &Place) -> Result<Line> {
        match place {
            Place::Serial { port, baud } => {
                let ports = || {
                    let ports = SerialPort::available_ports().unwrap_or_default();
                    let ports: Vec<String> = ports.iter().map(|port| port.display().to_string()).collect();
                    format!(
                        "{port}: cannot be opened; serial ports here: {}",
                        if ports.is_empty() { "none".into() } else { ports.join(", ") }
                    )
                };
                let mut line = SerialPort::open(port, *baud).with_context(ports)?;
                line.set_read_timeout(LOOK)?;
                line.set_write_timeout(STUCK)?;
                Ok(Line::Serial(line))
            }
            Place::Tcp(address) => {
                let line = TcpStream::connect(address).with_context(|| format!("{address}: no connection"))?;
                line.set_nodelay(true)?;
                line.set_read_timeout(Some(LOOK))?;
                line.set_write_timeout(Some(STUCK))?;
                Ok(Line::Tcp(line))
            }
        }
    }
}

impl Read for Line {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        match self {
            Line::Serial(line) => line.read(bytes),
            Line::Tcp(line) => line.read(bytes),
        }
    }
}

impl Write for Line {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Line::Serial(line) => line.write(bytes),
            Line::Tcp(line) => line.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Line::Serial(line) => line.flush(),
            Line::Tcp(line) => line.flush(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_read() {
        let serial = |port: &str, baud| Ok(Place::Serial { port: port.into(), baud });
        assert_eq!("serial:/dev/ttyACM0".parse(), serial("/dev/ttyACM0", 115_200));
        assert_eq!("serial:COM3@9600".parse(), serial("COM3", 9600));
        assert_eq!("tcp:localhost:4000".parse(), Ok(Place::Tcp("localhost:4000".into())));
        assert!(
            ["", "serial:", "serial:@9600", "serial:a@b", "serial:a@0", "tcp:localhost", "/dev/ttyACM0"]
                .iter()
                .all(|text| text.parse::<Place>().is_err())
        );
    }
}
