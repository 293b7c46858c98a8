//! docs/CLI.md is what the commands' `--help` prints, and the run lines of all documents use commands and options that exist.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

const BEGIN: &str = "<!-- help begins: written by host-tools/pantin/tests/suites/cli_reference.rs -->\n";
const END: &str = "<!-- help ends -->";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn help(words: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pantin")).args(words).arg("--help").env("COLUMNS", "120").output().unwrap();
    assert!(output.status.success(), "pantin {} --help", words.join(" "));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}

/// The subcommands that a help text lists.
fn commands(help: &str) -> Vec<String> {
    let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = lines.filter(|line| !line.starts_with("   ")).filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// The help text of every command, by its words: `convert`, `face sheet`.
fn manual() -> BTreeMap<String, String> {
    let mut manual = BTreeMap::new();
    for command in commands(&help(&[])) {
        let text = help(&[&command]);
        for below in commands(&text) {
            manual.insert(format!("{command} {below}"), help(&[&command, &below]));
        }
        manual.insert(command, text);
    }
    manual
}

#[test]
fn the_reference_is_what_help_prints() {
    let mut reference = String::new();
    for (command, text) in manual() {
        reference.push_str(&format!("\n## `pantin {command}`\n\n```text\n{text}\n```\n"));
    }
    reference.push('\n');
    let path = root().join("docs/CLI.md");
    let document = std::fs::read_to_string(&path).unwrap();
    let begin = document.find(BEGIN).expect("docs/CLI.md has lost the line before its generated part") + BEGIN.len();
    let end = document.find(END).expect("docs/CLI.md has lost the line after its generated part");
    if std::env::var_os("PANTIN_UPDATE").is_some() {
        std::fs::write(&path, [&document[..begin], &reference, &document[end..]].concat()).unwrap();
        return;
    }
    assert!(
        document[begin..end] == reference,
        "docs/CLI.md is out of date: write it with `PANTIN_UPDATE=1 cargo test -p pantin-tools cli_reference`"
    );
}

#[test]
fn run_lines_in_documents_use_commands_and_options_that_exist() {
    let manual = manual();
    let mut wrong = vec![];
    for (path, text) in super::documents::all() {
        for line in text.lines() {
            let Some((_, words)) = line.split_once("cargo pantin ") else { continue };
            let words = words.split(['#', '`', '|', '>', '&']).next().unwrap_or_default();
            let mut words = words.split_whitespace();
            let Some(first) = words.next().filter(|word| word.starts_with(char::is_lowercase)) else { continue };
            let words: Vec<_> = words.collect();
            let two = words.first().map(|second| format!("{first} {second}"));
            let Some(help) = two.and_then(|two| manual.get(&two)).or_else(|| manual.get(first)) else {
                wrong.push(format!("{path}: no command {first}: {line}"));
                continue;
            };
            for option in words.iter().filter(|word| word.starts_with("--")) {
                let known = help.split([' ', '\n', ',', '=']).any(|word| word == *option);
                if !known {
                    wrong.push(format!("{path}: {first} has no option {option}: {line}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
