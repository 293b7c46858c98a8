//! Where a board is.

use crate::connection::{Connection, is_address};
use anyhow::Result;
use std::fmt;
use std::str::FromStr;

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
            Some(address) if address.contains(':') && !is_address(address) => {
                Err(format!("{address}: expected HOST:PORT, with a port from 1 to 65535"))
            }
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

impl Place {
    /// Connects to it.
    pub fn open(&self) -> Result<Connection> {
        match self {
            Place::Serial { port, baud } => Connection::serial(port, *baud),
            Place::Tcp(address) => Connection::tcp(address),
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
            ["", "serial:", "serial:@9600", "serial:a@b", "serial:a@0", "tcp:localhost", "tcp:localhost:99999", "/dev/ttyACM0"]
                .iter()
                .all(|text| text.parse::<Place>().is_err())
        );
    }
}
