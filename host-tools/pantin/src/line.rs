//! A line to a board: a serial port, or a TCP connection in its place.

use anyhow::{Context, Result};
use serial2::SerialPort;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// How long a look for bytes takes.
const LOOK: Duration = Duration::from_millis(20);
/// How long a board may not take bytes before that is an error.
pub const STUCK: Duration = Duration::from_secs(5);

/// An open line. Reading takes no longer than a look.
pub enum Line {
    /// A serial port.
    Serial(SerialPort),
    /// A TCP connection.
    Tcp(TcpStream),
}

impl Line {
    /// Opens a serial port.
    pub fn serial(port: &str, baud: u32) -> Result<Line> {
        let ports = || {
            let ports = SerialPort::available_ports().unwrap_or_default();
            let ports: Vec<String> = ports.iter().map(|port| port.display().to_string()).collect();
            format!(
                "{port}: cannot be opened; serial ports here: {}",
                if ports.is_empty() { "none".into() } else { ports.join(", ") }
            )
        };
        let mut line = SerialPort::open(port, baud).with_context(ports)?;
        line.set_read_timeout(LOOK)?;
        line.set_write_timeout(STUCK)?;
        Ok(Line::Serial(line))
    }

    /// Connects.
    pub fn tcp(address: &str) -> Result<Line> {
        let line = TcpStream::connect(address).with_context(|| format!("{address}: cannot connect"))?;
        line.set_nodelay(true)?;
        line.set_read_timeout(Some(LOOK))?;
        line.set_write_timeout(Some(STUCK))?;
        Ok(Line::Tcp(line))
    }
}

/// Whether `address` is HOST:PORT, with a port from 1 to 65,535.
pub fn is_address(address: &str) -> bool {
    let port = address.rsplit_once(':').filter(|(host, _)| !host.is_empty());
    port.and_then(|(_, port)| port.parse::<u16>().ok()).is_some_and(|port| port > 0)
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
