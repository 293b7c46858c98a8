//! The pages: every Markdown file, and the links, paths and commands in it.

use std::path::Path;

use anyhow::{Context, Result};

use crate::{paths, repository_files};

/// Folders of the root whose files pages name by path.
const FOLDERS: [&str; 13] = [
    ".ci/",
    ".github/",
    "bindings/",
    "decoder/",
    "docs/",
    "examples/",
    "firmware/",
    "fuzz/",
    "host-tools/",
    "motions/",
    "tests/",
    "web/",
    "xtask/",
];

/// A Markdown file.
#[derive(Debug)]
pub struct Page {
    /// Its path from the root.
    pub path: String,
    /// What stands in it.
    pub text: String,
}

/// All pages of the repository but those of fuzzing's seeds; `None` where this is no checkout of git.
pub fn all() -> Result<Option<Vec<Page>>> {
    let Some(files) = repository_files::files()? else { return Ok(None) };
    let pages = files.into_iter().filter(|path| path.ends_with(".md") && !path.starts_with("fuzz/"));
    let read = |path: String| {
        let text = std::fs::read_to_string(paths::root().join(&path)).with_context(|| path.clone())?;
        Ok(Page { path, text })
    };
    pages.map(read).collect::<Result<_>>().map(Some)
}

impl Page {
    /// The text without its blocks of code.
    pub fn prose(&self) -> String {
        self.text.split("\n```").step_by(2).collect::<Vec<_>>().join("\n")
    }

    /// Links to files, folders and headings of the repository that are not there.
    pub fn broken_links(&self) -> Vec<String> {
        let here = paths::root().join(&self.path);
        let prose = self.prose();
        let links = prose.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let own = links.filter(|link| !link.contains("://") && !link.starts_with("mailto:"));
        let broken = own.filter(|link| {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { here.clone() } else { here.parent().unwrap_or(&here).join(file) };
            !target.exists() || (!heading.is_empty() && !has_heading(&target, heading))
        });
        broken.map(|link| format!("{}: {link}", self.path)).collect()
    }

    /// Paths in backticks, from the root or from the page, that are not there. `{a,b}` stands for both; names with `*` or `NAME` are patterns.
    pub fn missing_paths(&self) -> Vec<String> {
        let prose = self.prose();
        let quoted = prose.split('`').skip(1).step_by(2).flat_map(str::split_whitespace);
        let named = quoted.filter(|name| FOLDERS.iter().any(|folder| name.starts_with(folder)));
        let exact = named.filter(|name| !name.contains(['*', '$', '<', '…']) && !name.contains("NAME"));
        let from = [paths::root(), paths::root().join(&self.path).with_file_name("")];
        let missing = exact.flat_map(alternatives).filter(|name| !from.iter().any(|folder| folder.join(name).exists()));
        missing.map(|name| format!("{}: {name}", self.path)).collect()
    }

    /// The words after `cargo xtask` wherever the page has them.
    pub fn commands(&self) -> impl Iterator<Item = &str> {
        let rests = self.text.split("cargo xtask ").skip(1);
        let words =
            rests.filter_map(|rest| rest.split(|c: char| !(c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')).next());
        words.filter(|word| !word.is_empty() && !word.starts_with('-'))
    }
}

fn has_heading(page: &Path, heading: &str) -> bool {
    let text = std::fs::read_to_string(page).unwrap_or_default();
    text.lines().any(|line| line.starts_with('#') && anchor(line) == heading)
}

/// The anchor that a heading gets on code hosting sites.
fn anchor(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    text.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The names that `a/{b,c}/d` stands for.
fn alternatives(name: &str) -> Vec<String> {
    let braces = name.split_once('{').and_then(|(before, rest)| Some((before, rest.split_once('}')?)));
    let Some((before, (inside, after))) = braces else { return vec![name.trim_end_matches([',', ';', ')']).into()] };
    inside.split(',').map(|one| format!("{before}{one}{after}")).collect()
}
