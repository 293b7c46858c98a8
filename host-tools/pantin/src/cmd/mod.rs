//! One file a command; its arguments' doc comment is the manual.

mod against;
pub mod bank;
mod batch;
mod channel_bound;
pub mod convert;
mod convert_bank;
mod convert_list;
mod convert_stream;
mod edits;
mod encoder;
pub mod expand;
pub mod face;
pub mod flash_image;
pub mod info;
mod live_mapping;
pub mod machine;
pub mod play;
pub mod render;
mod same_form;
pub mod serve;
mod shard;
pub mod steer;
pub mod stream;
mod stream_body;
mod stream_live;
pub mod update;

use crate::memory;
use crate::open::no_clip;
use crate::output::{self, detail, note};
use crate::words;
use anyhow::{Context, Result, anyhow, ensure};
use pantin::OpenError;
use pantin_convert::import::{self, Disk, ImportOptions};
use pantin_convert::{Level, Note, NoteKind, Options, Recipe, Setting, shared_coding};
use std::path::{Path, PathBuf};

/// A direction of the world.
fn up_axis(text: &str) -> Result<pantin::Up> {
    import::up::parse(text).context("expected x, y, z, -x, -y or -z")
}

/// A clip and, if it was made without one, its rig.
pub struct Files {
    path: PathBuf,
    clip: Vec<u8>,
    rig: Vec<u8>,
    /// Where both were read from, and what belongs to a motion.
    from: Disk,
}

/// Refuses outputs that are one of the files which were read from `files`. Some are known only then: a glTF names its buffers itself.
fn check_read(files: &Disk, outputs: &[&Path]) -> Result<()> {
    let read = files.read_so_far();
    output::check(&read.iter().map(PathBuf::as_path).collect::<Vec<_>>(), outputs)
}

/// Refuses a rig for clips that all have their own.
fn rig_is_needed(rig: Option<&Path>, clips: &[pantin::Clip]) -> Result<()> {
    let needed = rig.is_none() || clips.iter().any(|clip| clip.rig_len() == 0);
    ensure!(needed, "--rig has no effect: every clip has its own");
    Ok(())
}

/// The name of an output that the user does not name: the input's, with another extension. Fails if there is a file of that name.
fn default_output(input: &Path, extension: &str) -> Result<PathBuf> {
    ensure!(input.as_os_str() != "-", "standard input has no name for the output: --output gives one");
    let output = input.with_extension(extension);
    ensure!(is_free(&output), "{}: exists; --output {0} replaces it, another name keeps it", output.display());
    Ok(output)
}

/// Whether nothing has the name of an output that the user does not name: a file there may be a capture, or a clip of another motion.
fn is_free(output: &Path) -> bool {
    output.symlink_metadata().is_err()
}

/// The format of an output, by the option --format or by the extension of its name.
/// `None` if neither says it.
fn format_of<T: clap::ValueEnum>(output: &Path, option: Option<T>) -> Result<Option<T>> {
    let extension = output.extension().and_then(|extension| extension.to_str());
    let by_name = extension.and_then(|extension| T::from_str(extension, true).ok());
    let name = |format: &T| format.to_possible_value().map(|value| value.get_name().to_string()).unwrap_or_default();
    if let (Some(by_name), Some(option)) = (&by_name, &option) {
        let (by_name, option) = (name(by_name), name(option));
        ensure!(by_name == option, "{}: its name ends in .{by_name}, and --format is {option}", output.display());
    }
    Ok(option.or(by_name))
}

impl Files {
    /// Reads both; `-` is standard input.
    pub fn read(clip: &Path, rig: Option<&Path>) -> Result<Files> {
        Files::read_from(&memory::disk(), clip, rig)
    }

    fn read_from(files: &Disk, clip: &Path, rig: Option<&Path>) -> Result<Files> {
        let read = |path: &Path| {
            let bytes = import::read_from(files, path)?;
            detail!("read {}: {} bytes", path.display(), bytes.len());
            anyhow::Ok(bytes)
        };
        let (bytes, rig) = (read(clip)?, rig.map(read).transpose()?.unwrap_or_default());
        Ok(Files { path: clip.into(), clip: bytes, rig, from: files.clone() })
    }

    /// The same for a command that shows clips: a motion file is converted first, quickly and in memory.
    pub fn read_to_show(clip: &Path, rig: Option<&Path>) -> Result<Files> {
        let from = memory::disk();
        let mut files = Files::read_from(&from, clip, rig)?;
        if files.is_motion() {
            let import = ImportOptions::new().memory(memory::limit());
            // Only to be shown: as lines between joints, so that places are enough.
            let options = Options::new().effort(Level::FAST).places_only(true).memory(memory::limit());
            // That this bound has no effect on a face concerns nobody: it was not asked for.
            let asked = |note: &&Note| note.kind != NoteKind::NoEffect || note.setting != Some(Setting::PlacesOnly);
            let prepared = Recipe::new().import(import).options(options).prepare(&from, clip)?;
            prepared.notes.iter().filter(asked).for_each(|note| note!("{}", words::line(note)));
            let bar = output::progress(1000, "converting {wide_bar} {percent} % {eta} left")?;
            let moved = &mut |part: f64| bar.set_position((part * 1000.0) as u64);
            let made = prepared.code(&shared_coding(std::slice::from_ref(&prepared)), moved);
            let made = made.with_context(|| clip.display().to_string())?;
            bar.finish_and_clear();
            made.notes[prepared.notes.len()..].iter().filter(asked).for_each(|note| note!("{}", words::line(note)));
            files.clip = made.clip;
        }
        Ok(files)
    }

    /// Whether the file is no clip, but a motion that can be made one.
    fn is_motion(&self) -> bool {
        let opened = pantin::Clip::new_checked(&self.clip);
        matches!(opened, Err(OpenError::BadMagic)) && import::looks_like_motion(&self.path, &self.clip)
    }

    /// Opens the clip. The error says which command or option helps.
    pub fn open(&self) -> Result<pantin::Clip<'_>> {
        let opened = match self.rig.is_empty() {
            true => pantin::Clip::new_checked(&self.clip),
            false => pantin::Clip::with_rig(&self.clip, &self.rig),
        };
        opened.map_err(|error| match error {
            OpenError::WrongRig if self.rig.is_empty() => anyhow!("{error}; --rig FILE names the one that --rig-out wrote"),
            error => no_clip(&self.path, &self.clip, error),
        })
    }

    /// The same for a command that takes one clip: a rig that the clip does not need is a mistake.
    pub fn open_alone(&self) -> Result<pantin::Clip<'_>> {
        let clip = self.open()?;
        ensure!(self.rig.is_empty() || clip.rig_len() == 0, "--rig: the clip has its own rig in it");
        Ok(clip)
    }

    /// The clip's bytes.
    pub fn clip(&self) -> &[u8] {
        &self.clip
    }

    /// Length of the clip's file.
    pub fn clip_len(&self) -> usize {
        self.clip.len()
    }
}
