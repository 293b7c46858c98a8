//! Words of a VRML world: white space and commas part them, `#` begins a comment, brackets and braces are words of their own.

use crate::import::one_line;
use anyhow::{Error, anyhow};
use std::path::Path;

/// A word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Word<'a> {
    /// `{`, `}`, `[` or `]`.
    Mark(u8),
    /// Between quotation marks, as it stands there.
    Text(&'a [u8]),
    /// Anything else: a name or a number.
    Plain(&'a [u8]),
}

/// The words, in order.
#[derive(Clone)]
pub struct Words<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Words<'a> {
    /// The words of `bytes`, the content of `file`.
    pub fn new(file: &'a Path, bytes: &'a [u8]) -> Words<'a> {
        Words { file, bytes: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), at: 0, line: 1 }
    }

    /// Line of the word read last, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// `file:line: message`.
    pub fn error(&self, message: impl std::fmt::Display) -> Error {
        self.error_at(self.line, message)
    }

    /// The same for a line read before.
    pub fn error_at(&self, line: usize, message: impl std::fmt::Display) -> Error {
        anyhow!("{}:{line}: {message}", self.file.display())
    }

    fn skip(&mut self) {
        let mut comment = false;
        while let Some(&byte) = self.bytes.get(self.at) {
            let end = matches!(byte, b'\n' | b'\r');
            comment = (comment || byte == b'#') && !end;
            if !comment && !byte.is_ascii_whitespace() && byte != b',' {
                return;
            }
            self.at += 1;
            self.line += usize::from(byte == b'\n' || (byte == b'\r' && self.bytes.get(self.at) != Some(&b'\n')));
        }
    }

    /// The next word; `None` at the end.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> Option<Word<'a>> {
        self.skip();
        let first = *self.bytes.get(self.at)?;
        let from = self.at;
        if is_mark(first) {
            self.at += 1;
            return Some(Word::Mark(first));
        }
        if first == b'"' {
            return Some(self.text());
        }
        let ends = |byte: &u8| byte.is_ascii_whitespace() || is_mark(*byte) || matches!(byte, b',' | b'#' | b'"');
        let rest = &self.bytes[from..];
        self.at += rest.iter().position(ends).unwrap_or(rest.len());
        Some(Word::Plain(&self.bytes[from..self.at]))
    }

    /// From one quotation mark to the next that no backslash precedes, or to the end.
    fn text(&mut self) -> Word<'a> {
        let from = self.at + 1;
        self.at = from;
        while let Some(&byte) = self.bytes.get(self.at).filter(|byte| **byte != b'"') {
            self.line += usize::from(byte == b'\n');
            self.at += if byte == b'\\' { 2 } else { 1 };
        }
        let to = self.at.min(self.bytes.len());
        self.at = (self.at + 1).min(self.bytes.len());
        Word::Text(&self.bytes[from.min(to)..to])
    }

    /// The next word, left where it is.
    pub fn peek(&self) -> Option<Word<'a>> {
        self.clone().next()
    }
}

fn is_mark(byte: u8) -> bool {
    matches!(byte, b'{' | b'}' | b'[' | b']')
}

/// A word as a message quotes it.
pub fn shown(word: Option<Word>) -> String {
    let quoted = |bytes: &[u8]| format!("`{}`", one_line(&String::from_utf8_lossy(&bytes[..bytes.len().min(40)])));
    match word {
        None => "the end of the file".into(),
        Some(Word::Mark(mark)) => quoted(&[mark]),
        Some(Word::Text(bytes) | Word::Plain(bytes)) => quoted(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_come_apart() {
        let mut words = Words::new(Path::new("w"), b"a,b#c]\r\n[1 \"x \\\" #\"2]");
        let mut all = Vec::new();
        while let Some(word) = words.next() {
            all.push(word);
        }
        let plain = |text: &'static str| Word::Plain(text.as_bytes());
        let text = Word::Text(b"x \\\" #");
        assert_eq!(all, [plain("a"), plain("b"), Word::Mark(b'['), plain("1"), text, plain("2"), Word::Mark(b']')]);
        assert_eq!(words.line(), 2);
        assert_eq!(Words::new(Path::new("w"), b"\"\\").next(), Some(Word::Text(b"\\")));
    }
}
