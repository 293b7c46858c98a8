//! Stores what the parts measured from run to run, and writes it as the tables of docs/BENCHMARKS.md.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use clap::ValueEnum;
use harness::paths;
use pantin_tools::output::write_whole;

use super::{Goal, Part, goals};

const DOCUMENT: &str = "docs/BENCHMARKS.md";
const START: &str = "<!-- bench -->";
const END: &str = "<!-- /bench -->";

/// Stores a part's numbers of a full run.
pub fn store(folder: &Path, part: Part, goals: &[Goal]) -> Result<()> {
    write_whole(&file(folder, part), &serde_json::to_vec_pretty(goals)?)
}

/// Writes the numbers of all parts into docs/BENCHMARKS.md, between its markers. A part that was never run to its end in `folder` keeps its section there.
pub fn write(folder: &Path) -> Result<()> {
    let document = paths::root().join(DOCUMENT);
    let before = std::fs::read_to_string(&document).context(DOCUMENT)?;
    let mut text = String::new();
    for part in Part::value_variants() {
        let path = file(folder, *part);
        if !path.exists() {
            let kept = section(&before, &part.name());
            text.push_str(kept.with_context(|| format!("no full run of `cargo xtask bench {}` yet", part.name()))?);
            continue;
        }
        let goals: Vec<Goal> = serde_json::from_slice(&std::fs::read(&path)?).with_context(|| path.display().to_string())?;
        ensure!(!goals.is_empty(), "`cargo xtask bench {}` measured nothing: {DOCUMENT} needs every part", part.name());
        text.push_str(&format!("{}\n\n{}\n", title(&part.name()), goals::markdown(&goals)));
    }
    write_whole(&document, replaced(&before, &text)?.as_bytes())
}

fn title(part: &str) -> String {
    format!("## `cargo xtask bench {part}`")
}

/// A part's section, to the next title or the end of the tables.
fn section<'d>(document: &'d str, part: &str) -> Option<&'d str> {
    let tables = document.split_once(START)?.1.split_once(END)?.0;
    let rest = &tables[tables.find(&format!("{}\n", title(part)))?..];
    Some(rest[3..].find("\n## ").map_or(rest, |end| &rest[..end + 4]))
}

fn file(folder: &Path, part: Part) -> PathBuf {
    folder.join(part.name()).with_extension("json")
}

fn replaced(document: &str, table: &str) -> Result<String> {
    let parts = document.split_once(START).and_then(|(head, rest)| Some((head, rest.split_once(END)?.1)));
    let Some((head, tail)) = parts else { bail!("{DOCUMENT} has no {START} ... {END}") };
    Ok(format!("{head}{START}\n{}\n{END}{tail}", table.trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_without_a_run_keeps_its_section() {
        let before = "<!-- bench -->\n## `cargo xtask bench size`\n\na\n\n## `cargo xtask bench host`\n\nb\n<!-- /bench -->\n";
        assert_eq!(section(before, "size"), Some("## `cargo xtask bench size`\n\na\n\n"));
        assert_eq!(section(before, "host"), Some("## `cargo xtask bench host`\n\nb\n"));
        assert_eq!(section(before, "web"), None);
    }

    #[test]
    fn only_what_stands_between_the_markers_changes() {
        let before = "a\n<!-- bench -->\nold\n<!-- /bench -->\nb\n";
        assert_eq!(replaced(before, "new\n\n").unwrap(), "a\n<!-- bench -->\nnew\n<!-- /bench -->\nb\n");
        assert!(replaced("a\n<!-- bench -->\n", "new").is_err());
    }
}
