//! ZIP archives: people hand captures on as archives of a motion and the files that belong to it.
//!
//! An archive is a folder in memory: the importer of the motion inside finds its skeleton or buffers there. Files are unpacked when they are
//! read, one at a time, and nothing is written.

use super::animations::{Entry, choose};
use super::files::Files;
use super::{FORMATS, Format, ImportOptions, Imported, Request, Source, format_of, imported, one_line};
use crate::error::{Error, Setting};
use crate::memory::Memory;
use crate::note::{Note, NoteKind, Remedy};
use ::zip::ZipArchive;
use ::zip::result::ZipError;
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most names that an error lists.
const MOST_NAMES: usize = 8;

/// Whether `head` begins a ZIP archive.
pub fn begins(head: &[u8]) -> bool {
    head.starts_with(b"PK\x03\x04")
}

/// Reads a motion of the archive `path`: the only one, the one that the user names, or the first by name.
pub fn read(path: &Path, request: &Request) -> Result<Source> {
    let place = || path.display().to_string();
    let archive = Archive::open(path, request)?;
    let chosen = archive.chosen(request.animation.as_deref()).with_context(place)?;
    let options = ImportOptions { animation: chosen.animation, ..(**request).clone() };
    let Imported { motion, notes: of_motion } =
        imported(&chosen.motion, &Request::new(&archive, &options)).with_context(place)?;
    let mut notes = Vec::new();
    if let Some(count) = chosen.first_of {
        let text = format!("motion {} of the archive's {count}", named(0, &chosen.motion));
        notes.push(Note::warning(NoteKind::Animation, text).remedy(Remedy::ChooseAnimation));
    }
    notes.extend(of_motion);
    Ok(Source { settled: true, ..Source::plain(motion, notes) })
}

/// The animations of the archive's motion; or its motions, if there are several. A motion that cannot be read has no frames.
pub fn list(path: &Path, request: &Request) -> Result<Vec<Entry>> {
    let place = || path.display().to_string();
    let archive = Archive::open(path, request)?;
    let motions = archive.motions().with_context(place)?;
    let options = ImportOptions { animation: None, ..(**request).clone() };
    let inside = Request::new(&archive, &options);
    if let [motion] = motions[..] {
        return format_of(motion, &inside).and_then(|format| (format.list)(motion, &inside)).with_context(place);
    }
    let bytes = motions.iter().map(|motion| archive.unpacked_bytes(motion)).fold(0, u64::saturating_add);
    request.memory.check_bytes_held(bytes).with_context(place)?;
    let entry = |motion: &&Path| {
        let name = Some(one_line(&motion.to_string_lossy()));
        imported(motion, &inside).map_or(
            Entry { name: name.clone(), frames: 0, fps: 0.0, tracks: 0 },
            |Imported { motion, .. }| Entry {
                name,
                frames: motion.frames,
                fps: 1.0 / motion.frame_time,
                tracks: motion.rig.channels(),
            },
        )
    };
    Ok(motions.iter().map(entry).collect())
}

/// An archive as a folder. Files that another file names are those of the archive; files that the user names may also lie around it.
struct Archive<'a> {
    zip: ZipArchive<Cursor<Arc<[u8]>>>,
    /// Number in the archive of each file, by its name without `..` and other parts that lead out of the archive.
    files: BTreeMap<PathBuf, usize>,
    around: &'a dyn Files,
    memory: Memory,
    bytes: u64,
}

/// The motion that is read.
struct Chosen {
    motion: PathBuf,
    /// The animation of the motion that the user names.
    animation: Option<String>,
    /// The number of motions, if the first was taken because the user named none.
    first_of: Option<usize>,
}

impl<'a> Archive<'a> {
    fn open(path: &Path, request: &Request<'a>) -> Result<Archive<'a>> {
        let bytes: Arc<[u8]> = request.read(path)?.into();
        let (len, memory, around) = (bytes.len() as u64, request.memory, request.files());
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(refusal).with_context(|| path.display().to_string())?;
        let name = |index: usize| {
            let name = zip.name_for_index(index).filter(|name| !name.ends_with(['/', '\\']))?;
            Some((inside(Path::new(name))?, index))
        };
        let files = (0..zip.len()).filter_map(name).collect();
        Ok(Archive { zip, files, around, memory, bytes: len })
    }

    /// The motions by name, those first that hold more than a table: tables beside motions are often lists or labels.
    fn motions(&self) -> Result<Vec<&Path>> {
        let mut motions: Vec<&Path> = self.files.keys().map(PathBuf::as_path).filter(|path| is_motion(path)).collect();
        motions.sort_by_key(|path| is_table(path));
        if motions.is_empty() {
            let archive = self.files.keys().find(|path| is_archive(path));
            let text = match archive {
                Some(archive) => format!("no motion in it but another archive, {}; unpack it first", quoted(archive)),
                None => {
                    let formats = FORMATS.iter().filter(|format| !is_this(format)).map(Format::sentence);
                    format!("no motion in it; expected {}", formats.collect::<Vec<_>>().join(" or "))
                }
            };
            return Err(Error::source(text).into());
        }
        Ok(motions)
    }

    /// The motion that `wanted` names: by its file's name, with or without extension and folders, or by its number from 0. Of a single motion,
    /// `wanted` names the animation.
    fn chosen(&self, wanted: Option<&str>) -> Result<Chosen> {
        let motions = self.motions()?;
        let motion = |number: usize| motions[number].to_path_buf();
        let Some(wanted) = wanted.filter(|_| motions.len() > 1) else {
            let first_of = (motions.len() > 1).then_some(motions.len());
            return Ok(Chosen { motion: motion(0), animation: wanted.map(String::from), first_of });
        };
        let text = |part: fn(&Path) -> Option<&std::ffi::OsStr>| motions.iter().map(move |path| part(path)?.to_str());
        let found = choose(wanted, text(Path::file_stem)).or_else(|| choose(wanted, text(Path::file_name)));
        let found = found.or_else(|| choose(wanted, text(|path| Some(path.as_os_str()))));
        let refusal = || {
            let mut names: Vec<String> =
                motions.iter().take(MOST_NAMES).enumerate().map(|(number, path)| named(number, path)).collect();
            names.extend((motions.len() > MOST_NAMES).then(|| format!("{} more", motions.len() - MOST_NAMES)));
            let text = format!("no motion {} in the archive, which has {}", quoted(Path::new(wanted)), names.join(", "));
            Error::setting(Setting::Animation, text)
        };
        Ok(Chosen { motion: motion(found.ok_or_else(refusal)?), animation: None, first_of: None })
    }

    /// The number of a file in the archive; an error if there is none of its name.
    fn number(&self, path: &Path) -> io::Result<usize> {
        let found = inside(path).and_then(|path| self.files.get(&path));
        found.copied().ok_or_else(|| io::Error::other(Error::read("not in the archive")))
    }

    /// Bytes that a file has by the archive's directory; 0 for a damaged one.
    fn unpacked_bytes(&self, path: &Path) -> u64 {
        self.number(path).ok().and_then(|number| self.zip.clone().by_index_raw(number).ok().map(|file| file.size())).unwrap_or(0)
    }

    /// The first bytes of a file, `most` at most.
    fn front(&self, number: usize, most: u64) -> io::Result<Vec<u8>> {
        let mut zip = self.zip.clone();
        let file = zip.by_index(number).map_err(|error| io::Error::other(refusal(error)))?;
        let mut bytes = Vec::new();
        file.take(most).read_to_end(&mut bytes).map_err(|error| io::Error::other(refusal(ZipError::Io(error))))?;
        Ok(bytes)
    }

    /// All bytes of a file. A file that unpacks to more than the archive's directory states is refused before it fills the memory.
    fn whole(&self, path: &Path, number: usize) -> io::Result<Vec<u8>> {
        let stated = self.unpacked_bytes(path);
        self.memory
            .check_bytes_held(self.bytes.saturating_add(stated))
            .map_err(|error| io::Error::other(Error::of(&error, Error::memory)))?;
        let bytes = self.front(number, stated.saturating_add(1))?;
        if bytes.len() as u64 != stated {
            let text =
                format!("the archive is damaged: it states {stated} bytes, and there are {}", more_or(bytes.len(), stated));
            return Err(io::Error::other(Error::read(text)));
        }
        Ok(bytes)
    }
}

impl Files for Archive<'_> {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        match self.number(path) {
            Ok(number) => self.whole(path, number),
            Err(_) => self.around.read(path),
        }
    }

    fn head(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        self.front(self.number(path)?, most)
    }

    fn read_named(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.whole(path, self.number(path)?)
    }

    fn beside(&self, folder: &Path) -> io::Result<Vec<PathBuf>> {
        let folder = inside(folder).unwrap_or_default();
        Ok(self.files.keys().filter(|path| path.parent() == Some(&folder)).cloned().collect())
    }
}

/// A path inside the archive, without `.`, `..`, roots and drives, and with `/` between its parts; `None` if nothing is left.
fn inside(path: &Path) -> Option<PathBuf> {
    let text = path.to_str()?;
    let mut parts: Vec<&str> = Vec::new();
    for part in text.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()),
            drive if drive.ends_with(':') => {}
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/").into())
}

/// Whether a file's name is of a motion, and not one of those that macOS adds to archives.
fn is_motion(path: &Path) -> bool {
    let hidden = path.iter().any(|part| part.to_string_lossy().starts_with('.') || part == "__MACOSX");
    !hidden && FORMATS.iter().any(|format| !is_this(format) && format.names(path))
}

fn is_table(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv") || extension.eq_ignore_ascii_case("tsv"))
}

fn is_archive(path: &Path) -> bool {
    FORMATS.iter().any(|format| is_this(format) && format.names(path))
}

/// Whether a format is that of archives.
fn is_this(format: &Format) -> bool {
    format.extensions.contains(&"zip")
}

fn quoted(path: &Path) -> String {
    format!("`{}`", one_line(&path.to_string_lossy()))
}

fn named(number: usize, path: &Path) -> String {
    format!("{number} ({})", one_line(&path.to_string_lossy()))
}

fn more_or(found: usize, stated: u64) -> String {
    if found as u64 > stated { "more".into() } else { found.to_string() }
}

/// Why the archive or a file of it cannot be unpacked.
fn refusal(error: ZipError) -> Error {
    match error {
        ZipError::UnsupportedArchive(ZipError::PASSWORD_REQUIRED) | ZipError::InvalidPassword => {
            Error::read("encrypted; unpack the archive with its password first")
        }
        ZipError::UnsupportedArchive(_) | ZipError::CompressionMethodNotSupported(_) => {
            Error::read("packed by a method that is not read; unpack the archive first, or pack it again with Deflate")
        }
        ZipError::Io(error) => Error::read(format!("the archive is damaged: {}", one_line(&error.to_string()))),
        error => Error::read(format!("the archive is damaged: {}", one_line(&error.to_string()))),
    }
}

#[cfg(test)]
#[path = "zip_tests.rs"]
mod tests;
