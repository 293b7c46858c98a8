//! `pantin face speak`

use crate::memory;
use crate::output::{Wanted, check, note, refuse_foreign, write_whole};
use anyhow::{Context, Result, ensure};
use pantin_pictures::face::speak;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Write a face that speaks a text, or a recording, as key-frame text.
///
/// Phonemes are those of espeak-ng where it is installed, and follow rules of English spelling otherwise. The lips close at every p, b and m, and the jaw opens on
/// every open vowel. Of a recording, vowels, s and closed lips are found from the sound, as boards find them while it is played.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  pantin face speak \"Hello, my name is Pantin.\" -o hello.keys
  pantin face speak --wav voice.wav -o voice.keys
  pantin convert hello.keys -o hello.ptn")]
pub struct Arguments {
    /// What is said
    #[arg(required_unless_present = "wav", conflicts_with = "wav")]
    text: Option<String>,
    /// A recording that the mouth follows: PCM of 16 bits, 8,000 Hz or more
    #[arg(long, value_name = "FILE")]
    wav: Option<PathBuf>,
    /// The file to write (.keys)
    #[arg(short, long)]
    output: PathBuf,
    /// Use the rules of spelling even where espeak-ng is installed
    #[arg(long, conflicts_with = "wav")]
    rules: bool,
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> Result<()> {
    refuse_foreign(&arguments.output, Wanted::Keys)?;
    let inputs: Vec<&Path> = arguments.wav.iter().map(PathBuf::as_path).collect();
    check(&inputs, &[&arguments.output])?;
    let text = arguments.text.as_deref().unwrap_or_default();
    let track = match &arguments.wav {
        Some(path) => {
            let place = || path.display().to_string();
            speak::of_wav(&memory::read(path)?, &format!("The mouth of {}.", place())).with_context(place)?
        }
        None => {
            let phonemes = if arguments.rules { None } else { phonemes(text)? };
            let spoken = match &phonemes {
                Some(lines) => speak::of_phonemes(lines)?,
                None => speak::of_text(text)?,
            };
            let unspoken = speak::unspoken(text);
            if phonemes.is_none() && !unspoken.is_empty() {
                note!("warning: left out, as the rules of spelling are for the letters a to z: {unspoken}");
            }
            note!(
                "{} visemes, {}",
                spoken.len(),
                if phonemes.is_some() { "phonemes of espeak-ng" } else { "by rules of spelling" }
            );
            speak::keys(&spoken, text)
        }
    };
    write_whole(&arguments.output, track.as_bytes())
}

/// What espeak-ng says of a text, or `None` where it is not installed.
fn phonemes(text: &str) -> Result<Option<String>> {
    let Ok(out) = Command::new("espeak-ng").args(["-q", "-x", "--", text]).output() else { return Ok(None) };
    ensure!(out.status.success(), "espeak-ng fails: {}", String::from_utf8_lossy(&out.stderr).trim());
    Ok(Some(String::from_utf8_lossy(&out.stdout).into_owned()))
}
