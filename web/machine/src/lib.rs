//! Compiles the text of a state machine in a worker of a web page, by the functions that `pantin machine` calls.
//!
//! The page gives two files by the protocol of `pantin-web-worker`, a bank and the text. Then:
//!
//! ```text
//! compile_text()  -> 1 if there is a machine
//! ```
//! Results: 0 the report as JSON, 1 the bank with the machine, 2 the picture of its states as SVG. An instance compiles any number of texts.
// The page calls this function.
#![allow(unsafe_code)]

use anyhow::{Context, Error, Result};
use pantin::Bank;
use pantin_pictures::machine::{Compiled, Location, Source, Text, Warning, compile, graph, inputs};
use pantin_web_worker as worker;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Compiles the text that the page gave. Returns 1 if there is a machine, 0 if there is none. The report of a machine has `states`, `transitions`, `table_bytes`, `bytes`, `warnings`,
/// `inputs` (those that do something, for each state) and `held` (the inputs that are to be held). The report of an error and a warning have `line`, `column`, `text` and `remedy`.
// SAFETY: nothing else is named so.
#[unsafe(no_mangle)]
extern "C" fn compile_text() -> u32 {
    worker::report_panics();
    let made = made(worker::files());
    let good = made.is_ok();
    worker::set_outputs(made.unwrap_or_else(|error| vec![failed(&error).to_string().into_bytes()]));
    good.into()
}

/// The results for a bank and a text.
fn made(files: Vec<(String, Vec<u8>)>) -> Result<Vec<Vec<u8>>> {
    let [(_, bytes), (name, text)] = &files[..] else { anyhow::bail!("expected a bank and a text") };
    let file = Text::new(name, text)?;
    let source = Source::parse(&file)?;
    let bank = Bank::new_checked(bytes).context("the bank")?;
    let Compiled { bank: whole, warnings, clips, states, transitions, table_bytes } = compile(&source, &file, bytes)?;
    let report = json!({
        "states": states,
        "transitions": transitions,
        "clips": clips,
        "table_bytes": table_bytes,
        "bytes": whole.len(),
        "warnings": warnings.iter().map(warned).collect::<Vec<_>>(),
        "inputs": inputs::of_states(&source).into_iter().collect::<BTreeMap<_, _>>(),
        "held": inputs::held(&source, &bank),
    });
    Ok(vec![report.to_string().into_bytes(), whole, graph::svg(&source).into_bytes()])
}

fn warned(warning: &Warning) -> Value {
    told(warning.location.as_ref(), &warning.text, warning.remedy.map(|remedy| remedy.text()))
}

/// The report of an error: the text is the error's without its location.
fn failed(error: &Error) -> Value {
    let location = error.downcast_ref::<Location>();
    let typed = pantin_convert::Error::of(error, pantin_convert::Error::source);
    let text = format!("{error:#}");
    let prefix = location.map(|location| format!("{location}: ")).unwrap_or_default();
    told(location, text.strip_prefix(&prefix).unwrap_or(&text), typed.problem().remedy.map(|remedy| remedy.text()))
}

fn told(location: Option<&Location>, text: &str, remedy: Option<&str>) -> Value {
    let (line, column) = location.and_then(|location| location.at).unzip();
    json!({ "line": line, "column": column, "text": text, "remedy": remedy })
}
