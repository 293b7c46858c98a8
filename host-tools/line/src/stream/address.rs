//! Where motion is sent to: a serial line, a TCP connection, or UDP datagrams.

use crate::connection::{self, Connection, STUCK};
use anyhow::{Context, Result, bail};
use std::io::{ErrorKind, Write};
use std::net::UdpSocket;
use std::str::FromStr;

/// Baud of a line that names none.
const BAUD: u32 = 38_400;
/// Bits that a byte takes on a serial line: with start and stop.
const BITS: f64 = 10.0;

/// `serial:DEVICE`, `tcp:HOST:PORT` or `udp:HOST:PORT`, each with `@BAUD` after it if it is not 38,400.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    way: Way,
    to: String,
    baud: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Serial,
    Tcp,
    Udp,
}

impl FromStr for Address {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Address> {
        let expected = "expected serial:DEVICE, tcp:HOST:PORT or udp:HOST:PORT, with @BAUD after it if it is not 38400";
        let (way, rest) = text.split_once(':').context(expected)?;
        let way = match way {
            "serial" => Way::Serial,
            "tcp" => Way::Tcp,
            "udp" => Way::Udp,
            _ => bail!("{way}: {expected}"),
        };
        let (to, baud) = match rest.rsplit_once('@') {
            Some((to, baud)) => (
                to,
                baud.parse().ok().filter(|&baud| baud >= 300).with_context(|| format!("@{baud}: expected 300 baud or more"))?,
            ),
            None => (rest, BAUD),
        };
        if to.is_empty() || (way != Way::Serial && !to.contains(':')) {
            bail!("{text}: {expected}");
        }
        if way != Way::Serial && !connection::is_address(to) {
            bail!("{to}: expected HOST:PORT, with a port from 1 to 65535");
        }
        Ok(Address { way, to: to.into(), baud })
    }
}

/// Where packets go: what is open.
pub enum Output {
    /// In order.
    Bytes(Connection),
    /// Datagrams.
    Udp(UdpSocket),
}

impl Address {
    /// Bytes that it carries a second.
    pub fn rate(&self) -> f64 {
        f64::from(self.baud) / BITS
    }

    /// Opens the line.
    pub fn open(&self) -> Result<Output> {
        Ok(match self.way {
            Way::Serial => Output::Bytes(Connection::serial(&self.to, self.baud)?),
            Way::Tcp => Output::Bytes(Connection::tcp(&self.to)?),
            Way::Udp => {
                let any = |to: &str| UdpSocket::bind("0.0.0.0:0").and_then(|socket| socket.connect(to).map(|()| socket));
                Output::Udp(any(&self.to).with_context(|| format!("{}: cannot send there", self.to))?)
            }
        })
    }
}

impl Output {
    /// Sends a packet.
    pub fn send(&mut self, bytes: &[u8]) -> Result<()> {
        let sent = match self {
            Output::Bytes(line) => line.write_all(bytes),
            // Nobody who listens yet is no error: a packet is lost.
            Output::Udp(socket) => socket.send(bytes).map(drop).or_else(|error| match error.kind() {
                ErrorKind::ConnectionRefused => Ok(()),
                _ => Err(error),
            }),
        };
        sent.map_err(|error| match error.kind() {
            ErrorKind::WouldBlock | ErrorKind::TimedOut => {
                anyhow::anyhow!("the other end has taken no bytes for {} s", STUCK.as_secs())
            }
            _ => anyhow::Error::new(error).context("the line is gone"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses() {
        let address = |text: &str| text.parse::<Address>().map(|address| (address.to.clone(), address.rate()));
        assert_eq!(address("serial:/dev/ttyUSB0@9600").unwrap(), ("/dev/ttyUSB0".into(), 960.0));
        assert_eq!(address("udp:board.local:4000").unwrap(), ("board.local:4000".into(), 3840.0));
        for wrong in [
            "",
            "tcp",
            "tcp:",
            "tcp:host",
            "udp:host:1@x",
            "udp:host:1@0",
            "udp:127.0.0.1:99999",
            "tcp:host:0",
            "tcp::1",
            "file:a:b",
            "serial:",
        ] {
            assert!(address(wrong).is_err(), "{wrong}");
        }
    }
}
