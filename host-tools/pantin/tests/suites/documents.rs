//! The documents: the README stays short, links and paths lead to files, and sentences keep to plain English.

use std::path::{Path, PathBuf};

/// The README's greatest length.
const README_LINES: usize = 130;

/// Folders whose files the documents name by path.
const FOLDERS: [&str; 11] =
    [".ci/", "decoder/", "docs/", "firmware/", "fuzz/", "host-tools/", "motions/", "tests/", "web/", "xtask/", "target/"];

/// Idioms that a reader from outside does not understand at once.
const IDIOMS: [&str; 16] = [
    " anew",
    "is told",
    "are told",
    "of late",
    "so many",
    "the dearest",
    "by every route",
    "goes round",
    "come to harm",
    "came to harm",
    "capital letters or not",
    "made as if",
    "a way forward",
    "riddle",
    "that came of it",
    "where it is less",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every document of the repository: its path from the root, and its text.
pub fn all() -> Vec<(String, String)> {
    let mut documents = vec![];
    collect(&root(), String::new(), &mut documents);
    assert!(documents.len() > 15, "only {} documents", documents.len());
    documents
}

fn collect(folder: &Path, below: String, documents: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().into_string().unwrap();
        let path = format!("{below}{name}");
        if entry.file_type().unwrap().is_dir() {
            if !name.starts_with('.') && !["target", "node_modules", "corpus"].contains(&name.as_str()) {
                collect(&entry.path(), format!("{path}/"), documents);
            }
        } else if name.ends_with(".md") {
            documents.push((path, std::fs::read_to_string(entry.path()).unwrap()));
        }
    }
}

/// A document's text without its blocks of code.
fn prose(text: &str) -> String {
    text.split("\n```").step_by(2).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_readme_is_short() {
    let lines = std::fs::read_to_string(root().join("README.md")).unwrap().lines().count();
    assert!(lines <= README_LINES, "README.md has {lines} lines; add a line and a link, not a section");
}

#[test]
fn links_lead_to_files_and_headings() {
    let mut broken = vec![];
    for (path, text) in all() {
        let folder = root().join(&path).parent().unwrap().to_path_buf();
        for link in prose(&text).split("](").skip(1).filter_map(|rest| rest.split(')').next().map(str::to_owned)) {
            if link.contains("://") {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { root().join(&path) } else { folder.join(file) };
            if !target.exists() {
                broken.push(format!("{path}: {link}"));
            } else if !heading.is_empty() {
                let text = std::fs::read_to_string(&target).unwrap();
                if !text.lines().any(|line| line.starts_with('#') && anchor(line) == heading) {
                    broken.push(format!("{path}: {link}: no such heading"));
                }
            }
        }
    }
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}

/// The anchor that a heading gets on code hosting sites.
fn anchor(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    text.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn named_paths_exist() {
    let mut missing = vec![];
    for (path, text) in all().into_iter().filter(|(path, _)| path != "CHANGELOG.md") {
        for name in prose(&text).split('`').skip(1).step_by(2) {
            let is_path = FOLDERS.iter().any(|folder| name.starts_with(folder)) && !name.contains([' ', '*', '{', '$', '<']);
            let built = name.starts_with("target/") || name.contains("NAME");
            if is_path && !built && !root().join(name).exists() {
                missing.push(format!("{path}: {name}"));
            }
        }
    }
    assert!(missing.is_empty(), "paths that do not exist:\n{}", missing.join("\n"));
}

#[test]
fn sentences_keep_to_plain_english() {
    let mut found = vec![];
    for (path, text) in all() {
        let text = text.to_lowercase();
        for (number, line) in text.lines().enumerate() {
            found.extend(
                IDIOMS.iter().filter(|idiom| line.contains(*idiom)).map(|idiom| format!("{path}:{}:{idiom}", number + 1)),
            );
        }
    }
    assert!(found.is_empty(), "idioms of our own:\n{}", found.join("\n"));
}
