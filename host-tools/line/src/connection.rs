//! A connection to a board that keeps bytes in order: a serial port, or TCP in its place.

use anyhow::{Context, Result};
use serial2::SerialPort;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// How long a look for bytes takes.
const LOOK: Duration = Duration::from_millis(20);
/// How long a board may not take bytes before that is an error.
pub const STUCK: Duration = Duration::from_secs(5);

/// An open connection. Reading takes no longer than a look.
pub enum Connection {
    /// A serial port.
    Serial(SerialPort),
    /// A TCP connection.
    Tcp(TcpStream),
}

impl Connection {
    /// Opens a serial port.
    pub fn serial(port: &str, baud: u32) -> Result<Connection> {
        let ports = || {
            let ports = SerialPort::available_ports().unwrap_or_default();
            let ports: Vec<String> = ports.iter().map(|port| port.display().to_string()).collect();
            format!(
                "{port}: cannot be opened; serial ports here: {}",
                if ports.is_empty() { "none".into() } else { ports.join(", ") }
            )
        };
        let mut open = SerialPort::open(port, baud).with_context(ports)?;
        open.set_read_timeout(LOOK)?;
        open.set_write_timeout(STUCK)?;
        Ok(Connection::Serial(open))
    }

    /// Connects.
    pub fn tcp(address: &str) -> Result<Connection> {
        let open = TcpStream::connect(address).with_context(|| format!("{address}: cannot connect"))?;
        open.set_nodelay(true)?;
        open.set_read_timeout(Some(LOOK))?;
        open.set_write_timeout(Some(STUCK))?;
        Ok(Connection::Tcp(open))
    }
}

/// Whether `address` is HOST:PORT, with a port from 1 to 65,535.
pub fn is_address(address: &str) -> bool {
    let port = address.rsplit_once(':').filter(|(host, _)| !host.is_empty());
    port.and_then(|(_, port)| port.parse::<u16>().ok()).is_some_and(|port| port > 0)
}

impl Read for Connection {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        match self {
            Connection::Serial(port) => port.read(bytes),
            Connection::Tcp(stream) => stream.read(bytes),
        }
    }
}

impl Write for Connection {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Connection::Serial(port) => port.write(bytes),
            Connection::Tcp(stream) => stream.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Connection::Serial(port) => port.flush(),
            Connection::Tcp(stream) => stream.flush(),
        }
    }
}
