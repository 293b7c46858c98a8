//! A list of motions, each with a cut of its own: `pantin convert moves.list -o moves.ptb`.
//!
//! ```text
//! # motion, and what is to be done with it
//! walk.bvh  --from 65 --to 129 --loop --max-error 1.5cm
//! bow.bvh
//! "my kick.bvh"  --name kick --from 1.0s --to 4.3s
//! ```

use super::channel_bound::{ChannelBound, degrees};
use super::edits::Edits;
use anyhow::{Context, Result, anyhow, ensure};
use clap::Parser;
use pantin_convert::{Length, input};
use std::path::{Path, PathBuf};

/// Most bytes of a list.
const MOST_BYTES: u64 = 1 << 20;

/// A line of a list.
#[derive(Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub struct ListEntry {
    /// The motion.
    pub motion: PathBuf,
    /// The clip's name in the bank.
    #[arg(long)]
    pub name: Option<String>,
    /// Which animation of a file that holds several.
    #[arg(long)]
    pub animation: Option<String>,
    /// Frames a second of its clip.
    #[arg(long)]
    pub fps: Option<f64>,
    /// Length of its unit in cm.
    #[arg(long)]
    pub cm_per_unit: Option<f64>,
    /// The .asf of an .amc.
    #[arg(long)]
    pub skeleton: Option<PathBuf>,
    /// What is done with it.
    #[command(flatten)]
    pub edits: Edits,
    /// Its bounds, before those of the command.
    #[arg(long, value_parser = str::parse::<Length>)]
    pub max_error: Option<Length>,
    #[arg(long, value_parser = str::parse::<Length>)]
    pub mean_error: Option<Length>,
    #[arg(long, value_parser = degrees)]
    pub max_rotation_error: Option<f64>,
    /// Refused with its reason.
    #[command(flatten)]
    channels: ChannelBound,
}

/// Whether an input is a list, by its name.
pub fn is_list(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("list"))
}

/// The lines of a list, each with its place for messages. Motions, and files that options name, lie in the list's folder, or where their paths lead
/// from there.
pub fn read(path: &Path) -> Result<Vec<(String, ListEntry)>> {
    let text = input::read_short_text(path, MOST_BYTES).with_context(|| path.display().to_string())?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut lines = Vec::new();
    for (number, text) in (1..).zip(text.lines()) {
        let place = format!("{}:{number}", path.display());
        let words = words(text).with_context(|| place.clone())?;
        if words.is_empty() {
            continue;
        }
        let mut line = ListEntry::try_parse_from(words).map_err(|error| {
            let said = error.to_string();
            let first = said.lines().next().unwrap_or_default();
            anyhow!("{place}: {}", first.trim_start_matches("error: "))
        })?;
        ensure!(
            !line.channels.is_given(),
            "{place}: bounds of channels are for all motions: they belong to the command, not to a line"
        );
        line.motion = folder.join(&line.motion);
        line.edits.read_from(folder);
        line.skeleton = line.skeleton.map(|path| folder.join(path));
        lines.push((place, line));
    }
    ensure!(!lines.is_empty(), "{}: the list names no motion", path.display());
    Ok(lines)
}

/// The words of a line: between spaces, or within double or single quotes; a # begins a comment.
fn words(line: &str) -> Result<Vec<String>> {
    let (mut words, mut word, mut quoted) = (Vec::new(), None::<String>, None);
    for letter in line.chars() {
        match (letter, quoted) {
            ('"' | '\'', None) => {
                quoted = Some(letter);
                word.get_or_insert_default();
            }
            (_, Some(mark)) if letter == mark => quoted = None,
            ('#', None) if word.is_none() => break,
            (_, None) if letter.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    ensure!(quoted.is_none(), "a quotation mark without its end");
    words.extend(word);
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stand_between_spaces_or_in_quotes() {
        assert_eq!(words(r#"  a.bvh --name "my walk" # and more"#).unwrap(), ["a.bvh", "--name", "my walk"]);
        assert_eq!(words("# nothing").unwrap(), Vec::<String>::new());
        assert_eq!(words(r#"a#b "" c"#).unwrap(), ["a#b", "", "c"]);
        assert_eq!(words("a --drop '*.scale.*' \"Bob's\" '\"'").unwrap(), ["a", "--drop", "*.scale.*", "Bob's", "\""]);
        assert!(words(r#"a "b"#).is_err());
        assert!(words("a 'b\"").is_err());
    }
}
