//! Bounded reads: a pipe or a device may never end, so nothing is read without a limit.

use crate::error::Error;
use crate::memory::{Memory, size};
use anyhow::{Result, anyhow, ensure};
use std::fs::{self, File};
use std::io::{self, BufRead, Read};
use std::path::Path;

/// The name of standard input.
const STDIN: &str = "-";
/// Most bytes of a line that is read while its writer still writes.
const MOST_LINE_BYTES: u64 = 1 << 16;

/// Returns the content of a file that has at most `most` bytes, as text. Errors do not name the path, which may be a secret.
pub fn read_short_text(path: &Path, most: u64) -> Result<String> {
    let bytes = up_to(File::open(path)?, most)?;
    Ok(String::from_utf8(bytes.ok_or_else(|| anyhow!("more than {most} bytes"))?)?)
}

/// The whole content of `path`; `-` is standard input. Fails for a file that has more bytes than the limit, and for a pipe
/// or a device that gives more than a quarter of it: its length is unknown beforehand, so its bytes are copied as they grow.
/// Errors do not name the path.
pub(crate) fn content(path: &Path, limit: Memory) -> io::Result<Vec<u8>> {
    if is_stdin(path) {
        return stream(io::stdin().lock(), limit);
    }
    let found = fs::metadata(path)?;
    let file = File::open(path)?;
    if !found.is_file() {
        return stream(file, limit);
    }
    let most = limit.bytes();
    let refusal = |bytes| Error::memory(format!("it has {} or more; the limit is {}", size(bytes), size(most)));
    if found.len() > most {
        return Err(io::Error::other(refusal(found.len())));
    }
    // It may grow meanwhile.
    up_to(file, most)?.ok_or_else(|| io::Error::other(refusal(most)))
}

/// Whether `path` names standard input.
pub fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == STDIN
}

fn stream(source: impl Read, limit: Memory) -> io::Result<Vec<u8>> {
    let most = limit.bytes() / 4;
    let refusal = || {
        io::Error::other(Error::memory(format!("more than {} come from this pipe or device, a quarter of the limit", size(most))))
    };
    up_to(source, most)?.ok_or_else(refusal)
}

/// All bytes of `source`; `None` if they are more than `most`.
fn up_to(source: impl Read, most: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    source.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

/// Reads the next line, without its end; `None` at the end of `source`. Fails for a line of more than 65,536 bytes, which may have no end.
pub fn line(source: &mut impl BufRead) -> Result<Option<String>> {
    let mut line = Vec::new();
    source.take(MOST_LINE_BYTES + 1).read_until(b'\n', &mut line)?;
    if line.is_empty() {
        return Ok(None);
    }
    ensure!(line.len() as u64 <= MOST_LINE_BYTES, "a line of more than {MOST_LINE_BYTES} bytes");
    let text = String::from_utf8(line)?;
    Ok(Some(text.trim_end_matches(['\n', '\r']).to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_have_a_limit() {
        let mut source = &b"a\r\n\nb"[..];
        let lines = std::iter::from_fn(|| line(&mut source).unwrap()).collect::<Vec<_>>();
        assert_eq!(lines, ["a", "", "b"]);
        let longest = vec![b'a'; MOST_LINE_BYTES as usize];
        assert!(line(&mut &longest[..]).unwrap().is_some());
        assert!(
            line(&mut io::BufReader::new(io::repeat(b'a').take(1 << 20)))
                .is_err_and(|error| error.to_string().contains("more than 65536"))
        );
    }
}
