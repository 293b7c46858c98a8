//! Words of a text file with the lines they stand on, and errors that name both.

use anyhow::{Error, Result, anyhow};
use std::path::Path;

/// No length or angle of a real motion comes near it; sums of such numbers stay exact enough to mean something.
const LARGEST: f64 = 1e9;

/// Words of a text, in order. `{`, `}` and `:` are words of their own where the caller asks for [`Words::next`];
/// [`Words::next_number`] only splits at white space.
pub struct Words<'a> {
    file: String,
    bytes: &'a [u8],
    at: usize,
    line: usize,
}

impl<'a> Words<'a> {
    /// The words of `bytes`, the content of `path`.
    pub fn new(path: &Path, bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Words { file: path.display().to_string(), bytes, at: 0, line: 1 }
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
        anyhow!("{}:{line}: {message}", self.file)
    }

    /// Whether the last look for a word met the end: behind a word that was found, its line end is left.
    pub fn is_at_end(&self) -> bool {
        self.rest().is_empty()
    }

    /// What is left behind the word read last.
    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Any line end counts one: LF, CR LF, or CR alone.
    fn skip_space(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if !byte.is_ascii_whitespace() {
                return;
            }
            self.at += 1;
            if byte == b'\n' || (byte == b'\r' && self.bytes.get(self.at) != Some(&b'\n')) {
                self.line += 1;
            }
        }
    }

    fn take_until(&mut self, ends: impl Fn(u8) -> bool) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let len = rest.iter().position(|&byte| ends(byte)).unwrap_or(rest.len());
        self.at += len;
        &rest[..len]
    }

    /// The next word; `None` at the end.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let first = *self.bytes.get(self.at)?;
        if is_mark(first) {
            self.at += 1;
            return Some(&self.bytes[self.at - 1..self.at]);
        }
        Some(self.take_until(|byte| byte.is_ascii_whitespace() || is_mark(byte)))
    }

    /// The next word, left where it is.
    pub fn peek(&mut self) -> Option<&'a [u8]> {
        let (at, line) = (self.at, self.line);
        let word = self.next();
        (self.at, self.line) = (at, line);
        word
    }

    /// The next words up to the end of their line or a brace.
    pub fn rest_of_name(&mut self) -> String {
        self.skip_space();
        let name = self.take_until(|byte| matches!(byte, b'\n' | b'\r' | b'{' | b'}'));
        let name = String::from_utf8_lossy(name);
        name.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Whether the next word is `word`, upper or lower case, which is then passed.
    pub fn accept(&mut self, word: &str) -> bool {
        let found = self.peek().is_some_and(|next| next.eq_ignore_ascii_case(word.as_bytes()));
        if found {
            self.next();
        }
        found
    }

    /// Passes `word` or says what stands there; `why` tells where it belongs.
    pub fn expect(&mut self, word: &str, why: &str) -> Result<()> {
        let next = self.next();
        if next.is_some_and(|next| next.eq_ignore_ascii_case(word.as_bytes())) {
            return Ok(());
        }
        Err(self.error(format!("expected `{word}` {why}, found {}", shown(next))))
    }

    /// The next number; `what` says which one is expected.
    pub fn number(&mut self, what: &str) -> Result<f64> {
        match self.next_number()? {
            Some(number) => Ok(number),
            None => Err(self.error(format!("expected {what}, found {}", shown(None)))),
        }
    }

    /// The next number; `None` at the end of the file.
    pub fn next_number(&mut self) -> Result<Option<f64>> {
        let Some(word) = self.next_raw() else { return Ok(None) };
        self.number_from(word).map(Some)
    }

    /// The number that `word`, read last, stands for.
    pub fn number_from(&self, word: &[u8]) -> Result<f64> {
        number_in(word).map_err(|message| self.error(message))
    }

    /// The next word between white space.
    pub fn next_raw(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let word = self.take_until(|byte| byte.is_ascii_whitespace());
        (!word.is_empty()).then_some(word)
    }

    /// The words of the next line that has some, of a format in which a word with `#` begins a comment and commas and parentheses are white
    /// space; `None` at the end.
    pub fn next_line(&mut self) -> Option<Vec<&'a [u8]>> {
        loop {
            self.skip_space();
            if self.at == self.bytes.len() {
                return None;
            }
            let line = self.take_until(|byte| matches!(byte, b'\n' | b'\r'));
            let between = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b',' | b'(' | b')');
            let words = line.split(between).filter(|word| !word.is_empty());
            let words: Vec<&[u8]> = words.take_while(|word| !word.starts_with(b"#")).collect();
            if !words.is_empty() {
                return Some(words);
            }
        }
    }
}

/// The number that `word` is, or what was expected instead.
pub fn number_in(word: &[u8]) -> Result<f64, String> {
    match std::str::from_utf8(word).ok().and_then(|text| text.parse::<f64>().ok()) {
        Some(number) if number.abs() <= LARGEST => Ok(number),
        Some(_) => Err(format!("expected a finite number of at most {LARGEST:e}, found {}", shown(Some(word)))),
        None => Err(format!("expected a number, found {}", shown(Some(word)))),
    }
}

fn is_mark(byte: u8) -> bool {
    matches!(byte, b'{' | b'}' | b':')
}

/// A text as an error quotes it: see [`shown`].
pub fn quoted(text: &str) -> String {
    shown(Some(text.as_bytes()))
}

/// A word as an error quotes it: short, and readable when it is not text.
pub fn shown(word: Option<&[u8]>) -> String {
    const LONGEST: usize = 40;
    let Some(word) = word else { return "the end of the file".into() };
    let text = String::from_utf8_lossy(&word[..word.len().min(LONGEST)]);
    let dots = if word.len() > LONGEST { "..." } else { "" };
    format!("`{}{dots}`", text.escape_debug())
}
