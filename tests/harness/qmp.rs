//! A minimal client of QEMU's machine protocol (QMP): pictures of the display, keys, the end.

use std::io::{BufRead, BufReader, Error, ErrorKind, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use serde_json::{Value, json};

/// A connection in command mode.
pub struct Qmp {
    stream: BufReader<UnixStream>,
}

impl Qmp {
    /// Greets QEMU on a fresh connection. No answer may take longer than `limit`.
    pub fn new(stream: UnixStream, limit: Duration) -> Result<Self> {
        stream.set_read_timeout(Some(limit))?;
        let mut qmp = Self { stream: BufReader::new(stream) };
        let greeting = qmp.receive()?;
        if greeting.get("QMP").is_none() {
            bail!("QMP greets with {greeting}");
        }
        qmp.execute("qmp_capabilities", json!({}))?;
        Ok(qmp)
    }

    /// Executes a command and returns its result; events in between are skipped.
    pub fn execute(&mut self, command: &str, arguments: Value) -> Result<Value> {
        let request = json!({ "execute": command, "arguments": arguments });
        self.stream.get_mut().write_all(format!("{request}\n").as_bytes()).with_context(|| format!("QMP {command}"))?;
        loop {
            let mut answer = self.receive().with_context(|| format!("QMP {command}"))?;
            if let Some(error) = answer.get("error") {
                bail!("QMP {command}: {}", error["desc"].as_str().unwrap_or("refused without a reason"));
            }
            if let Some(result) = answer.get_mut("return") {
                return Ok(result.take());
            }
        }
    }

    /// Writes the display's current picture to `path`, as a portable pixmap (every QEMU writes this format, not all PNG).
    pub fn screendump(&mut self, path: &Path) -> Result<()> {
        let path = path.to_str().context("QMP names files in UTF-8")?;
        self.execute("screendump", json!({ "filename": path })).map(drop)
    }

    /// Presses or releases a key, named as QEMU names it: `up`, `ctrl`, ...
    pub fn key(&mut self, name: &str, down: bool) -> Result<()> {
        let key = json!({ "type": "qcode", "data": name });
        let event = json!({ "type": "key", "data": { "down": down, "key": key } });
        self.execute("input-send-event", json!({ "events": [event] })).map(drop)
    }

    /// Ends QEMU with code 0.
    pub fn quit(&mut self) -> Result<()> {
        self.execute("quit", json!({})).map(drop)
    }

    fn receive(&mut self) -> Result<Value> {
        let mut line = String::new();
        if self.stream.read_line(&mut line)? == 0 {
            return Err(Error::new(ErrorKind::UnexpectedEof, "QEMU closed the connection").into());
        }
        serde_json::from_str(&line).with_context(|| format!("not JSON: {line:?}"))
    }
}
