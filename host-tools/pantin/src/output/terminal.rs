//! Lines for people and programs that start this one: standard output and standard error.
//!
//! Names come from files of strangers. So every line goes through [`clean`]: a control character would move the cursor, change
//! colours or write into the terminal's input. A closed or full standard output is an error, which `main` turns into an exit code; a
//! closed or full standard error is none, because nobody is left to read it.

use super::progress::without_bar;
use super::report;
use anyhow::{Context, Result};
use std::borrow::Cow;
use std::fmt::Arguments;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Prints a line to standard output; returns an error where it is closed or full.
macro_rules! outln {
    ($($part:tt)*) => { $crate::output::print_line(format_args!($($part)*)) };
}
/// Prints a note or a warning to standard error, unless `-q` leaves it out.
macro_rules! note {
    ($($part:tt)*) => { $crate::output::print_note(format_args!($($part)*)) };
}
/// Prints a detail to standard error under `-v`.
macro_rules! detail {
    ($($part:tt)*) => { $crate::output::print_detail(format_args!($($part)*)) };
}
pub(crate) use {detail, note, outln};

/// Whether a reader of the output went away.
static READER_GONE: AtomicBool = AtomicBool::new(false);

/// Most characters of a word that are printed. Paths and names have fewer.
const LONGEST_WORD: usize = 1000;

fn is_long(word: &str) -> bool {
    word.chars().nth(LONGEST_WORD).is_some()
}

/// A word with at most [`LONGEST_WORD`] characters, of which the last one is an ellipsis if some are left out.
fn short(word: &str) -> Cow<'_, str> {
    match is_long(word) {
        true => Cow::Owned(word.chars().take(LONGEST_WORD - 1).chain(['…']).collect()),
        false => Cow::Borrowed(word),
    }
}

/// Whether what was written has no reader any more, as after `| head -1`: then there is nothing to report.
pub fn reader_gone() -> bool {
    READER_GONE.load(Ordering::Relaxed)
}

/// Remembers an error that says so.
pub(crate) fn noticed<T>(result: io::Result<T>) -> io::Result<T> {
    if result.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::BrokenPipe) {
        READER_GONE.store(true, Ordering::Relaxed);
    }
    result
}

/// Whether a terminal takes `c` for a command, or it changes the direction of what follows.
pub fn is_hostile(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// `text` with such characters as escapes, and the end of a word of more than 1,000 characters as an ellipsis, so that it stays
/// on its line and readable.
pub fn clean(text: &str) -> Cow<'_, str> {
    if text.len() > LONGEST_WORD && text.split(' ').any(is_long) {
        let words: Vec<_> = text.split(' ').map(short).collect();
        return Cow::Owned(clean(&words.join(" ")).into_owned());
    }
    if !text.chars().any(is_hostile) {
        return Cow::Borrowed(text);
    }
    let escaped = |c: char| if is_hostile(c) { c.escape_default().to_string() } else { c.to_string() };
    Cow::Owned(text.chars().map(escaped).collect())
}

/// Writes a clean line to standard output.
pub fn print_line(line: Arguments<'_>) -> Result<()> {
    let line = line.to_string();
    print(&clean(&line))
}

/// Writes a JSON value as a line. Escapes keep its strings what they were.
pub(super) fn print_json(value: &serde_json::Value) -> Result<()> {
    print(&json_line(value))
}

/// The same on standard error.
pub(super) fn print_error_json(value: &serde_json::Value) {
    let _ = writeln!(io::stderr(), "{}", json_line(value));
}

fn json_line(value: &serde_json::Value) -> String {
    let mut text = String::new();
    for c in value.to_string().chars() {
        if is_hostile(c) {
            c.encode_utf16(&mut [0; 2]).iter().for_each(|unit| text += &format!("\\u{unit:04x}"));
        } else {
            text.push(c);
        }
    }
    text
}

fn print(line: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    noticed(writeln!(out, "{line}").and_then(|()| out.flush())).context("standard output")
}

/// Writes a note: a clean line on standard error, unless `-q` leaves it out. It is part of the report.
pub fn print_note(line: Arguments<'_>) {
    if !report::is_quiet() {
        report::list("notes", line.to_string().into());
        print_to_stderr(&line.to_string());
    }
}

/// Writes a detail to standard error, under `-v`.
pub fn print_detail(line: Arguments<'_>) {
    if report::is_verbose() {
        print_to_stderr(&line.to_string());
    }
}

/// Writes an error to standard error. All errors of all commands begin alike.
pub fn print_error(line: Arguments<'_>) {
    print_to_stderr(&format!("error: {line}"));
}

/// The same for a text of several lines.
pub fn print_error_text(text: &str) {
    for (number, line) in text.lines().enumerate() {
        if number == 0 { print_error(format_args!("{line}")) } else { print_to_stderr(line) }
    }
}

fn print_to_stderr(line: &str) {
    // Where it cannot be written, there is no place to say so.
    without_bar(|| drop(writeln!(io::stderr(), "{}", clean(line))));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_would_obey_is_escaped() {
        assert_eq!(clean("Hüfte 左"), "Hüfte 左");
        let long = format!("a {}: b", "é".repeat(100_000));
        assert_eq!(clean(&long), format!("a {}… b", "é".repeat(LONGEST_WORD - 1)));
        assert_eq!(clean("a\x1b[31m\r\n\u{202e}b\u{9b}"), "a\\u{1b}[31m\\r\\n\\u{202e}b\\u{9b}");
    }
}
