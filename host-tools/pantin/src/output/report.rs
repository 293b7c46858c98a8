//! What a command reports: lines for people, and with `--json` one object for programs.
//!
//! Fields are collected while the command works and printed once, by [`finish`], on standard output; or on standard error where
//! standard output is the command's own output (`-o -`). A command that fails prints the same object with the field `error`.

use super::terminal;
use crate::words;
use anyhow::{Error, Result};
use serde_json::{Map, Value, json};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{LazyLock, Mutex, PoisonError};

static QUIET: AtomicBool = AtomicBool::new(false);
static VERBOSE: AtomicBool = AtomicBool::new(false);
static JSON: AtomicBool = AtomicBool::new(false);
static STDOUT_TAKEN: AtomicBool = AtomicBool::new(false);
static FIELDS: LazyLock<Mutex<Map<String, Value>>> = LazyLock::new(Mutex::default);

/// Sets what is printed by this process: `-q`, `-v` and `--json`.
pub fn set_reporting(quiet: bool, verbose: bool, json: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
    VERBOSE.store(verbose, Ordering::Relaxed);
    JSON.store(json, Ordering::Relaxed);
}

/// Whether notes, warnings and progress are left out.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Whether details are printed.
pub fn is_verbose() -> bool {
    VERBOSE.load(Ordering::Relaxed)
}

/// Whether a JSON object is printed instead of tables.
pub fn is_json() -> bool {
    JSON.load(Ordering::Relaxed)
}

/// Remembers that standard output carries the command's output.
pub fn take_stdout() {
    STDOUT_TAKEN.store(true, Ordering::Relaxed);
}

/// Adds the fields of the object `value` to the report.
pub fn report(value: Value) {
    if let Value::Object(fields) = value {
        lock().extend(fields);
    }
}

/// Appends `value` to the list `name` of the report, if there will be one.
pub(super) fn list(name: &str, value: Value) {
    if is_json() {
        let mut fields = lock();
        if let Value::Array(values) = fields.entry(name).or_insert_with(|| json!([])) {
            values.push(value);
        }
    }
}

fn lock() -> std::sync::MutexGuard<'static, Map<String, Value>> {
    FIELDS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Prints the report of `command`, if it is asked for.
pub fn finish(command: &str) -> Result<()> {
    if !is_json() {
        return Ok(());
    }
    report(json!({"command": command}));
    let object = Value::Object(std::mem::take(&mut *lock()));
    if STDOUT_TAKEN.load(Ordering::Relaxed) {
        terminal::print_error_json(&object);
        return Ok(());
    }
    terminal::print_json(&object)
}

/// Prints an error for people, and as the field `error` of the report of `command`.
pub fn fail(command: &str, error: &Error) {
    let text = words::explanation(error);
    terminal::print_error(format_args!("{text}"));
    report(json!({ "error": text }));
    // Where it cannot be printed, the exit code alone says so.
    let _ = finish(command);
}
