//! The notes of odd files, which all front ends must report alike: `tests/odd/notes.json` lists their kinds.

use pantin_convert::Level;
use pantin_convert::import::{self, Disk};
use pantin_convert::{Length, Note, Options, Recipe};
use serde_json::{Value, json};
use std::path::PathBuf;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The outcome of a file's conversion, with the options that `tests/odd/README.md` lists.
fn outcome(file: &str, fps: Option<f64>) -> Value {
    let mut recipe = Recipe::new().options(Options::new().max_error(Length::cm(0.5)).effort(Level::FAST));
    (recipe.import.fps, recipe.edits.fps) = (fps, fps);
    let path = root().join("tests/odd").join(file);
    match recipe.convert(&Disk::default(), &path, &mut |_| ()) {
        Ok(converted) => json!({ "notes": converted.notes.iter().map(kind).collect::<Vec<_>>() }),
        Err(error) => {
            let fields = error.fields();
            json!({ "kind": fields["kind"], "setting": fields["setting"], "remedy": fields["remedy"] })
        }
    }
}

fn kind(note: &Note) -> String {
    let fields = note.fields();
    let word = |name: &str| fields[name].as_str().unwrap_or_default().to_owned();
    format!("{} {}", word("severity"), word("kind"))
}

#[test]
fn odd_files_have_the_notes_that_are_listed() {
    let listed = std::fs::read_to_string(root().join("tests/odd/notes.json")).unwrap();
    let listed: Vec<Value> = serde_json::from_str(&listed).unwrap();
    assert!(listed.len() >= 5);
    for entry in &listed {
        let file = entry["file"].as_str().unwrap();
        assert_eq!(outcome(file, entry["fps"].as_f64()), entry["outcome"], "{file}");
    }
}

/// Extensions of files that belong to a motion, and of our own.
const OTHERS: [&str; 4] = ["asf", "bin", "ptb", "ptn"];
/// The page's converter is built without ZIP, for its size.
const NOT_IN_THE_PAGE: [&str; 1] = ["ZIP"];

#[test]
fn the_page_offers_the_files_that_its_converter_reads() {
    let page = std::fs::read_to_string(root().join("web/page/index.html")).unwrap();
    let list = page.split("accept=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
    let mut offered: Vec<&str> = list.split(',').map(|extension| extension.strip_prefix('.').unwrap()).collect();
    let formats = import::FORMATS.iter().filter(|format| !NOT_IN_THE_PAGE.contains(&format.name));
    let mut read: Vec<&str> = formats.flat_map(|format| format.extensions).copied().chain(OTHERS).collect();
    [&mut offered, &mut read].iter_mut().for_each(|list| list.sort_unstable());
    read.dedup();
    assert_eq!(offered, read);
}
