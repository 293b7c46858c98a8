//! A server that sends a file as slowly as a test wants it.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::thread;
use std::time::Duration;

use anyhow::Result;

/// Serves `bytes` at any path, in pieces of `piece` each `pause`, and hangs up after `sent` of them; returns its address. Pages from elsewhere may
/// read it.
pub fn serve(bytes: Vec<u8>, sent: usize, piece: usize, pause: Duration) -> Result<String> {
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let place = listener.local_addr()?;
    thread::spawn(move || {
        for mut stream in listener.incoming().flatten() {
            let bytes = bytes.clone();
            thread::spawn(move || {
                let head = format!(
                    "HTTP/1.1 200 OK\r\nContent-Length: {}\r\nAccess-Control-Allow-Origin: *\r\nConnection: close\r\n\r\n",
                    bytes.len()
                );
                let asked = BufReader::new(&stream).lines().map_while(Result::ok).any(|line| line.is_empty());
                // A browser that goes away has seen enough.
                let mut listens = stream.write_all(head.as_bytes()).is_ok() && asked;
                for piece in bytes[..sent].chunks(piece) {
                    listens = listens && stream.write_all(piece).is_ok();
                    thread::sleep(pause);
                }
            });
        }
    });
    Ok(format!("http://{place}/slow.ptn"))
}
