//! The pages: the README stays short, links, paths and headings are there, and sentences keep to plain English.

use xtask::pages::{self, Page};

/// The README's greatest length.
const README_LINES: usize = 130;

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

/// All pages; none, with a message, where git does not say which files are the repository's.
fn all() -> Vec<Page> {
    let Some(pages) = pages::all().unwrap() else {
        eprintln!("SKIPPED: no checkout of git");
        return vec![];
    };
    assert!(pages.len() > 40, "only {} pages", pages.len());
    pages
}

#[test]
fn the_readme_is_short() {
    let lines = std::fs::read_to_string(xtask::paths::root().join("README.md")).unwrap().lines().count();
    assert!(lines <= README_LINES, "README.md has {lines} lines; add a line and a link, not a section");
}

#[test]
fn links_lead_to_files_and_headings() {
    let broken: Vec<String> = all().iter().flat_map(Page::broken_links).collect();
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
}

#[test]
fn named_paths_exist() {
    // The changelog may name what is gone.
    let pages = all().into_iter().filter(|page| page.path != "CHANGELOG.md");
    let missing: Vec<String> = pages.flat_map(|page| page.missing_paths()).collect();
    assert!(missing.is_empty(), "paths that do not exist:\n{}", missing.join("\n"));
}

#[test]
fn sentences_keep_to_plain_english() {
    let mut found = vec![];
    for Page { path, text } in all() {
        for (number, line) in text.to_lowercase().lines().enumerate() {
            found.extend(
                IDIOMS.iter().filter(|idiom| line.contains(*idiom)).map(|idiom| format!("{path}:{}:{idiom}", number + 1)),
            );
        }
    }
    assert!(found.is_empty(), "idioms of our own:\n{}", found.join("\n"));
}
